// The spring law of living tissue, a third-degree polynomial of strain, continued linearly beyond a declared strain.
//
//   s(eps) = k l eps (1 + P1 |eps| + P2 eps^2)      |eps| <= cap        [KCM99 eq.5]
//          = s(cap) + s'(cap) (|eps| - cap), signed   beyond
//
// with eps = e/l, e = r - l the elongation [KCM99 eq.2] and k the small-strain stiffness [N/m], so that k l plays the
// part of E times area. Deviations: (5) is printed for compression; here it holds for tension and compression alike
// (odd in eps), and the linear continuation is our choice: a bounded tangent is what makes the time step bound hold.
//
//   const SpringLaw law{2.0, 100.0, 0.35};
//   double force = k * l * law.shape(r / l - 1);
#pragma once

#include <trocar/core/fields.hpp>

namespace trocar::tissue {

template <class Real>
struct SpringLawT {
  Real p1 = 0;         ///< linear shape factor P1 [-]
  Real p2 = 0;         ///< quadratic shape factor P2 [-]
  Real cap = Real(1);  ///< strain beyond which the law continues linearly [-], > 0

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("p1", s.p1), v("p2", s.p2), v("cap", s.cap);
  }

  /// Shape function [-]: force = k l shape(eps). Free of branches: min and sign only.
  constexpr Real shape(Real eps) const {
    const Real a = eps < 0 ? -eps : eps;
    const Real am = a < cap ? a : cap;
    const Real g = am + am * am * (p1 + p2 * am) + cap_slope() * (a - am);
    return eps < 0 ? -g : g;
  }
  /// d shape / d eps [-], >= 1 at 0; the tangent stiffness of the spring is k * slope(eps).
  constexpr Real slope(Real eps) const {
    const Real a = eps < 0 ? -eps : eps;
    const Real am = a < cap ? a : cap;
    return 1 + am * (2 * p1 + 3 * p2 * am);
  }
  /// Slope at and beyond the cap: the largest there is when the law is monotone with P1, P2 >= 0.
  constexpr Real cap_slope() const { return 1 + cap * (2 * p1 + 3 * p2 * cap); }
  /// Integral of shape from 0 [-]: stored energy = k l^2 energy(eps) [J].
  constexpr Real energy(Real eps) const {
    const Real a = eps < 0 ? -eps : eps;
    const Real am = a < cap ? a : cap;
    const Real below = am * am * (Real(1) / 2 + am * (p1 / 3 + p2 / 4 * am));
    const Real more = a - am;
    const Real at_cap = am + am * am * (p1 + p2 * am);
    return below + more * (at_cap + cap_slope() * more / 2);
  }
  /// True where the force grows with strain everywhere: P1 >= 0, or P1^2 < 3 P2.
  constexpr bool monotone() const { return cap > 0 && (p1 * p1 < 3 * p2 || (p1 >= 0 && p2 >= 0)); }
  /// The largest slope on [0, inf): at the cap, or at 0 for a law that softens.
  constexpr Real max_slope() const { return cap_slope() > 1 ? cap_slope() : Real(1); }
};

using SpringLaw = SpringLawT<double>;

/// Strain at which the law gives this shape value: the inverse of shape(), by bisection (portable, ~1e-15).
/// @param value  force / (k l) [-]
double inverse_shape(const SpringLaw& law, double value) noexcept;

/// Rest length l at which a spring of stiffness k, now of length r, carries the tension f (compression < 0):
/// solves k l shape(r/l - 1) = f.
/// @return l [m]; NaN where no length in [r/8, 8r] does
double rest_length_for_tension(const SpringLaw& law, double k, double r, double f) noexcept;

}  // namespace trocar::tissue
