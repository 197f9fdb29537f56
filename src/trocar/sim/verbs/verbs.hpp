// Verbs: what jaws do to what is between them, a class a verb, in the order in which they act. A verb has
//
//   static bool does(const interactions::ToolModel& tool);         which instruments do it
//   static void work(StepContext& context, std::size_t hand);      in every tick, on the shape that the jaws have now
//
// and, where it leaves something that is drawn, records of that, which keyframes keep:
//
//   static auto buffer(State& state);                                the records and how many of them are in use
//   static bool sound(const Model& model, const Record& record);   does a record name what is there?
//   static constexpr bool kInAll = true;                           also in scenes where no instrument does it
//
// A new verb is its files, its place in the list here, and an ability (interactions/instrument/tool_kind.hpp); with
// records of its own their place in the State, with an event of its own that one's lines in model/step_report.hpp. What
// an instrument does at another moment of a tick (current, water) is a stage of its own in stages/step.cpp.
#pragma once

#include <trocar/core/kind_list.hpp>
#include <trocar/sim/verbs/clipping.hpp>
#include <trocar/sim/verbs/cutting.hpp>
#include <trocar/sim/verbs/gripping.hpp>

namespace trocar::sim {

using Verbs = core::KindList<Gripping, Clipping, Cutting>;

template <class Verb>
bool is_done_in(const Model& model) noexcept {
  for (const HandModel& hand : model.hands)
    for (const interactions::ToolModel& tool : hand.rack)
      if (Verb::does(tool)) return true;
  return false;
}

/// f(verb, buffer) of every verb that keeps one in this scene.
template <class S, class F>
void visit_record_buffers(const Model& model, S& state, F&& f) {
  Verbs::for_each([&](auto verb) {
    using V = decltype(verb);
    if constexpr (requires { V::kInAll; }) {
      f(verb, V::buffer(state));
    } else if constexpr (requires { V::buffer(state); }) {
      if (is_done_in<V>(model)) f(verb, V::buffer(state));
    }
  });
}

}  // namespace trocar::sim
