// Verbs: what jaws do to what is between them, a class a verb, in the order in which they act. A verb has
//
//   static bool does(const interactions::ToolModel& tool);         which instruments do it
//   static void work(StepContext& context, std::size_t hand);      in every tick, on the shape that the jaws have now
//   static Book<...> book(State& state);                           what it leaves, if that is drawn: goes into
//   keyframes static bool sound(const Model& model, const Record& record);   does a record of it name what is there?
//
// The last two only together. A new verb is its files, its place in the list here, and an ability
// (interactions/instrument/tool_kind.hpp); with records of its own their place in the State, with an event of its own
// that one's line in model/step_report.hpp. What an instrument does at another moment of a tick (current, water) is a
// stage of its own in stages/step.cpp.
#pragma once

#include <trocar/core/kind_list.hpp>
#include <trocar/sim/verbs/clipping.hpp>
#include <trocar/sim/verbs/cutting.hpp>
#include <trocar/sim/verbs/gripping.hpp>

namespace trocar::sim {

using Verbs = core::KindList<Gripping, Clipping, Cutting>;

/// f(verb, book) of every verb that keeps one.
template <class S, class F>
void visit_books(S& state, F&& f) {
  Verbs::for_each([&](auto verb) {
    if constexpr (requires { verb.book(state); }) f(verb, verb.book(state));
  });
}

}  // namespace trocar::sim
