// How far two shapes of a mechanism are apart; below 0: how deep they are in each other. Capsules are exact; cylinders
// count as capsules of the same ends, which is on the safe side by a radius at each end. Boxes are exact; of a rod
// through a box the depth is that of the deepest point of its middle line, and its radius.
#pragma once

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::studies {

/// A shape in space.
struct PlacedShape {
  bool box = false;
  Vec3d a, b;                      ///< ends of a middle line; of a box: its middle, half its edges
  double radius = 0;               ///< not of a box
  Mat3d axes = Mat3d::identity();  ///< of a box
};
PlacedShape placed(const kinematics::BodyShape& shape, const kinematics::Pose& pose) noexcept;

double clearance(const PlacedShape& first, const PlacedShape& second) noexcept;

/// Least distance of two segments.
double segment_distance(Vec3d a, Vec3d b, Vec3d c, Vec3d d) noexcept;

}  // namespace trocar::studies
