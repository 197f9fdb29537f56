#include <algorithm>
#include <cmath>

#include <trocar/tissue/heat/electrosurgery.hpp>

namespace trocar::tissue {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr double kStickTime = 0.3;  ///< [s]

HeatSource source_of(const ElectrodeDescription& e, const ElectrodeContact& c, const EnergyCurve& curve) noexcept {
  HeatSource q;
  q.body = c.body;
  q.a = c.a;
  q.b = c.b;
  q.radius = std::clamp(e.radius * curve.focus, 1e-4, 5e-3);
  q.reach = curve.reach;
  q.bursts = curve.bursts;
  return q;
}

bool is_near(const ElectrodeContact& c) noexcept {
  return c.body.exists() && c.gap >= 0 && c.gap < 1 && c.pressed >= 0;
}

/// A source for all the ticks until the next one.
void add_source(HeatSource q, double watts, const HeatModel& model, Discharge& d) noexcept {
  q.watts = model.period * watts;
  d.sources[d.count++] = q;
}

/// Into what the electrode meets there.
void flow(const ElectrodeDescription& e, double set, const ElectrodeContact& c, double pressed,
          const EnergyCurve& curve, const HeatContact& met, Discharge& d) noexcept {
  if (!(met.volume > 0)) return;
  const double g = std::max(met.conductance, 1e-3);
  const double contact = e.wet * kMillimetre / (e.radius * curve.focus * pressed * g);
  d.impedance = (e.bipolar ? 0.0 : e.back) + contact;
  d.output = set * load_factor(curve, d.impedance);
  const double across = c.gap > 0 ? 1 - 0.5 * c.gap / curve.gap : 1.0;
  d.tissue = e.efficiency * d.output * across * 0.5 * (1 + g);
  d.flows = d.output > 0;
}

void discharge(const ElectrodeDescription& e, double set, const ElectrodeContact& c, double pressed,
               const HeatModel& model, const TissueShape& shape, HeatState& heat, HeatWork& work,
               Discharge& d) noexcept {
  const EnergyCurve curve = curve_of(d.mode);
  if (c.gap > curve.gap) return;
  const HeatSource q = source_of(e, c, curve);
  flow(e, set, c, pressed, curve, probe(model, q, shape, heat, work), d);
  if (d.flows) add_source(q, d.tissue, model, d);
}

void adhere(const ElectrodeDescription& e, double celsius, double dt, ElectrodeState& s) noexcept {
  const double wanted = std::clamp((celsius - e.sticks_from) / (e.sticks_fully - e.sticks_from), 0.0, 1.0);
  if (wanted > s.stuck) s.stuck += (wanted - s.stuck) * std::min(dt / kStickTime, 1.0);
}

/// Heat that a tip passes on to the tissue which it touches [W]. A tip as warm as tissue is left alone.
double touch(const ElectrodeDescription& e, const ElectrodeContact& c, double pressed, double dt,
             const HeatModel& model, const TissueShape& shape, HeatState& heat, HeatWork& work, ElectrodeState& s,
             Discharge& d) noexcept {
  if (!d.flows && std::fabs(s.tip - kBodyHeat) < 0.5) return 0;
  HeatSource q = source_of(e, c, {.focus = 1, .reach = 1});
  q.by_current = 0;
  const HeatContact met = probe(model, q, shape, heat, work);
  if (!(met.volume > 0)) return 0;
  adhere(e, met.hottest, dt, s);
  const double watts = e.tip_contact * pressed * (s.tip - met.temperature);
  add_source(q, watts, model, d);
  return watts;
}

}  // namespace

ElectrodeDescription bipolar_jaws() noexcept {
  ElectrodeDescription e;
  e.bipolar = true;
  e.wet = 60;
  e.tip_capacity = 0.2;
  return e;
}

EnergyCurve curve_of(EnergyMode mode) noexcept {
  switch (mode) {
    case EnergyMode::cut:
      return {.low = 100, .high = 1500, .focus = 0.7, .reach = 2, .gap = 0.2e-3, .bursts = 1};
    case EnergyMode::blend:
      return {.low = 100, .high = 1800, .focus = 1, .reach = 2, .gap = 0.5e-3, .bursts = 1};
    case EnergyMode::coag:
      return {.low = 150, .high = 2500, .focus = 1.5, .reach = 2, .gap = 1.5e-3};
    case EnergyMode::bipolar:
      return {.low = 20, .high = 300, .focus = 1, .reach = 2, .gap = 0};
    case EnergyMode::off:
      break;
  }
  return {};
}

void press(std::uint32_t down, GeneratorPanel& panel) noexcept {
  const std::uint32_t pressed = down & ~panel.held;
  const auto turn = [pressed](double& watts, PanelKey more, PanelKey less) {
    const double steps = double((pressed & more) != 0) - double((pressed & less) != 0);
    watts = std::clamp(watts + steps * kWattStep, 0.0, kMostWatts);
  };
  turn(panel.yellow_watts, kYellowMore, kYellowLess);
  turn(panel.blue_watts, kBlueMore, kBlueLess);
  turn(panel.bipolar_watts, kBipolarMore, kBipolarLess);
  if (pressed & kOtherCut) panel.yellow = panel.yellow == EnergyMode::cut ? EnergyMode::blend : EnergyMode::cut;
  panel.held = down;
}

EnergyMode asked_mode(const ElectrodeDescription& e, const GeneratorPanel& panel, FootSwitch pedals) noexcept {
  if (pedals.yellow == pedals.blue) return EnergyMode::off;
  if (e.bipolar) return pedals.blue ? EnergyMode::bipolar : EnergyMode::off;
  if (pedals.blue) return EnergyMode::coag;
  return panel.yellow == EnergyMode::blend ? EnergyMode::blend : EnergyMode::cut;
}

double set_watts(const GeneratorPanel& panel, EnergyMode mode) noexcept {
  const double w = mode == EnergyMode::off       ? 0.0
                   : mode == EnergyMode::coag    ? panel.blue_watts
                   : mode == EnergyMode::bipolar ? panel.bipolar_watts
                                                 : panel.yellow_watts;
  return w > 0 ? std::min(w, kMostWatts) : 0.0;
}

double load_factor(const EnergyCurve& curve, double ohm) noexcept {
  if (!(ohm > 0)) return 0;
  return ohm < curve.low ? ohm / curve.low : ohm > curve.high ? curve.high / ohm : 1.0;
}

Discharge energise(const ElectrodeDescription& e, const GeneratorPanel& panel, FootSwitch pedals,
                   const ElectrodeContact& contact, const HeatModel& model, const TissueShape& shape, HeatState& heat,
                   HeatWork& work, ElectrodeState& s) noexcept {
  Discharge d;
  if (heat.tick % std::uint64_t(model.period) != 0) {
    static_cast<DischargeFigures&>(d) = s.now;
    return d;
  }
  d.mode = asked_mode(e, panel, pedals);
  const double pressed = std::clamp(contact.pressed, 0.1, 1.0), dt = model.step;
  const bool touches = is_near(contact) && contact.gap == 0;
  s.on_time = d.mode == EnergyMode::off ? 0 : s.on_time + dt;
  if (d.mode != EnergyMode::off && is_near(contact))
    discharge(e, set_watts(panel, d.mode), contact, pressed, model, shape, heat, work, d);
  s.joules += d.tissue * dt;
  const double to_tissue = touches ? touch(e, contact, pressed, dt, model, shape, heat, work, s, d) : 0.0;
  d.hot_touch = touches && d.mode == EnergyMode::off && s.tip > kHotTip;
  d.tear_force = e.stick_force * s.stuck;
  s.tip += dt / e.tip_capacity * (e.tip_share * d.output - to_tissue - e.tip_air * (s.tip - kBodyHeat));
  s.now = d;
  return d;
}

Discharge energise_apart(const ElectrodeDescription& e, const GeneratorPanel& panel, FootSwitch pedals,
                         const ElectrodeContact& contact, const HeatContact& met, const HeatModel& model,
                         const HeatState& heat, ElectrodeState& s) noexcept {
  Discharge d;
  if (heat.tick % std::uint64_t(model.period) != 0) {
    static_cast<DischargeFigures&>(d) = s.now;
    return d;
  }
  d.mode = asked_mode(e, panel, pedals);
  const double pressed = std::clamp(contact.pressed, 0.1, 1.0), dt = model.step;
  s.on_time = d.mode == EnergyMode::off ? 0 : s.on_time + dt;
  if (d.mode != EnergyMode::off) flow(e, set_watts(panel, d.mode), contact, pressed, curve_of(d.mode), met, d);
  s.joules += d.tissue * dt;
  const double to_tissue = e.tip_contact * pressed * (s.tip - met.temperature);
  d.hot_touch = d.mode == EnergyMode::off && s.tip > kHotTip;
  d.tear_force = e.stick_force * s.stuck;
  s.tip += dt / e.tip_capacity * (e.tip_share * d.output - to_tissue - e.tip_air * (s.tip - kBodyHeat));
  s.now = d;
  return d;
}

void add_to_hash(core::Hasher& hasher, const ElectrodeState& s) noexcept { hasher.add(s); }

}  // namespace trocar::tissue
