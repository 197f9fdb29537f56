// Whether something lies on a straight way through a scene as it was drawn: of an instrument, or of an eye's ray.
#pragma once

#include <vector>

#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

/// What may lie on a way.
struct DrawnPoint {
  Vec3d at;           ///< [m]
  double radius = 0;  ///< [m]
};
/// Of all organs but one, of strands and of folds, in the drawn shape. A few millimetres apart.
std::vector<DrawnPoint> drawn_points_but(const sim::Model& model, int organ);

/// Of what encloses a scene.
std::vector<DrawnPoint> wall_points(const sim::Model& model);

/// From `p` to the segment from `a` to `b` [m].
double off_segment(Vec3d p, Vec3d a, Vec3d b);

/// How many of the points lie within `radius` of the segment.
int points_near(const std::vector<DrawnPoint>& points, Vec3d a, Vec3d b, double radius);

}  // namespace trocar::attempt
