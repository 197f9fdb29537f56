// Motion of a mechanism with masses under forces: offline, small and dense.
//
//   M(u) ddu = f(u, du) + J^T lambda,   J ddu = -c(u, du)
//
// M from bodies' Jacobians; f is what recursive Newton-Euler leaves of gravity, springs, torques and of speeds [Luh
// 1980]; J are the slopes of the loops' conditions. These may depend on each other: accelerations are unique all the
// same, and of the multipliers the shortest are taken. After each step places and speeds are put back onto the
// conditions, along what masses resist least, so that they do not drift.
//
//   DynamicsWork work(m);
//   MotionState s{m.start_u(), std::vector<double>(m.u_count())};
//   project(m, s, work);
//   for (int k = 0; k < 1000; ++k) step(m, torques, 1e-4, s, work);
//
// Runge-Kutta of fourth order; no allocation in a step.
#pragma once

#include <span>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {

struct MotionState {
  std::vector<double> u, du;  ///< independent coordinates and their speeds
};

struct DynamicsWork {
  explicit DynamicsWork(const Mechanism& m);
  Pose pose;
  std::vector<double> dq, ddq, tau;  ///< (q_count)
  std::vector<Twist> speeds, bias,
      wrench;                        ///< (bodies); wrench: turn holds the moment about the origin, move the force
  std::vector<Twist> columns;        ///< (u_count)
  std::vector<double> mass, factor;  ///< (u_count^2) M and its Cholesky factor, row by row
  std::vector<double> force, acceleration;                              ///< (u_count)
  std::vector<double> residual, slope, square, curvature, multipliers;  ///< of conditions; square: L^-1 J^T
  std::vector<double> a, b, c;                                          ///< scratch
  std::vector<double> u0, du0, sum_u, sum_du, k_u, k_du;
  numerics::PivotedQr across, back;
};

enum class MotionStatus : unsigned char {
  good,
  massless,  ///< a coordinate moves no mass, so that its acceleration is not defined
  open,      ///< loops could not be closed: the step is too long, or the pose singular
  not_finite,
};
const char* words(MotionStatus status) noexcept;

/// What changes nothing of M is added up here: forces of independent coordinates (u_count) [N m, N].
using Torques = std::span<const double>;

/// work.acceleration, and work.multipliers of the closures' conditions [N, N m], at a state.
MotionStatus accelerate(const Mechanism& m, Torques torques, const MotionState& s, DynamicsWork& work) noexcept;
/// Puts places and speeds onto the loops' conditions.
MotionStatus project(const Mechanism& m, MotionState& s, DynamicsWork& work) noexcept;
/// One step of `dt` [s] and the projection after it. s is changed only where all went well.
MotionStatus step(const Mechanism& m, Torques torques, double dt, MotionState& s, DynamicsWork& work) noexcept;

/// Torques of the coordinates `driven` that give these accelerations, which must suit the loops: the shortest, where
/// drives or conditions are redundant. @param torques (u_count), 0 where nothing is driven
/// @return the largest part of the motion's forces that they cannot give [N m, N]
double inverse_dynamics(const Mechanism& m, const MotionState& s, std::span<const double> acceleration,
                        std::span<const int> driven, std::span<double> torques, DynamicsWork& work);

/// Kinetic and potential energy (gravity, springs) [J].
struct Energy {
  double kinetic = 0, potential = 0;
  double total() const noexcept { return kinetic + potential; }
};
Energy energy(const Mechanism& m, const MotionState& s, DynamicsWork& work) noexcept;

}  // namespace trocar::kinematics
