// Transcendental functions that give the same bits on every machine and compiler: built from + - * / and sqrt only.
// The step and the scene compiler use these and never libm's. Accuracy: a few ulp over the stated ranges (tests).
#pragma once

#include <numbers>

namespace trocar::portable {

double sin(double x) noexcept;  ///< |x| <= 1e4
double cos(double x) noexcept;  ///< |x| <= 1e4
double atan2(double y, double x) noexcept;
double acos(double x) noexcept;  ///< clamps |x| > 1
double asin(double x) noexcept;  ///< clamps |x| > 1
double exp(double x) noexcept;   ///< 0 below -708, clamps above 709
double log(double x) noexcept;   ///< x > 0

inline constexpr double pi = std::numbers::pi;  ///< the one that all of Trocar uses
inline constexpr double two_pi = 2 * pi;

}  // namespace trocar::portable
