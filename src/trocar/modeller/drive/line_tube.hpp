// A closed tube around a line of points, for other programs: rings that turn along it as little as possible, flat ends.
#pragma once

#include <span>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::modeller {

inline constexpr int kTubeSides = 24;

/// The ring's area is that of the circle (its corners lie 0.6 % outside), so that the tube's volume is that of round
/// slices. It goes through itself where the line bends more sharply than the tube is thick.
/// @param line    two or more points [m]; those at the place of the one before are left out
/// @param radius  (points) [m], > 0
geometry::TriMesh tube_around(std::span<const Vec3d> line, std::span<const double> radius);

}  // namespace trocar::modeller
