#include <algorithm>
#include <cmath>
#include <numeric>

#include <trocar/geometry/surface_files/polygons.hpp>

namespace trocar::geometry {
namespace {

constexpr std::size_t kMostEars = 1024;              ///< corners of a polygon that is cut ear by ear
constexpr std::int64_t kMostEarSteps = 200'000'000;  ///< corners looked at, in all polygons of a file: a second

constexpr std::size_t kMostFan = 32;  ///< corners of a convex polygon that is cut as a fan
constexpr double kStraight = 1e-9;    ///< of a polygon's size: a corner that turns back so little is rounded

struct PlanePoint {
  double x, y;
};

bool same(PlanePoint a, PlanePoint b) { return a.x == b.x && a.y == b.y; }
double turn(PlanePoint a, PlanePoint b, PlanePoint c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

/// Twice the area times the normal of the plane that fits best. [Newell; Sutherland, Sproull & Schumacker 1974]
Vec3d newell_normal(std::span<const Vec3d> positions, std::span<const int> corners) {
  Vec3d sum{};
  const Vec3d origin = positions[corners[0]];  // near the polygon: less cancellation
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += cross(positions[corners[i]] - origin, positions[corners[(i + 1) % corners.size()]] - origin);
  return sum;
}

/// The corners along the axis in which the polygon is thinnest, so that it runs counter-clockwise.
std::vector<PlanePoint> flattened(std::span<const Vec3d> positions, std::span<const int> corners) {
  const Vec3d n = newell_normal(positions, corners), size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<PlanePoint> flat;
  for (const int c : corners) {
    const Vec3d p = positions[c];
    flat.push_back(n[axis] >= 0 ? PlanePoint{p[u], p[v]} : PlanePoint{p[v], p[u]});
  }
  return flat;
}

/// Twice the smallest area of a corner and its neighbours.
double least_turn(const std::vector<PlanePoint>& p) {
  const std::size_t n = p.size();
  double least = turn(p[n - 1], p[0], p[1]);
  for (std::size_t i = 0; i + 1 < n; ++i) least = std::min(least, turn(p[i], p[i + 1], p[(i + 2) % n]));
  return least;
}

/// Do its corners turn back by no more than files round places? Then halves of it are as good as convex.
bool is_rounded(const std::vector<PlanePoint>& p, double least) {
  double size2 = 0;
  for (const PlanePoint& q : p) {
    const double x = q.x - p[0].x, y = q.y - p[0].y;
    size2 = std::max(size2, x * x + y * y);
  }
  return least > -kStraight * size2;
}

/// In halves, again and again: a fan of many corners is all needles, whose boxes cover each other.
void cut_in_halves(std::span<const int> corners, std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::array<std::size_t, 2>> waiting{{0, corners.size() - 1}};
  while (!waiting.empty()) {
    const auto [first, last] = waiting.back();
    waiting.pop_back();
    if (last - first < 2) continue;
    const std::size_t middle = first + (last - first) / 2;
    triangles.push_back({corners[first], corners[middle], corners[last]});
    waiting.push_back({middle, last});
    waiting.push_back({first, middle});
  }
}

class EarCutter {
 public:
  EarCutter(std::vector<PlanePoint> points, std::int64_t& steps) : m_points(std::move(points)), m_steps(steps) {
    m_left.resize(m_points.size());
    std::iota(m_left.begin(), m_left.end(), 0);
  }

  /// Calls each(a, b, c) for every triangle.
  template <class Each>
  void cut(Each&& each) {
    while (m_left.size() > 3) {
      const std::size_t k = next_ear(), n = m_left.size();
      each(m_left[(k + n - 1) % n], m_left[k], m_left[(k + 1) % n]);
      m_left.erase(m_left.begin() + std::ptrdiff_t(k));
    }
    each(m_left[0], m_left[1], m_left[2]);
  }

 private:
  std::vector<PlanePoint> m_points;
  std::vector<int> m_left;
  std::int64_t& m_steps;

  double turn_at(std::size_t k) const {
    const std::size_t n = m_left.size();
    return turn(m_points[m_left[(k + n - 1) % n]], m_points[m_left[k]], m_points[m_left[(k + 1) % n]]);
  }

  /// Of those that are ears the first; of a polygon that crosses itself, and has none, the corner that turns most.
  std::size_t next_ear() {
    std::size_t best = 0;
    double most = turn_at(0);
    for (std::size_t k = 0; k < m_left.size(); ++k) {
      const double now = turn_at(k);
      if (now > 0 && is_ear(k)) return k;
      if (now > most) most = now, best = k;
    }
    return best;
  }

  bool is_ear(std::size_t k) {
    const std::size_t n = m_left.size();
    m_steps += std::int64_t(n);
    const PlanePoint a = m_points[m_left[(k + n - 1) % n]], b = m_points[m_left[k]], c = m_points[m_left[(k + 1) % n]];
    for (std::size_t i = 2; i + 1 < n; ++i) {
      const PlanePoint p = m_points[m_left[(k + i) % n]];
      if (same(p, a) || same(p, b) || same(p, c)) continue;  // a cut to a hole runs there and back
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
    }
    return true;
  }
};

}  // namespace

void PolygonCutter::cut(std::span<const Vec3d> positions, std::span<const int> corners,
                        std::vector<std::array<int, 3>>& triangles) {
  if (corners.size() == 3) triangles.push_back({corners[0], corners[1], corners[2]});
  if (corners.size() <= 3) return;
  std::vector<PlanePoint> flat = flattened(positions, corners);
  const double least = least_turn(flat);
  const bool convex = least >= 0, many = corners.size() > kMostFan;
  if (many && (least > 0 || (corners.size() > kMostEars && is_rounded(flat, least))))
    return cut_in_halves(corners, triangles);
  if (convex || corners.size() > kMostEars || m_steps > kMostEarSteps) {
    m_fans += !convex;
    for (std::size_t k = 2; k < corners.size(); ++k) triangles.push_back({corners[0], corners[k - 1], corners[k]});
    return;
  }
  EarCutter(std::move(flat), m_steps).cut([&](int a, int b, int c) {
    triangles.push_back({corners[a], corners[b], corners[c]});
  });
}

}  // namespace trocar::geometry
