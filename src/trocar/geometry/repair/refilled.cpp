#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/repair/refilled.hpp>
#include <trocar/geometry/surfaces/triangle_tree.hpp>
#include <trocar/geometry/tets/stuffing.hpp>

namespace trocar::geometry {
namespace {

constexpr double kCellOfEdge = 0.75;
constexpr double kCoarser = 1.25;  ///< larger cubes, where there would be too many cells
constexpr int kCellTries = 12;

double mean_side(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) sum += length(mesh.positions[t[(k + 1) % 3]] - mesh.positions[t[k]]);
  return mesh.triangles.empty() ? 0 : sum / (3.0 * double(mesh.triangles.size()));
}

/// At least so large that the lattice around the box has no more cubes than stuffing takes.
double bounded_cell(const Bounds& box, double cell, int most_cells) {
  const Vec3d side = box.high - box.low;
  const auto cubes = [&](double c) { return (side.x / c + 4) * (side.y / c + 4) * (side.z / c + 4); };
  while (cubes(cell) > 4.0 * most_cells) cell *= 1.1;
  return cell;
}

Refilled skin_of(const TriMesh& mesh, const Field& field, double cell, const RefillOptions& options) {
  Refilled out;
  StuffingOptions stuffing;
  stuffing.most_cells = options.most_cells;
  out.cell = bounded_cell(field.box, cell, options.most_cells);
  for (int attempt = 0; attempt < kCellTries && out.mesh.triangles.empty(); ++attempt) {
    try {
      out.mesh = surface_of(stuffed(field, out.cell, stuffing)).mesh;
      out.why.clear();
    } catch (const std::invalid_argument& refused) {
      out.why = refused.what();
      out.cell *= kCoarser;
    }
  }
  if (out.mesh.triangles.empty()) return out;
  const TriangleTree tree(out.mesh);
  for (const auto& t : mesh.triangles)
    for (const int v : t) out.farthest = std::max(out.farthest, tree.distance2(mesh.positions[v]));
  out.farthest = std::sqrt(out.farthest);
  return out;
}

}  // namespace

Refilled refilled(const TriMesh& mesh, const RefillOptions& options) {
  Refilled out;
  const double cell = options.cell > 0 ? options.cell : kCellOfEdge * mean_side(mesh);
  try {
    return skin_of(mesh, field_of(mesh), cell, options);
  } catch (const std::invalid_argument& refused) {
    out.why = refused.what();
  }
  return out;
}

Refilled thickened(const TriMesh& mesh, double thickness, const RefillOptions& options) {
  Refilled out;
  if (mesh.triangles.empty() || !(thickness > 0)) {
    out.why = "triangles and a thickness above 0 expected";
    return out;
  }
  const auto distance = distance_to(mesh);
  Bounds box = bounds(mesh.positions);
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= 0.5 * thickness;
    box.high[k] += 0.5 * thickness;
  }
  const Field field{[distance, thickness](Vec3d p) { return 0.5 * thickness - distance(p); }, box, 1.0};
  return skin_of(mesh, field, options.cell > 0 ? options.cell : 0.4 * thickness, options);
}

}  // namespace trocar::geometry
