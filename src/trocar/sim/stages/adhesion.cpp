#include <trocar/interactions/verbs/adhesion.hpp>
#include <trocar/sim/stages/adhesion.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

constexpr double kGlues = 0.2;  // of ElectrodeState::stuck: tissue is pulled along from there on

/// Is there still something to stick to?
bool is_whole(const StepContext& c, const interactions::Hold& stuck) noexcept {
  if (stuck.body >= interactions::kMembraneBase) return true;
  if (stuck.body >= interactions::kSolidBase) {
    const size_t organ = size_t(stuck.body - interactions::kSolidBase);
    return stuck.element < c.work.skins[organ]->size() && !c.work.surfaces[organ].torn(stuck.element);
  }
  return c.state.strands[size_t(stuck.body)].alive[size_t(stuck.element)] != 0;
}

}  // namespace

ElectrodeHand& electrode_of(StepContext& c, size_t t) noexcept {
  ElectrodeHand& hand = c.state.electrodes[t];
  const std::int32_t changes = c.state.tools[t].changes;
  if (hand.changes != changes) hand = {};
  hand.changes = changes;
  return hand;
}

void begin_adhesion(StepContext& c, size_t t, const interactions::ElectrodeTouch& touch, ElectrodeHand& hand) noexcept {
  if (hand.stuck.body >= 0 || hand.current.stuck < kGlues) return;
  hand.stuck = interactions::stuck_at(c.work.shapes[t], tissue_of(c), touch.point);
}

// Char on electrodes.
void apply_adhesion(StepContext& c) noexcept {
  if (!c.model.energy.there) return;
  const interactions::TissueView view = tissue_of(c);
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    ElectrodeHand& hand = electrode_of(c, t);
    if (hand.stuck.body < 0) continue;
    const interactions::ToolShape& shape = c.work.shapes[t];
    const double bears = c.model.tool(c.state, t).electrode.current.stick_force * hand.current.stuck;
    if (is_whole(c, hand.stuck) && interactions::stuck_pull(shape, view, hand.stuck) <= bears) {
      interactions::stuck_load(shape, int(t), view, hand.stuck, c.work.strand_loads, c.work.organ_loads,
                               c.work.membrane_loads);
      continue;
    }
    tissue::tear_off(hand.current);
    hand.stuck = {};
  }
}

}  // namespace trocar::sim
