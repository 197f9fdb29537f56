// How long a time step may be: the paper's criterion as it is printed, the true limits of the integrator (3), and the
// bound the network is compiled with.
//
// For one mass m on a spring k with a damper d, stepped by (3) (velocity first, then position with the new velocity):
//   printed (4b)               dt < (d + sqrt(d^2 + 2 m k)) / k        unsafe for d > 0.29 sqrt(m k)
//   damping taken explicitly   dt < (-d + sqrt(d^2 + 4 m k)) / k
//   damping taken implicitly   dt < ( d + sqrt(d^2 + 4 m k)) / k
// For a network the leapfrog form of (3) conserves an energy with the matrix M - dt C/2 - dt^2 K/4, which is positive
// where every node satisfies m_i - dt c_i - dt^2 k_i / 2 > 0 with k_i, c_i the largest eigenvalues of its own 3x3
// stiffness and damping blocks (K <= 2 blockdiag K_ii): no eigenvalue problem, and rigorous at the given tangent.
#pragma once

namespace trocar::tissue {

/// Criterion (4a) as printed: d > dt k / 2 - m / dt. For the record only.      [KCM99 eq.4]
bool stable_as_printed(double mass, double k, double d, double dt) noexcept;
/// Limit (4b) as printed [s]. For the record only.                             [KCM99 eq.4]
double dt_limit_as_printed(double mass, double k, double d) noexcept;
/// True limit of (3) with explicit damping [s].
double dt_limit_explicit_damping(double mass, double k, double d) noexcept;
/// True limit of (3) with the damping force taken at the new velocity [s].
double dt_limit_implicit_damping(double mass, double k, double d) noexcept;
/// Sufficient limit for a node of a network [s]: mass [kg], largest eigenvalue of its stiffness block [N/m] and of its
/// damping block [N s/m] (both explicit). Infinite where both are 0.
double dt_limit_node(double mass, double k_max, double d_max) noexcept;
/// Largest eigenvalue of a symmetric 3x3 matrix, given as xx, yy, zz, xy, xz, yz (Jacobi rotations, portable).
double largest_eigenvalue(double xx, double yy, double zz, double xy, double xz, double yz) noexcept;
/// Sub-steps a tick needs: the smallest n with tick / n <= safety * limit, at least 1.
inline constexpr int kMostSubsteps = 500;  ///< in a tick; a scene's body that needs more is refused
int substeps_for(double tick, double limit, double safety = 0.9) noexcept;

}  // namespace trocar::tissue
