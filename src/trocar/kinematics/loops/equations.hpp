// The scaled system that closing and reaching solve: metres divided by the mechanism's length, slopes by scaled
// coordinates.
#pragma once

#include <span>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {

/// How many conditions there are, of loops and goals.
int rows_of(const Mechanism& m, std::span<const Closure> goals) noexcept;
/// Lists what is not held.
void list_free(LoopWork& work) noexcept;
/// Pose and scaled residuals at u. @return the root of their squares' sum
double evaluate(const Mechanism& m, std::span<const double> u, LoopWork& work, std::span<const Closure> goals) noexcept;
/// Scaled slopes at the pose, of all coordinates.
void evaluate_slopes(const Mechanism& m, LoopWork& work, std::span<const Closure> goals, int rows) noexcept;

}  // namespace trocar::kinematics
