#include <algorithm>
#include <stdexcept>

#include <trocar/numerics/filters.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::numerics {
namespace {

/// One run over x, from the steady state of its first value (transposed direct form II).
void run(const LowPass& filter, std::span<double> x) {
  for (const Biquad& s : filter.sections) {
    // For a constant input u the output is u, too, which fixes both delays.
    double second = (s.b2 - s.a2) * x.front();
    double first = (s.b1 - s.a1) * x.front() + second;
    for (double& value : x) {
      const double in = value, out = s.b0 * in + first;
      first = s.b1 * in - s.a1 * out + second;
      second = s.b2 * in - s.a2 * out;
      value = out;
    }
  }
}

}  // namespace

LowPass butterworth_low_pass(int order, double cutoff, double rate) {
  if (order < 2 || order > 12 || order % 2 != 0)
    throw std::invalid_argument("butterworth_low_pass: the order must be even, 2 to 12");
  if (!(cutoff > 0) || !(cutoff < rate / 2))
    throw std::invalid_argument("butterworth_low_pass: the cut-off must lie between 0 and half the sampling rate");
  const double angle = portable::pi * cutoff / rate;
  const double k = portable::sin(angle) / portable::cos(angle);  // the cut-off, pre-warped
  LowPass filter;
  filter.order = order;
  for (int i = 0; i < order / 2; ++i) {
    // A pair of poles of 1 / (s^2 + 2 damping s + 1).
    const double damping = portable::sin(portable::pi * (2 * i + 1) / (2 * order));
    const double scale = 1 / (1 + 2 * damping * k + k * k), b = k * k * scale;
    filter.sections.push_back({b, 2 * b, b, 2 * (k * k - 1) * scale, (1 - 2 * damping * k + k * k) * scale});
  }
  return filter;
}

void filter_zero_phase(const LowPass& filter, std::span<double> x) {
  const std::size_t n = x.size();
  if (n < 2) return;
  const std::size_t pad = std::min(std::size_t(3 * (filter.order + 1)), n - 1);
  std::vector<double> extended(n + 2 * pad);
  for (std::size_t i = 0; i < pad; ++i) {
    extended[i] = 2 * x[0] - x[pad - i];
    extended[pad + n + i] = 2 * x[n - 1] - x[n - 2 - i];
  }
  std::copy(x.begin(), x.end(), extended.begin() + std::ptrdiff_t(pad));
  run(filter, extended);
  std::reverse(extended.begin(), extended.end());
  run(filter, extended);
  for (std::size_t i = 0; i < n; ++i) x[i] = extended[pad + n - 1 - i];
}

}  // namespace trocar::numerics
