#include <cstddef>

#include <trocar/numerics/portable.hpp>
#include <trocar/vessels/heart.hpp>

namespace trocar::vessels {
namespace {

constexpr double kBeat = 60.0 / 72, kPeak = 0.15, kNotch = 0.35, kDecay = 0.6;
constexpr double kBump = 0.08, kBumpTime = 0.12;  // the wave after the notch; our choice

/// Half a cosine from 0 at x = 0 to 1 at x = 1.
double rise(double x) { return 0.5 - 0.5 * portable::cos(portable::pi * x); }

/// The beat is `fixed` + notch `share`: parts of it at the time t.
struct Parts {
  double fixed, share;
};

Parts beat_parts(double t) {
  if (t < kPeak) return {rise(t / kPeak), 0};
  if (t < kNotch) {
    const double down = rise((t - kPeak) / (kNotch - kPeak));
    return {1 - down, down};
  }
  const double last = portable::exp(-(kBeat - kNotch) / kDecay);
  const double decay = (portable::exp(-(t - kNotch) / kDecay) - last) / (1 - last);
  const double x = (t - kNotch) / kBumpTime;
  return {x < 1 ? kBump * rise(2 * x) : 0, decay};
}

}  // namespace

std::vector<double> textbook_beat(int steps) {
  std::vector<Parts> parts(std::size_t(steps), Parts{});
  double fixed = 0, share = 0;
  for (int i = 0; i < steps; ++i) {
    parts[i] = beat_parts(kBeat * i / steps);
    fixed += parts[i].fixed / steps;
    share += parts[i].share / steps;
  }
  const double notch = (1.0 / 3 - fixed) / share;
  std::vector<double> beat(parts.size());
  for (int i = 0; i < steps; ++i) beat[i] = parts[i].fixed + notch * parts[i].share;
  return beat;
}

LossResponse response_to(const Heart& heart, double loss) noexcept {
  const auto& knots = heart.response;
  if (!(loss > knots.front().loss)) return knots.front();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const LossResponse &a = knots[i - 1], &b = knots[i];
    if (loss >= b.loss) continue;
    const double w = (loss - a.loss) / (b.loss - a.loss);
    return {loss, a.mean + w * (b.mean - a.mean), a.pulse + w * (b.pulse - a.pulse), a.rate + w * (b.rate - a.rate)};
  }
  return knots.back();
}

}  // namespace trocar::vessels
