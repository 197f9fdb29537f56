#include <cmath>
#include <limits>

#include <trocar/numerics/fft.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/metrics/smoothness.hpp>

namespace trocar::training {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kLongestSpectrum = std::size_t(1) << 16;  // samples of one movement; bounds the spectrum's size

double peak_of(std::span<const double> speed) {
  double peak = 0;
  for (const double v : speed) peak = v > peak ? v : (-v > peak ? -v : peak);
  return peak;
}

}  // namespace

double dimensionless_jerk(std::span<const double> speed, double rate) {
  const std::size_t n = speed.size();
  const double peak = peak_of(speed);
  if (n < 3 || !(peak > 0)) return kUndefined;
  const double duration = double(n) / rate;
  double sum = 0;
  for (std::size_t i = 0; i + 2 < n; ++i) {
    const double jerk = (speed[i + 2] - 2 * speed[i + 1] + speed[i]) * rate * rate;
    sum += jerk * jerk;
  }
  return -(duration * duration * duration) / (peak * peak) * (sum / rate);
}

double log_dimensionless_jerk(std::span<const double> speed, double rate) {
  const double jerk = -dimensionless_jerk(speed, rate);
  return jerk > 0 ? -portable::log(jerk) : kUndefined;
}

double spectral_arc_length(std::span<const double> speed, double rate, const SpectralArcSettings& settings) {
  if (speed.size() < 2 || speed.size() > kLongestSpectrum) return kUndefined;
  const std::size_t points = numerics::fft_size(speed.size()) << settings.pad_level;
  const std::vector<double> spectrum = numerics::magnitude_spectrum(speed, points);
  double largest = 0;
  for (const double m : spectrum) largest = m > largest ? m : largest;
  if (!(largest > 0)) return kUndefined;

  const double step = rate / double(points);
  std::size_t first = spectrum.size(), last = 0;
  for (std::size_t k = 0; k < spectrum.size() && double(k) * step <= settings.cutoff; ++k) {
    if (spectrum[k] < settings.least_amplitude * largest) continue;
    if (first == spectrum.size()) first = k;
    last = k;
  }
  if (first >= last) return kUndefined;
  const double across = 1 / double(last - first);  // frequencies are scaled to 0..1
  double length = 0;
  for (std::size_t k = first; k < last; ++k) {
    const double up = (spectrum[k + 1] - spectrum[k]) / largest;
    length += std::sqrt(across * across + up * up);
  }
  return -length;
}

std::vector<Movement> movements(std::span<const double> speed, double rate) {
  const double least = kMovementShare * peak_of(speed);
  std::vector<Movement> found;
  if (!(least > 0)) return found;
  Movement now;
  for (std::size_t i = 0; i <= speed.size(); ++i) {
    if (i < speed.size() && speed[i] >= least) {
      if (now.count == 0) now.first = i;
      ++now.count;
      continue;
    }
    if (double(now.count) >= kShortestMovement * rate) found.push_back(now);
    now.count = 0;
  }
  return found;
}

}  // namespace trocar::training
