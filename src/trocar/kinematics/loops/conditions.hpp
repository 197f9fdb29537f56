// The conditions that close loops, as numbers: how far each is from holding, and how that changes with the coordinates.
#pragma once

#include <span>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {

/// Frames of a closure's two sides, in the ground's.
struct ClosureFrames {
  Frame a, b;
};
inline ClosureFrames frames_of(const Closure& c, const Pose& pose) noexcept {
  return {place(c.a, pose), place(c.b, pose)};
}

/// How far the conditions of closures are from holding. @param r (sum of their counts) [m, rad]
void residuals(std::span<const Closure> closures, const Pose& pose, double* r) noexcept;

/// d r / d u. @param j (rows x u_count), column by column with `rows` to a column; row numbers begin at `first`
void slopes(const Mechanism& m, std::span<const Closure> closures, const Pose& pose, double* j, int rows,
            int first = 0) noexcept;

/// The share of d2 r / dt2 that comes of speeds alone, at accelerations that are those of speeds alone (dynamics).
/// @param speeds, bias (bodies) twists at the frames' origins; accelerations there with d2u/dt2 = 0
void curvatures(std::span<const Closure> closures, const Pose& pose, std::span<const Twist> speeds,
                std::span<const Twist> bias, double* c) noexcept;

/// Is each condition a length?
bool is_length(const Condition& c) noexcept;

}  // namespace trocar::kinematics
