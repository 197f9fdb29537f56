#include <algorithm>

#include <trocar/fluids/optics.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::fluids {
namespace {

double fraction(double f) { return f > 0 ? std::min(f, 1.0) : 0.0; }  // NaN counts as none

struct Absorption {
  double from_blood, from_bile, from_saline;  ///< [1/m]
};

Absorption absorption(const Optics& o, const Shares& s, double Rgb::*channel) {
  const double blood = fraction(s.blood), bile = std::min(fraction(s.bile), 1 - blood);
  const double along = std::clamp((s.saturation - 0.70) / 0.28, -2.5, 1.1);
  const double mu = o.venous.*channel + along * (o.arterial.*channel - o.venous.*channel);
  return {blood * std::max(mu, 0.0), bile * o.bile.*channel, (1 - blood - bile) * o.saline.*channel};
}

double transmitted(const Absorption& a, double path) {
  return portable::exp(-(a.from_blood + a.from_bile + a.from_saline) * (path > 0 ? path : 0.0));
}

}  // namespace

Rgb transmission(const Optics& o, const Shares& s, double path) noexcept {
  Rgb t;
  for (double Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b}) t.*channel = transmitted(absorption(o, s, channel), path);
  return t;
}

Rgb seen_through(const Optics& o, const Shares& s, double path, Rgb bed) noexcept {
  // The two fluids send light back in proportion to what each takes of the brightest light that it lets through.
  const double blood = fraction(s.blood), bile = std::min(fraction(s.bile), 1 - blood);
  const double cells = 20 * blood, share_of_blood = cells > 0 ? cells / (cells + bile) : 0;
  Rgb seen;
  for (double Rgb::*channel : {&Rgb::r, &Rgb::g, &Rgb::b}) {
    const double t = transmitted(absorption(o, s, channel), path);
    const double deep = share_of_blood * o.deep_blood.*channel + (1 - share_of_blood) * o.deep_bile.*channel;
    seen.*channel = bed.*channel * t + deep * (1 - t);
  }
  return seen;
}

double clot_brightness(double age) noexcept {
  const double share = std::clamp((age - 180) / 120, 0.0, 1.0);
  return 1 - 0.6 * share;
}

}  // namespace trocar::fluids
