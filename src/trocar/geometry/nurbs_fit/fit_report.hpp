// The report of every kind of fit.
#pragma once

#include <span>

#include <trocar/geometry/nurbs_fit/fit.hpp>

namespace trocar::geometry::nurbs {

/// Distances of points to the surface, their mean square and the greatest; nothing else.
FitReport residuals_of(const Surface& surface, std::span<const Vec3d> points);
/// @throws std::invalid_argument for fewer than 16 points, and for numbers that are none
void require_cloud(std::span<const Vec3d> cloud, const char* who);

}  // namespace trocar::geometry::nurbs
