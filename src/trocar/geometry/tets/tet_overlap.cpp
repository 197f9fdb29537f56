#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/geometry/surfaces/point_grid.hpp>
#include <trocar/geometry/tets/tet_overlap.hpp>

namespace trocar::geometry {
namespace {

using Corners = std::array<Vec3d, 4>;
constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// Of pairs whose balls meet: hostile files have cells that all meet all others.
constexpr std::int64_t kMostLooks = 100'000'000;

Corners corners_of(const TetMesh& mesh, int cell) {
  Corners out;
  for (int k = 0; k < 4; ++k) out[k] = mesh.points[mesh.cells[cell][k]];
  return out;
}

struct Shadow {
  double low, high;
};
Shadow shadow(const Corners& c, Vec3d axis) {
  const double a = dot(c[0], axis), b = dot(c[1], axis), d = dot(c[2], axis), e = dot(c[3], axis);
  return {std::min({a, b, d, e}), std::max({a, b, d, e})};
}

/// Do their shadows on this axis meet by less than counts?
bool part_along(const Corners& a, const Corners& b, Vec3d axis) {
  const Shadow s = shadow(a, axis), t = shadow(b, axis);
  const double thinner = std::min(s.high - s.low, t.high - t.low);
  return thinner > 0 && std::min(s.high, t.high) - std::max(s.low, t.low) <= kOverlapDepth * thinner;
}

bool part_along_a_face(const Corners& of, const Corners& other) {
  for (int k = 0; k < 4; ++k) {
    const Vec3d p = of[k], q = of[(k + 1) % 4], r = of[(k + 2) % 4];
    if (part_along(of, other, cross(q - p, r - p))) return true;
  }
  return false;
}

/// Separating axes: two convex bodies are apart along a face's normal of one of them or across an edge of each.
bool lie_in_each_other(const Corners& a, const Corners& b) {
  if (part_along_a_face(a, b) || part_along_a_face(b, a)) return false;
  for (const auto& i : kEdges)
    for (const auto& j : kEdges) {
      const Vec3d u = a[i[1]] - a[i[0]], v = b[j[1]] - b[j[0]], axis = cross(u, v);
      if (dot(axis, axis) <= 1e-20 * dot(u, u) * dot(v, v)) continue;  // parallel
      if (part_along(a, b, axis)) return false;
    }
  return true;
}

int shared_nodes(const std::array<int, 4>& a, const std::array<int, 4>& b) {
  int shared = 0;
  for (const int node : a) shared += int(std::count(b.begin(), b.end(), node));
  return shared;
}

}  // namespace

CellOverlaps cell_overlaps(const TetMesh& mesh) {
  const int cells = int(mesh.cells.size());
  CellOverlaps found;
  if (cells < 2) return found;
  const Vec3d from = mesh.points[mesh.cells[0][0]];  // single precision is for what is near
  std::vector<Vec3f> middle(cells);
  std::vector<float> radius(cells);
  double sum = 0, largest = 0;
  for (int c = 0; c < cells; ++c) {
    const Corners p = corners_of(mesh, c);
    const Vec3d m = 0.25 * (p[0] + p[1] + p[2] + p[3]);
    double reach = 0;
    for (const Vec3d corner : p) reach = std::max(reach, length(corner - m));
    middle[c] = vec_cast<float>(m - from);
    radius[c] = float(1.0001 * reach);
    sum += reach;
    largest = std::max(largest, reach);
  }
  const PointGrid grid(middle, float(2 * sum / cells));
  std::int64_t looks = 0;
  for (int c = 0; c < cells && found.pairs < kMostOverlaps && looks < kMostLooks; ++c)
    grid.visit(middle[c], radius[c] + float(largest), [&](std::uint32_t other) {
      const int d = int(other);
      if (d <= c || found.pairs >= kMostOverlaps) return;
      ++looks;
      const float reach = radius[c] + radius[d];
      if (dot(middle[c] - middle[d], middle[c] - middle[d]) >= reach * reach) return;
      if (shared_nodes(mesh.cells[c], mesh.cells[d]) > 2) return;  // a face: its sides tell
      if (!lie_in_each_other(corners_of(mesh, c), corners_of(mesh, d))) return;
      if (found.pairs++ == 0) found.at = from + 0.5 * vec_cast<double>(middle[c] + middle[d]);
    });
  return found;
}

std::string in_words(const CellOverlaps& overlaps) {
  const Vec3d mm = 1e3 * overlaps.at;
  return tr("{}{} pair{} of cells that share no face lie{} in each other, the first at {:.1f}, {:.1f}, {:.1f} mm",
            overlaps.pairs, overlaps.pairs >= kMostOverlaps ? " or more" : "", overlaps.pairs == 1 ? "" : "s",
            overlaps.pairs == 1 ? "s" : "", mm.x, mm.y, mm.z);
}

}  // namespace trocar::geometry
