#include <limits>

#include <trocar/tissue/base/law.hpp>

namespace trocar::tissue {

double inverse_shape(const SpringLaw& law, double value) noexcept {
  const double target = value < 0 ? -value : value;
  double low = 0, high = 1;
  while (law.shape(high) < target && high < 1e12) high *= 2;
  for (int i = 0; i < 200; ++i) {
    const double mid = low + (high - low) / 2;
    if (mid <= low || mid >= high) break;
    (law.shape(mid) < target ? low : high) = mid;
  }
  const double eps = low + (high - low) / 2;
  return value < 0 ? -eps : eps;
}

double rest_length_for_tension(const SpringLaw& law, double k, double r, double f) noexcept {
  // k l shape(r/l - 1) falls with l: growing l shortens the elongation faster than it lengthens the arm.
  double low = r / 8, high = r * 8;
  const auto tension = [&](double l) { return k * l * law.shape(r / l - 1); };
  if (!(tension(low) >= f && tension(high) <= f)) return std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 200; ++i) {
    const double mid = low + (high - low) / 2;
    if (mid <= low || mid >= high) break;
    (tension(mid) > f ? low : high) = mid;
  }
  return low + (high - low) / 2;
}

}  // namespace trocar::tissue
