#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <trocar/geometry/tets/tet_faces.hpp>

namespace trocar::geometry {
namespace {

bool corners_differ(const std::array<int, 4>& c) {
  return c[0] != c[1] && c[0] != c[2] && c[0] != c[3] && c[1] != c[2] && c[1] != c[3] && c[2] != c[3];
}

/// Sorts three numbers; true where that took an even number of exchanges.
bool sort_three(std::array<int, 3>& n) {
  bool even = true;
  const auto order = [&](int i, int j) {
    if (n[i] <= n[j]) return;
    std::swap(n[i], n[j]);
    even = !even;
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  return even;
}

using CubePlace = std::array<std::int64_t, 3>;

/// Kept nodes by the cube of a grid in which they lie. Kept nodes are more than a cube's side apart, so a cube holds a
/// handful at most, and looking up is cheap whatever the points are.
class Cubes {
 public:
  Cubes(const std::vector<Vec3d>& points, const std::vector<bool>& used, double side) : m_points(points) {
    constexpr double finest = 1e-12;  // of the box: places fit their integers
    const Bounds box = bounds_of(points, used);
    m_low = box.low;
    m_side = std::max(side, finest * diagonal(box));
    if (!(m_side > 0)) m_side = 1;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (used[i]) m_places.push_back(place(points[i]));
    std::sort(m_places.begin(), m_places.end());
    m_places.erase(std::unique(m_places.begin(), m_places.end()), m_places.end());
    m_first.assign(m_places.size(), -1);
    m_next.assign(points.size(), -1);
  }

  void keep(int node) {
    const std::size_t cube =
        std::lower_bound(m_places.begin(), m_places.end(), place(m_points[node])) - m_places.begin();
    m_next[node] = m_first[cube];
    m_first[cube] = node;
  }

  /// The lowest-numbered kept node within `distance` (at most the side), or -1.
  int find(Vec3d p, double distance) const {
    int found = -1;
    const CubePlace middle = place(p);
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy) {
        const CubePlace from{middle[0] + dx, middle[1] + dy, middle[2] - 1}, to{from[0], from[1], middle[2] + 1};
        for (auto at = std::lower_bound(m_places.begin(), m_places.end(), from); at != m_places.end() && *at <= to;
             ++at)
          for (int node = m_first[at - m_places.begin()]; node >= 0; node = m_next[node])
            if (length(m_points[node] - p) <= distance && (found < 0 || node < found)) found = node;
      }
    return found;
  }

 private:
  CubePlace place(Vec3d p) const {
    const Vec3d at = (p - m_low) / m_side;
    return {std::int64_t(at.x), std::int64_t(at.y), std::int64_t(at.z)};
  }

  const std::vector<Vec3d>& m_points;
  double m_side;
  Vec3d m_low{};
  std::vector<CubePlace> m_places;  ///< of cubes with nodes, sorted
  std::vector<int> m_first;         ///< kept node of each cube ...
  std::vector<int> m_next;          ///< ... and the next one in the same cube
};

}  // namespace

std::array<int, 3> face_of(const std::array<int, 4>& cell, int k, bool upright) {
  static constexpr int kFaces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  const int* f = kFaces[k];
  if (upright) return {cell[f[0]], cell[f[1]], cell[f[2]]};
  return {cell[f[0]], cell[f[2]], cell[f[1]]};
}

std::vector<TetFace> sorted_faces(const TetMesh& mesh) {
  std::vector<TetFace> faces;
  faces.reserve(4 * mesh.cells.size());
  for (int c = 0; c < int(mesh.cells.size()); ++c) {
    if (!corners_differ(mesh.cells[c])) continue;
    const bool upright = volume(mesh, c) >= 0;
    for (int k = 0; k < 4; ++k) {
      TetFace face{face_of(mesh.cells[c], k, upright), c, static_cast<signed char>(k), true};
      face.outwards = sort_three(face.nodes);
      faces.push_back(face);
    }
  }
  std::sort(faces.begin(), faces.end(), [](const TetFace& a, const TetFace& b) {
    return a.nodes != b.nodes ? a.nodes < b.nodes : a.cell < b.cell;
  });
  return faces;
}

std::vector<int> same_nodes(const std::vector<Vec3d>& points, const std::vector<bool>& used, double distance) {
  std::vector<int> same(points.size());
  Cubes kept(points, used, distance);
  for (int i = 0; i < int(points.size()); ++i) {
    const int earlier = used[i] ? kept.find(points[i], distance) : -1;
    same[i] = earlier < 0 ? i : earlier;
    if (used[i] && earlier < 0) kept.keep(i);
  }
  return same;
}

std::vector<bool> used_nodes(const TetMesh& mesh) {
  std::vector<bool> used(mesh.points.size());
  for (const auto& cell : mesh.cells)
    for (const int node : cell) used[node] = true;
  return used;
}

Bounds bounds_of(const std::vector<Vec3d>& points, const std::vector<bool>& used) {
  std::vector<Vec3d> some;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (used[i]) some.push_back(points[i]);
  return bounds(some);
}

double diagonal(const Bounds& box) { return box.low.x > box.high.x ? 0.0 : length(box.high - box.low); }

bool is_flat(const TetMesh& mesh, int cell, double box_diagonal) {
  const auto& c = mesh.cells[cell];
  if (!corners_differ(c)) return true;
  double longest = 0;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < i; ++j) longest = std::max(longest, length(mesh.points[c[i]] - mesh.points[c[j]]));
  const double v = std::fabs(volume(mesh, cell));
  return v <= kFlatOfBox * box_diagonal * box_diagonal * box_diagonal || v <= kFlatOfEdge * longest * longest * longest;
}

}  // namespace trocar::geometry
