// The elastic solid that a dense tangle of springs is: what a spring network can be made to agree with, isotropic or
// with fibres. Central springs make the stiffness tensor symmetric in all its indices (Cauchy's relations), so
// Poisson's ratio is 1/4 where there are no fibres.
//
// The springs' stiffness per volume and direction n is S (1 + a (n f)^2): S from Young's modulus, a from how much
// stiffer the tissue is along its fibres f than across. Moments of directions over the sphere give the rest (our
// derivation; tests check the moduli).
//
//   const SpringMedium m = spring_medium(20e3, {0, 0, 1}, 1.5);  // 20 kPa across, 30 kPa along z
//   const Stress sigma = stress(m, strain);
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::tissue {

/// Symmetric 3 x 3: xx, yy, zz, yz, xz, xy (tensor components, not engineering shear).
struct Symmetric {
  double xx = 0, yy = 0, zz = 0, yz = 0, xz = 0, xy = 0;
  Vec3d operator*(Vec3d v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  double trace() const { return xx + yy + zz; }
};

struct SpringMedium {
  double s = 0;                    ///< S [Pa]
  double a = 0;                    ///< fibre term, > -1
  Vec3d f{0, 0, 0};                ///< fibre direction, unit length; zero: none
  double density(Vec3d n) const {  ///< relative stiffness of springs along unit n
    const double c = dot(n, f);
    return 1 + a * c * c;
  }
};

inline constexpr double kMostFibreRatio = 4;  ///< central springs alone cannot do more than about 4.5

/// @param across  Young's modulus across the fibres, or everywhere [Pa] > 0
/// @param fibre   direction of the fibres, any length; zero: isotropic
/// @param ratio   Young's modulus along them over that across, 1/2 .. kMostFibreRatio
/// @throws std::invalid_argument
SpringMedium spring_medium(double across, Vec3d fibre = {0, 0, 0}, double ratio = 1);

/// Stress in it under a small strain [Pa].
Symmetric stress(const SpringMedium& medium, const Symmetric& strain) noexcept;

/// Young's modulus along unit n [Pa].
double youngs_modulus(const SpringMedium& medium, Vec3d n);

}  // namespace trocar::tissue
