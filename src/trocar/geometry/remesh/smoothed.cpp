#include <algorithm>
#include <cmath>

#include <trocar/geometry/remesh/smoothed.hpp>
#include <trocar/geometry/surfaces/edge_table.hpp>

namespace trocar::geometry {
namespace {

std::vector<bool> border_vertices(const TriMesh& mesh) {
  std::vector<bool> out(mesh.positions.size());
  EdgeTable(mesh).for_each([&](std::span<const EdgeUse> uses) {
    if (uses.size() != 2) out[uses[0].low] = out[uses[0].high] = true;
  });
  return out;
}

void towards_neighbours(TriMesh& mesh, const Csr& neighbours, const std::vector<bool>& fixed, double share) {
  const std::vector<Vec3d> before = mesh.positions;
  for (int v = 0; v < neighbours.rows(); ++v) {
    const auto around = neighbours.row(v);
    if (fixed[v] || around.empty()) continue;
    Vec3d sum{};
    for (const int w : around) sum += before[w];
    mesh.positions[v] += share * (sum / double(around.size()) - before[v]);
  }
}

/// Along the normals, so far that the volume is what it was.
void give_back(TriMesh& mesh, double wanted) {
  for (int round = 0; round < 6; ++round) {
    const double missing = wanted - volume(mesh), surface = area(mesh);
    if (!(surface > 0) || std::fabs(missing) <= 1e-9 * std::fabs(wanted)) return;
    const std::vector<Vec3d> normals = vertex_normals(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v) mesh.positions[v] += (missing / surface) * normals[v];
  }
}

}  // namespace

Smoothed smoothed(const TriMesh& mesh, int passes, const SmoothOptions& options) {
  Smoothed out{mesh, volume(mesh), 0, 0};
  const Csr neighbours = vertex_neighbours(mesh);
  const std::vector<bool> fixed = border_vertices(mesh);
  for (int pass = 0; pass < passes; ++pass) {
    towards_neighbours(out.mesh, neighbours, fixed, options.shrink);
    towards_neighbours(out.mesh, neighbours, fixed, -options.swell);
  }
  const bool closed = std::find(fixed.begin(), fixed.end(), true) == fixed.end();
  if (options.keep_volume && closed && passes > 0) give_back(out.mesh, out.volume_before);
  out.volume = volume(out.mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    out.farthest = std::max(out.farthest, length(out.mesh.positions[v] - mesh.positions[v]));
  return out;
}

}  // namespace trocar::geometry
