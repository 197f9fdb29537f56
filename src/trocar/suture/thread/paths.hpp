// Paths along which knots are laid, loosely, before they are pulled tight.
#pragma once

#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::suture {

/// One throw: how often one strand is wound round the other (1: single, 2: surgeon's), and which way round: a square
/// knot's throws change their sign, a granny's keep it.
struct Throw {
  int turns = 1;
  int sign = 1;
};

/// What is to be laid.
struct ThrowsPath {
  std::vector<Throw> throws_;  ///< the first is nearest to the loop
  double thickness = 0;        ///< of the thread [m]
  double tail = 0.03;          ///< free length at either end [m]
  double loop_radius = 0.004;  ///< of the loop below the first throw [m]
  double slack = 1.6;          ///< distance of the strands in a throw, in thicknesses
};

/// From the end of one tail, which lies to +x above, through the throws, round the loop, which lies below (-y) around
/// the axis z, and back to the end of the other tail.
std::vector<Vec3d> laid_throws(const ThrowsPath& what);

/// An overhand knot of `turns` (1: overhand, 2: double ...) in a thread that runs along x and is `length` long, its
/// loop of about the given radius.
std::vector<Vec3d> laid_overhand(int turns, double length, double loop_radius, double thickness);

/// Corners cut off, `times` over: smooth enough to lay thread along.
std::vector<Vec3d> smoothed(std::vector<Vec3d> path, int times);

}  // namespace trocar::suture
