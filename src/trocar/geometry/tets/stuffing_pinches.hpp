// Where a shape comes near to itself, cells of it may meet in an edge or a node only. A surface with such places has
// edges of four triangles, and nothing holds the body together there. Used by stuffing.cpp.
#pragma once

#include <array>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// Leaves cells out until those around every edge and every node hang together by faces there: of several groups the
/// largest stays (of equal ones that of the first cell). The order of what stays does not change.
/// @param on_surface  (points) whether a point may be in a face of one cell only
void leave_out_pinches(const std::vector<Vec3d>& points, std::vector<bool> on_surface,
                       std::vector<std::array<int, 4>>& cells);

}  // namespace trocar::geometry
