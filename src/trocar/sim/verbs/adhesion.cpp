#include <trocar/interactions/verbs/adhesion.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/verbs/adhesion.hpp>

namespace trocar::sim {
namespace {

constexpr double kGlues = 0.2;  // of ElectrodeState::stuck: tissue is pulled along from there on

}  // namespace

ElectrodeHand& electrode_of(StepContext& c, size_t t) noexcept {
  ElectrodeHand& hand = c.state.electrodes[t];
  const std::int32_t changes = c.state.tools[t].changes;
  if (hand.changes != changes) hand = {};
  hand.changes = changes;
  return hand;
}

void begin_adhesion(StepContext& c, size_t t, const interactions::ElectrodeTouch& touch, ElectrodeHand& hand) noexcept {
  if (hand.stuck.at.body.exists() || hand.current.stuck < kGlues) return;
  hand.stuck = interactions::stuck_at(c.work.shapes[t], bodies_of(c), touch.point);
}

// Char on electrodes.
void apply_adhesion(StepContext& c) noexcept {
  if (!c.model.energy.there) return;
  const interactions::Bodies bodies = bodies_of(c);
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    ElectrodeHand& hand = electrode_of(c, t);
    if (!hand.stuck.at.body.exists()) continue;
    const interactions::ToolShape& shape = c.work.shapes[t];
    const double bears = c.model.tool(c.state, t).electrode.current.stick_force * hand.current.stuck;
    if (interactions::is_whole(bodies, hand.stuck.at) && interactions::stuck_pull(shape, bodies, hand.stuck) <= bears) {
      interactions::stuck_load(shape, int(t), bodies, hand.stuck);
      continue;
    }
    tissue::tear_off(hand.current);
    hand.stuck = {};
  }
}

}  // namespace trocar::sim
