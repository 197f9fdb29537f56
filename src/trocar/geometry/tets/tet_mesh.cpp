#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/geometry/surfaces/groups.hpp>
#include <trocar/geometry/tets/tet_cut.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/geometry/tets/tet_volume.hpp>

namespace trocar::geometry {
namespace {

int duplicate_cells(const TetMesh& mesh) {
  std::vector<std::array<int, 4>> corners = mesh.cells;
  for (auto& c : corners) std::sort(c.begin(), c.end());
  std::sort(corners.begin(), corners.end());
  return int(corners.end() - std::unique(corners.begin(), corners.end()));
}

/// Of triangles: edges that not exactly two of them share.
int odd_edges(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<int, 2>> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) edges.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(edges.begin(), edges.end());
  int odd = 0;
  for (std::size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last] == edges[first]) ++last;
    odd += last - first != 2;
  }
  return odd;
}

void count_faces(const TetMesh& mesh, TetFacts& facts) {
  Groups parts(mesh.cells.size());
  std::vector<std::array<int, 3>> surface;
  const std::vector<TetFace> faces = sorted_faces(mesh);
  for_each_face(faces, [&](std::span<const TetFace> same) {
    std::size_t outwards = 0;
    for (const TetFace& face : same) {
      parts.join(same[0].cell, face.cell);
      outwards += face.outwards;
    }
    if (same.size() == 1) surface.push_back(same[0].nodes);
    if (same.size() > 2) ++facts.crowded_faces;
    if (outwards > 1 || same.size() - outwards > 1) ++facts.overlapping_faces;
  });
  facts.parts = parts.count();
  facts.surface_triangles = int(surface.size());
  facts.odd_edges = odd_edges(surface);
}

void measure_cells(const TetMesh& mesh, TetFacts& facts) {
  const double box = diagonal(facts.box);
  int good = 0;
  for (int c = 0; c < facts.cells; ++c) {
    const double v = volume(mesh, c), size = std::fabs(v);
    facts.volume += size;
    facts.largest_volume = std::max(facts.largest_volume, size);
    if (is_flat(mesh, c, box)) {
      ++facts.flat;
      continue;
    }
    if (v < 0) ++facts.inverted;
    std::array<Vec3d, 4> corner{};
    for (int k = 0; k < 4; ++k) corner[k] = mesh.points[mesh.cells[c][k]];
    if (v < 0) std::swap(corner[2], corner[3]);
    const double angle = least_dihedral(corner);
    facts.smallest_volume = good == 0 ? size : std::min(facts.smallest_volume, size);
    facts.smallest_dihedral = good == 0 ? angle : std::min(facts.smallest_dihedral, angle);
    ++good;
  }
}

}  // namespace

double volume(const TetMesh& mesh, int cell) {
  const auto& [a, b, c, d] = mesh.cells[cell];
  return volume6(mesh.points[a], mesh.points[b], mesh.points[c], mesh.points[d]) / 6.0;
}

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) sum += volume(mesh, int(c));
  return sum;
}

TetFacts inspect(const TetMesh& mesh, double tolerance) {
  TetFacts facts;
  facts.nodes = int(mesh.points.size());
  facts.cells = int(mesh.cells.size());
  const std::vector<bool> used = used_nodes(mesh);
  facts.unused_nodes = int(std::count(used.begin(), used.end(), false));
  facts.box = bounds_of(mesh.points, used);
  measure_cells(mesh, facts);
  facts.duplicate_cells = duplicate_cells(mesh);
  const std::vector<int> same = same_nodes(mesh.points, used, tolerance * diagonal(facts.box));
  for (int i = 0; i < facts.nodes; ++i) facts.duplicate_nodes += same[i] != i;
  count_faces(mesh, facts);
  return facts;
}

TetSurface surface_of(const TetMesh& mesh) {
  std::vector<TetFace> outer;
  const std::vector<TetFace> faces = sorted_faces(mesh);
  for_each_face(faces, [&](std::span<const TetFace> same) {
    if (same.size() == 1) outer.push_back(same[0]);
  });
  std::sort(outer.begin(), outer.end(), [](const TetFace& a, const TetFace& b) {
    return a.cell != b.cell ? a.cell < b.cell : a.opposite < b.opposite;
  });
  std::vector<int> vertex(mesh.points.size(), -1);
  for (const TetFace& face : outer)
    for (const int node : face.nodes) vertex[node] = 0;
  TetSurface surface;
  for (int node = 0; node < int(vertex.size()); ++node) {
    if (vertex[node] < 0) continue;
    vertex[node] = int(surface.node.size());
    surface.node.push_back(node);
    surface.mesh.positions.push_back(mesh.points[node]);
  }
  for (const TetFace& face : outer) {
    const auto t = face_of(mesh.cells[face.cell], face.opposite, volume(mesh, face.cell) >= 0);
    surface.mesh.triangles.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
  }
  return surface;
}

}  // namespace trocar::geometry
