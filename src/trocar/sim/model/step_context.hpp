// The arguments of every stage of a step, and how a stage emits events.
#pragma once

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

inline void emit_event(StepContext& c, Event::Kind kind, int tool, int index) noexcept {
  if (c.report.event_count < kMaxEvents - kRoomForTears)
    c.report.events[c.report.event_count++] = {kind, tool, index};
  else
    c.report.flags |= StepReport::kEventsFull;
}
inline void emit_event(StepContext& c, Event::Kind kind, int tool, BodyId body) noexcept {
  emit_event(c, kind, tool, body.code());
}
/// A grip has ended: reports whether it slipped, or the hand let go.
inline void emit_grip_end(StepContext& c, size_t hand, int slips_before) noexcept {
  emit_event(c, c.state.tools[hand].slipped > slips_before ? Event::slipped : Event::released, int(hand), -1);
}

}  // namespace trocar::sim
