#include <algorithm>

#include <trocar/interactions/instrument/syringe.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {

double NeedleModel::resistance(double viscosity) const noexcept {
  return 128 * viscosity * length / (portable::pi * bore * bore * bore * bore);  // [Poiseuille]
}

double NeedleModel::area() const noexcept { return 0.25 * portable::pi * plunger * plunger; }

PlungerPush push_plunger(const NeedleModel& needle, const AtTip& at, double wanted) noexcept {
  const double in_needle = needle.resistance(kInjected), most = needle.most_force / needle.area();
  PlungerPush out;
  const double opens = std::max(at.opening, at.pressure);
  if (at.opening > 0) {
    // It seeps away, as long as that is quick enough or the thumb is too weak for more.
    const double seep = at.opening / kSeeps;
    const double slow = std::min(wanted, (most - at.pressure) / (in_needle + seep));
    if (at.pressure + seep * slow < opens && (slow >= wanted || most <= opens)) {
      out.flow = std::max(0.0, slow);
      out.tip = at.pressure + seep * out.flow;
      // Tissue that presses harder than a thumb can holds the plunger where it is.
      out.force = std::min(needle.most_force, (out.tip + in_needle * out.flow) * needle.area());  // [plunger]
      return out;
    }
  }
  const double both = 1 + at.gapes * at.fills, beyond = at.fills / both;  // [back flow]
  out.flow = std::clamp((most - opens) / (in_needle + beyond), 0.0, wanted);
  out.tip = opens + beyond * out.flow;
  out.back = out.flow * (at.gapes * at.fills / both);
  out.force = std::min(needle.most_force, (out.tip + in_needle * out.flow) * needle.area());  // [plunger]
  return out;
}

double drawn_flow(const NeedleModel& needle, double pressure) noexcept {
  return std::max(0.0, (pressure + kVacuum) / needle.resistance(kDrawn));
}

}  // namespace trocar::interactions
