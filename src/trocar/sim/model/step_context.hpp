// The arguments of every stage of a step, and how a stage emits events.
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/step_report.hpp>
#include <trocar/sim/model/work.hpp>

namespace trocar::sim {

struct StepContext {
  const Model& model;
  const Input& input;
  State& state;
  Work& work;
  StepReport& report;
};

/// Some room is kept for tears: one tick can tear several bodies, and each may be an error of a hand.
inline void emit_event(StepContext& c, const Event& event) noexcept {
  const int room = event.kind == Event::torn ? kMaxEvents : kMaxEvents - kRoomForTears;
  if (c.report.event_count < room)
    c.report.events[c.report.event_count++] = event;
  else
    c.report.flags |= StepReport::kEventsFull;
}
/// A grip has ended: reports whether it slipped, or the hand let go.
inline void emit_grip_end(StepContext& c, size_t hand, int slips_before) noexcept {
  const bool slipped = c.state.tools[hand].slipped > slips_before;
  emit_event(c, slipped ? Event::of_hand(Event::slipped, int(hand)) : Event::of_hand(Event::released, int(hand)));
}

/// All bodies at once, in a tick.
inline interactions::Bodies bodies_of(const StepContext& c) noexcept {
  return {c.model, c.state, &c.work, {&c.model.objects, &c.state.objects, &c.work.objects}};
}

}  // namespace trocar::sim
