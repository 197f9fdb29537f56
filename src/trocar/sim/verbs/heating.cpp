#include <algorithm>
#include <cmath>

#include <trocar/interactions/verbs/electrode_contact.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/verbs/adhesion.hpp>
#include <trocar/sim/verbs/current_cut.hpp>
#include <trocar/sim/verbs/heat_bodies.hpp>
#include <trocar/sim/verbs/heating.hpp>
#include <trocar/sim/verbs/scarring.hpp>
#include <trocar/sim/verbs/sealing.hpp>

namespace trocar::sim {
namespace {

using interactions::ElectrodeTouch;

constexpr double kWarmTip = 0.5;  // [K] off 37 C: what is less warms nothing
constexpr double kStill = 0.01;   // of ElectrodeState::stuck

/// Is there anything to compute of this hand's electrode?
bool at_work(const ElectrodeHand& hand, tissue::EnergyMode mode) noexcept {
  return mode != tissue::EnergyMode::off || std::fabs(hand.current.tip - tissue::kBodyHeat) > kWarmTip ||
         hand.current.stuck > kStill;
}

/// Tissue that has burst gives way: the wire is at the bottom of the groove that it has made. In a strand that it has
/// gone through it turns to what is left of the section beside it.
void sink(const StepContext& c, ElectrodeTouch& touch) noexcept {
  const double step = 0.5 * c.model.energy.heat.cell;
  if (!(dot(touch.inwards, touch.inwards) > 0) || touch.contact.gap > 0) return;
  const auto parted = [&](Vec3d p) { return has_burst(c, touch.contact.body, p); };
  Vec3d p = touch.contact.a;
  for (double deep = 0; deep < interactions::kBareWire && parted(p); deep += step) p += step * touch.inwards;
  touch.contact.a = touch.contact.b = p;
  if (!touch.contact.body.is(BodyKind::strand)) return;
  const Section section = section_of(c, touch.contact.body, touch.point.element, p.x);
  if (dot(p - section.middle, touch.inwards) < section.reach) return;  // not through yet
  for (const Vec3d side : section.around)
    if (!parted(side)) touch.contact.a = touch.contact.b = side;
}

ElectrodeTouch touch_of(const StepContext& c, size_t t, tissue::EnergyMode mode) noexcept {
  if (!at_work(c.state.electrodes[t], mode)) return {};
  ElectrodeTouch touch =
      interactions::electrode_touch(c.model.tool(c.state, t), c.work.shapes[t], c.state.tools[t], bodies_of(c));
  sink(c, touch);
  return touch;
}

/// Fat that the wire of a monopolar electrode is in, unless it is deeper in something else.
FatTouch fat_of(const StepContext& c, size_t t, const ElectrodeTouch& touch, tissue::EnergyMode mode) noexcept {
  const interactions::ElectrodeModel& electrode = c.model.tool(c.state, t).electrode;
  if (c.model.fat.empty() || electrode.current.bipolar || !at_work(c.state.electrodes[t], mode)) return {};
  const FatTouch fat = fat_at(c, t);
  if (!touch.contact.body.exists() || touch.contact.gap > 0) return fat;
  return interactions::off_wire(c.work.shapes[t], touch.place) < fat.apart ? FatTouch{} : fat;
}

/// Fat keeps its heat by itself; loose tissue at the wire shrivels with it.
void work_in_fat(StepContext& c, size_t t, const FatTouch& fat, const tissue::FootSwitch& pedals) noexcept {
  ElectrodeHand& hand = electrode_of(c, t);
  const EnergyModel& energy = c.model.energy;
  const tissue::HeatContact met = fat_contact(c, fat);
  const tissue::Discharge d = tissue::energise_apart(c.model.tool(c.state, t).electrode.current, c.state.panel, pedals,
                                                     {}, met, energy.heat, c.state.heat, hand.current);
  c.work.current_flows = c.work.current_flows || d.flows;
  hand.body = fat.at.body;
  hand.at = fat.place;
  if (!d.flows) return;
  const double dt = double(energy.heat.period) * kTick;
  burn_bonds(c, fat.place, dt);
  c.work.steam.at = fat.place;
  c.work.steam.kilograms += warm_fat(c, fat, d.tissue * dt);
}

/// One hand's electrode in one tick. @param used  entries of Work::heat_sources so far
void work_electrode(StepContext& c, size_t t, int& used) noexcept {
  ElectrodeHand& hand = electrode_of(c, t);
  const EnergyModel& energy = c.model.energy;
  const interactions::ElectrodeModel& electrode = c.model.tool(c.state, t).electrode;
  if (!electrode.there) return;
  const tissue::FootSwitch pedals = foot_switch(c.input);
  const bool works = c.state.heat.tick % std::uint64_t(energy.heat.period) == 0;
  ElectrodeTouch touch;
  const tissue::EnergyMode mode = tissue::asked_mode(electrode.current, c.state.panel, pedals);
  if (works) touch = touch_of(c, t, mode);
  if (const FatTouch fat = works ? fat_of(c, t, touch, mode) : FatTouch{}; fat.there())
    return work_in_fat(c, t, fat, pedals);
  const tissue::Discharge d = tissue::energise(electrode.current, c.state.panel, pedals, touch.contact, energy.heat,
                                               tissue_shape(c.model), c.state.heat, c.work.heat, hand.current);
  for (const tissue::HeatSource& source : d.span()) c.work.heat_sources[size_t(used++)] = source;
  c.work.current_flows = c.work.current_flows || d.flows;
  if (!works) return;
  hand.body = touch.contact.body;
  if (!hand.body.exists()) return;
  hand.at = touch.place;
  hand.a = touch.contact.a, hand.b = touch.contact.b;
  if (touch.contact.gap == 0) begin_adhesion(c, t, touch, hand);
  seal_vessels(c, t, touch);
  scar_tissue(c, touch);
  if (d.flows) burn_bonds(c, touch.place, double(energy.heat.period) * kTick);
  if (d.flows && tissue::curve_of(d.mode).bursts) part_tissue(c, t, touch);
}

/// Steam leaves where the electrode is that makes it.
void note_steam(StepContext& c, const tissue::HeatReport& report) noexcept {
  if (!(report.boiled > 0)) return;
  int from = -1;
  for (size_t t = 0; t < c.state.electrodes.size(); ++t) {
    const ElectrodeHand& hand = c.state.electrodes[t];
    if (hand.current.joules > 0 && (from < 0 || hand.body == report.boiled_body)) from = int(t);
  }
  if (from < 0) return;
  c.work.steam.at = c.state.electrodes[size_t(from)].at;
  c.work.steam.kilograms += report.boiled;
}

}  // namespace

// Current and heat.
void heat_tissue(StepContext& c) noexcept {
  c.work.current_flows = false;
  c.work.steam = {};
  if (!c.model.energy.there) return;
  tissue::press(panel_keys(c.input), c.state.panel);
  int used = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) work_electrode(c, t, used);
  const tissue::HeatReport report = tissue::advance(c.model.energy.heat, {c.work.heat_sources.data(), size_t(used)},
                                                    tissue_shape(c.model), c.state.heat, c.work.heat);
  if (report.flags & (tissue::HeatReport::kBricksFull | tissue::HeatReport::kAwakeFull))
    c.report.flags |= StepReport::kHeatFull;
  note_steam(c, report);
}

}  // namespace trocar::sim
