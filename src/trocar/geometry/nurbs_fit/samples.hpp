// Points that a surface shall pass by, with the parameters at which it should and how much each counts.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

struct Samples {
  std::vector<Vec3d> points;
  std::vector<double> shares;                     ///< sum 1
  std::vector<std::array<double, 2>> parameters;  ///< (u, v)
};

/// Of a mesh with (u, v) at its vertices: the vertices with a quarter of their triangles' areas, and points inside of
/// triangles, as many as it takes that they are not further apart than `spacing` [m], with the rest (Simpson's rule).
/// @param wraps u goes around, 1 is 0 again @param poles vertices at which u says nothing: their triangles take it from
/// the other corners
Samples samples_of(const TriMesh& mesh, const std::vector<std::array<double, 2>>& parameters, double spacing,
                   bool wraps = false, const std::vector<int>& poles = {});

}  // namespace trocar::geometry::nurbs
