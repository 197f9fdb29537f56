// Gauss's quadrature with five points: exact for polynomials up to degree 9.  [Abramowitz & Stegun 1964, table 25.4]
#pragma once

namespace trocar::geometry::nurbs {

struct GaussPoint {
  double at, share;  ///< on -1 .. 1; shares sum to 2
};
inline constexpr GaussPoint kGauss5[5] = {{-0.9061798459386640, 0.2369268850561891},
                                          {-0.5384693101056831, 0.4786286704993665},
                                          {0.0, 0.5688888888888889},
                                          {0.5384693101056831, 0.4786286704993665},
                                          {0.9061798459386640, 0.2369268850561891}};

/// Integral of f from a to b.
template <class F>
auto gauss5(double a, double b, const F& f) {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  auto sum = (half * kGauss5[0].share) * f(middle + half * kGauss5[0].at);
  for (int k = 1; k < 5; ++k) sum = sum + (half * kGauss5[k].share) * f(middle + half * kGauss5[k].at);
  return sum;
}

}  // namespace trocar::geometry::nurbs
