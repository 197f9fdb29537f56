#include <algorithm>

#include <trocar/training/facts/needs.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

constexpr double kHottest = 400;  ///< [deg C]

/// The material point that a hand's electrode was last at.
const sim::ElectrodeHand* touched(const Snapshot& snapshot, const Arguments& a) {
  const sim::ElectrodeHand& e = snapshot.state.electrodes[size_t(a[0].index)];
  return e.body.exists() ? &e : nullptr;
}

Value temperature(const Snapshot& snapshot, const Arguments& a) {
  const sim::ElectrodeHand* e = touched(snapshot, a);
  if (!e) return kUnknown;
  const float read =
      tissue::reading(snapshot.model.energy.heat, snapshot.state.heat, e->body, 0.5 * (e->a + e->b)).temperature;
  return std::min(double(read), kHottest);  // a float's rounding may lie above
}

Value dead_beyond(const Snapshot& snapshot, const Arguments& a) {
  const sim::ElectrodeHand* e = touched(snapshot, a);
  if (!e) return kUnknown;
  const tissue::Treated place[] = {{e->a, e->b}};
  return tissue::spread(snapshot.model.energy.heat, snapshot.state.heat, e->body, place);
}

Value active(const Snapshot& snapshot, const Arguments& a) {
  return snapshot.state.electrodes[size_t(a[0].index)].current.now.mode != tissue::EnergyMode::off;
}

std::vector<Parameter> hand() { return {{"hand", ArgumentKind::hand, "whose electrode"}}; }

}  // namespace

const Fact kTissueTemperature{
    "tissue.temperature_C",
    hand(),
    0,
    kHottest,
    "Temperature of the tissue that the hand's electrode touched last. Unknown before the first contact.",
    needs_energy,
    &stateless<temperature>};
const Fact kTissueDeadBeyond{
    "tissue.dead_beyond_mm",
    hand(),
    0,
    1000,
    "Extent of thermal necrosis from the last contact of the hand's electrode. Expensive: up to "
    "1 ms. Unknown before the first contact.",
    needs_energy,
    &stateless<dead_beyond>};
const Fact kHandActive{
    "hand.active",      hand(), 0, 1, "The pedal of this hand's instrument is pressed.", needs_energy,
    &stateless<active>, true};

}  // namespace trocar::training
