// The middle line of a piece of bowel that is drawn only, and how several such lines come to lie: beside each other,
// beside organs and on the floor, touching but not within one another.
#pragma once

#include <span>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

inline constexpr double kGutStep = 0.003;  ///< [m] between points of a line
inline constexpr int kGutSides = 22;       ///< vertices around it

struct GutLine {
  std::vector<Vec3d> points;
  std::vector<double> radius;  ///< [m]
  std::vector<double> hold;    ///< 0..1: how firmly a point stays where it was put (ends, what goes through a wall)
};

/// A smooth line through knots, kGutStep apart. [Catmull & Rom 74]
std::vector<Vec3d> line_through(std::span<const Vec3d> knots);

/// Moves points until no two lines, nor two parts of one, are within each other, nor within `bodies` (points on the
/// skin of organs) nor below the walls.
void settle(std::vector<GutLine>& lines, std::span<const Vec3d> bodies, const WallSurface& walls);

/// The tube around a line. Its patterns run round it, as its vessels do. @param up which way its lit side looks
/// @param patch sets its patterns apart from those of others
MeshBuffer gut(const GutLine& line, Vec3d up, int patch);

}  // namespace trocar::view
