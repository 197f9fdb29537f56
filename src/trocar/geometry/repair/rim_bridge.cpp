#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/geometry/repair/rim_bridge.hpp>

namespace trocar::geometry {
namespace {

constexpr double kOnePlane = 0.8;               ///< cosine between the planes of two rims
constexpr double kPlaneOff = 0.6;               ///< of one from the other's plane, in radii of the outer one
constexpr double kWithin = 0.8;                 ///< share of the inner one's corners that lie within the outer one
constexpr std::size_t kMostRims = 2000;         ///< that are looked at for pairs
constexpr std::size_t kMostBridge = 4'000'000;  ///< corners of one times corners of the other

/// A rim as a flat shape.
struct FlatRim {
  Vec3d middle{}, normal{};
  double area = 0, radius = 0;
};

FlatRim flat(const TriMesh& mesh, const Rim& rim) {
  FlatRim out;
  for (const int v : rim.vertices) out.middle += mesh.positions[v];
  out.middle = out.middle / double(rim.vertices.size());
  Vec3d twice{};
  for (std::size_t i = 0; i < rim.vertices.size(); ++i) {
    const Vec3d p = mesh.positions[rim.vertices[i]] - out.middle;
    twice += cross(p, mesh.positions[rim.vertices[(i + 1) % rim.vertices.size()]] - out.middle);
    out.radius += length(p) / double(rim.vertices.size());
  }
  out.area = 0.5 * length(twice);
  out.normal = normalised(twice, Vec3d{});
  return out;
}

/// How often the outline goes around a point of its plane, by the crossings of a ray.
bool is_inside(const TriMesh& mesh, const Rim& outline, const FlatRim& plane, Vec3d p) {
  const Vec3d u = any_perpendicular(plane.normal), v = cross(plane.normal, u);
  const double x = dot(p - plane.middle, u), y = dot(p - plane.middle, v);
  bool inside = false;
  for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
    const Vec3d a = mesh.positions[outline.vertices[i]] - plane.middle,
                b = mesh.positions[outline.vertices[(i + 1) % outline.vertices.size()]] - plane.middle;
    const double ay = dot(a, v) - y, by = dot(b, v) - y;
    if ((ay > 0) == (by > 0)) continue;
    const double ax = dot(a, u) - x, bx = dot(b, u) - x;
    if (ax + (bx - ax) * ay / (ay - by) > 0) inside = !inside;
  }
  return inside;
}

bool is_within(const TriMesh& mesh, const Rim& outer, const FlatRim& around, const Rim& inner,
               const FlatRim& flat_inner) {
  if (!(flat_inner.area < around.area) || dot(flat_inner.normal, around.normal) > -kOnePlane) return false;
  if (std::fabs(dot(flat_inner.middle - around.middle, around.normal)) > kPlaneOff * around.radius) return false;
  if (length(flat_inner.middle - around.middle) > around.radius) return false;
  std::size_t within = 0;
  for (const int v : inner.vertices) within += is_inside(mesh, outer, around, mesh.positions[v]);
  return double(within) >= kWithin * double(inner.vertices.size());
}

}  // namespace

std::vector<std::array<int, 2>> concentric_rims(const TriMesh& mesh, const std::vector<Rim>& rims) {
  std::vector<std::array<int, 2>> pairs;
  if (rims.size() > kMostRims) return pairs;
  std::vector<FlatRim> shapes;
  for (const Rim& rim : rims) shapes.push_back(flat(mesh, rim));
  std::vector<std::pair<double, std::array<int, 2>>> fitting;  // by the ring's area: walls are thin
  for (int o = 0; o < int(rims.size()); ++o)
    for (int i = 0; i < int(rims.size()); ++i)
      if (o != i && rims[o].is_loop && rims[i].is_loop && is_within(mesh, rims[o], shapes[o], rims[i], shapes[i]))
        fitting.push_back({shapes[o].area - shapes[i].area, {o, i}});
  std::sort(fitting.begin(), fitting.end());
  std::vector<bool> taken(rims.size());
  for (const auto& [ring, pair] : fitting) {
    if (taken[pair[0]] || taken[pair[1]]) continue;
    taken[pair[0]] = taken[pair[1]] = true;
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<std::array<int, 3>> rim_bridge(const TriMesh& mesh, const Rim& outer, const Rim& inner) {
  const int n = int(outer.vertices.size()), m = int(inner.vertices.size());
  if (std::size_t(n) * std::size_t(m) > kMostBridge) return {};
  // The outer one backwards, as the ring runs along it; the inner one as it is, which is the same way around.
  int start = 0, nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j)
      if (const double d = length(mesh.positions[outer.vertices[i]] - mesh.positions[inner.vertices[j]]); d < least)
        least = d, start = i, nearest = j;
  const auto a = [&](int i) { return outer.vertices[((start - i) % n + n) % n]; };
  const auto b = [&](int j) { return inner.vertices[(nearest + j) % m]; };
  const auto area = [&](int p, int q, int r) {
    return length(cross(mesh.positions[q] - mesh.positions[p], mesh.positions[r] - mesh.positions[p]));
  };
  // cost(i, j): the least area of a ring that has come to a(i) and b(j).
  std::vector<double> cost(std::size_t(n + 1) * std::size_t(m + 1), std::numeric_limits<double>::infinity());
  std::vector<bool> by_outer(cost.size());
  const auto at = [&](int i, int j) { return std::size_t(i) * std::size_t(m + 1) + std::size_t(j); };
  cost[0] = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      if (i > 0 && cost[at(i - 1, j)] + area(a(i - 1), a(i), b(j)) < cost[at(i, j)]) {
        cost[at(i, j)] = cost[at(i - 1, j)] + area(a(i - 1), a(i), b(j));
        by_outer[at(i, j)] = true;
      }
      if (j > 0 && cost[at(i, j - 1)] + area(b(j), b(j - 1), a(i)) < cost[at(i, j)]) {
        cost[at(i, j)] = cost[at(i, j - 1)] + area(b(j), b(j - 1), a(i));
        by_outer[at(i, j)] = false;
      }
    }
  std::vector<std::array<int, 3>> ring;
  for (int i = n, j = m; i > 0 || j > 0;) {
    if (by_outer[at(i, j)]) {
      ring.push_back({a(i - 1), a(i), b(j)});
      --i;
    } else {
      ring.push_back({b(j), b(j - 1), a(i)});
      --j;
    }
  }
  std::reverse(ring.begin(), ring.end());
  return ring;
}

}  // namespace trocar::geometry
