// Whether something lies on a straight way through a scene as it was drawn: of an instrument, or of an eye's ray.
#pragma once

#include <vector>

#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

/// Points of all organs but one, of strands and of folds, as drawn [m]. A few millimetres apart.
std::vector<Vec3d> drawn_points_but(const sim::Model& model, int organ);

/// From `p` to the segment from `a` to `b` [m].
double off_segment(Vec3d p, Vec3d a, Vec3d b);

/// How many of the points lie nearer than `radius` to the segment.
int points_near(const std::vector<Vec3d>& points, Vec3d a, Vec3d b, double radius);

}  // namespace trocar::attempt
