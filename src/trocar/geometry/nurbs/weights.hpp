// A surface point as a weighted sum of control points: a row of W in x = W q, for bodies whose masses are their control
// points. What pulls at the point goes back to them by the same numbers.
//
//   const std::vector<Share> row = weights_at(surface, u, v);       // sum of row[k].value is 1, none is below 0
//   const Vec3d x = combined(row, surface.points);                  // = point(surface, u, v)
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

struct Share {
  int index = 0;       ///< of the control point, or of the node
  double value = 0.0;  ///< of the rational basis function  [PT97 eq.4.12]
};

/// The (degree_u + 1) (degree_v + 1) control points on which the point depends; values may be 0.
std::vector<Share> weights_at(const Surface& surface, double u, double v);
/// The same by nodes, each once, ascending: for closed bodies, poles and seams of which are one mass.
std::vector<Share> node_weights_at(const Surface& surface, const Nodes& nodes, double u, double v);
Vec3d combined(std::span<const Share> row, std::span<const Vec3d> places) noexcept;

/// W for many points: rows in two arrays, by nodes, zeros left out.
struct WeightRows {
  Csr nodes;                   ///< row r: the nodes on which point r depends
  std::vector<double> values;  ///< as nodes.items
};
WeightRows weight_rows(const Surface& surface, const Nodes& nodes, std::span<const std::array<double, 2>> parameters);

}  // namespace trocar::geometry::nurbs
