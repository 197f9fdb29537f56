// Inverse kinematics: coordinates that bring frames of a mechanism where they shall be. A goal is a closure between a
// frame of the mechanism and one in space, so loops, a shaft that must go through its port, and goals are one system.
//
//   InverseWork work(m, 6);
//   const Closure goal = reach(m.frames[tip], wanted, kT | kR);
//   std::vector<double> u = m.start_u();                           // from here
//   const InverseReport report = inverse(m, {&goal, 1}, u, work);
//   if (!report.reached()) say(words(m, report));
//
// Damped least squares [Wampler 1986; Levenberg 1944] far away, where slopes mislead and poses may be singular;
// Newton's steps near by, which end at rounding. Coordinates that are free keep within their limits on the way; what is
// beyond at the end is turned by whole turns, then moved in the null space of the goals. Where an attempt ends
// elsewhere another one starts from another pose, the same ones every time. A single instrument through its port needs
// none of this: it has a formula (kinematics/fulcrum.hpp).
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {

/// `frame` is to be at `wanted`, in these directions of `wanted`'s axes.
Closure reach(const BodyFrame& frame, const Frame& wanted, unsigned directions = kT | kR) noexcept;
/// The z axis of `shaft` is to go through `port`: a remote centre that no joint is at.
Closure through(const BodyFrame& shaft, Vec3d port) noexcept;

struct InverseOptions {
  LoopOptions loops = {};
  int iterations = 60;  ///< of damped steps in an attempt
  int attempts = 400;   ///< at most
};

struct InverseWork {
  /// @param goals  conditions beside the mechanism's own, at most
  InverseWork(const Mechanism& m, int goals);
  LoopWork loops;
  numerics::PivotedQr damped;
  std::vector<double> start, best, gradient, rhs, kernel;
  std::vector<int> own;  ///< (u) the coordinate of q that is this one and no other, -1 where couplings use it
};

struct InverseReport {
  LoopReport last;
  int attempts = 0, iterations = 0;  ///< begun; damped steps of all
  /// At the goals and within all limits.
  bool reached() const noexcept { return last.closed() && last.limit < 0; }
};

/// u becomes the pose that was found; where none was, the nearest within limits of all attempts.
/// What work.loops holds (hold()) stays as it is. No allocation.
InverseReport inverse(const Mechanism& m, std::span<const Closure> goals, std::span<double> u, InverseWork& work,
                      const InverseOptions& options = {}) noexcept;

/// "reached to 2.2e-16 m and 3.1e-16 rad", or why not.
std::string words(const Mechanism& m, const InverseReport& report);

}  // namespace trocar::kinematics
