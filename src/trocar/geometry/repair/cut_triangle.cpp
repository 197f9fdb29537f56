#include <algorithm>
#include <cmath>
#include <deque>

#include <trocar/geometry/repair/cut_triangle.hpp>
#include <trocar/geometry/surfaces/orientation.hpp>

namespace trocar::geometry {
namespace {

std::array<int, 2> lower_first(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The sine of the smallest angle, squared, by the sides' lengths; 0 for a line.
double wideness(Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, bc = c - b, ca = a - c;
  const double x = dot(ab, ab), y = dot(bc, bc), z = dot(ca, ca), least = std::min({x, y, z});
  const Vec3d twice = cross(ab, bc);
  return x * y * z > 0 ? dot(twice, twice) * least / (x * y * z) : 0;
}

}  // namespace

CutTriangle::CutTriangle(std::span<const Vec3d> places, const std::array<int, 3>& corners)
    : m_places(places), m_corners(corners) {
  const Vec3d p = places[corners[0]], n = cross(places[corners[1]] - p, places[corners[2]] - p);
  const Vec3d size{std::fabs(n.x), std::fabs(n.y), std::fabs(n.z)};
  const int thin = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  m_first = (thin + 1) % 3, m_second = (thin + 2) % 3;
  if (side(corners[0], corners[1], corners[2]) < 0) std::swap(m_first, m_second);
  m_good = side(corners[0], corners[1], corners[2]) > 0;
  put(corners);
}

int CutTriangle::side(int a, int b, int c) const {
  return side_of_line(m_places[a], m_places[b], m_places[c], m_first, m_second);
}

void CutTriangle::put(const std::array<int, 3>& corners) {
  for (std::size_t k = 0; k < 3; ++k) m_at[{corners[k], corners[(k + 1) % 3]}] = int(m_triangles.size());
  m_triangles.push_back(corners);
  m_good = m_good && side(corners[0], corners[1], corners[2]) > 0;
}

void CutTriangle::take(int triangle) {
  auto& corners = m_triangles[triangle];
  for (std::size_t k = 0; k < 3; ++k) m_at.erase({corners[k], corners[(k + 1) % 3]});
  corners = {-1, -1, -1};
}

int CutTriangle::opposite(int a, int b) const {
  const auto found = m_at.find({a, b});
  if (found == m_at.end()) return -1;
  for (const int v : m_triangles[found->second])
    if (v != a && v != b) return v;
  return -1;
}

bool CutTriangle::is_constrained(int a, int b) const { return m_constrained.count(lower_first(a, b)) > 0; }

void CutTriangle::add_on_side(int which, const std::vector<int>& points) {
  int a = m_corners[std::size_t(which)];
  const int b = m_corners[std::size_t(which + 1) % 3];
  for (const int p : points) {
    m_good = m_good && split_edge(a, b, p);
    a = p;
  }
}

bool CutTriangle::split_edge(int a, int b, int point) {
  const int left = opposite(a, b), right = opposite(b, a);
  if (left < 0 && right < 0) return false;
  if (left >= 0) {
    take(m_at[{a, b}]);
    put({a, point, left});
    put({point, b, left});
  }
  if (right >= 0) {
    take(m_at[{b, a}]);
    put({b, point, right});
    put({point, a, right});
  }
  return m_good;
}

void CutTriangle::add_within(int point) {
  if (!m_good) return;
  for (int t = 0; t < int(m_triangles.size()); ++t) {
    const auto corners = m_triangles[t];
    if (corners[0] < 0) continue;
    std::array<int, 3> sides{};
    for (std::size_t k = 0; k < 3; ++k) sides[k] = side(corners[k], corners[(k + 1) % 3], point);
    if (*std::min_element(sides.begin(), sides.end()) < 0) continue;
    const auto on = std::find(sides.begin(), sides.end(), 0);
    if (on != sides.end()) {
      const std::size_t k = std::size_t(on - sides.begin());
      m_good = split_edge(corners[k], corners[(k + 1) % 3], point);
      return;
    }
    take(t);
    for (std::size_t k = 0; k < 3; ++k) put({corners[k], corners[(k + 1) % 3], point});
    return;
  }
  m_good = false;
}

bool CutTriangle::flip(int a, int b) {
  const int c = opposite(a, b), d = opposite(b, a);
  if (c < 0 || d < 0 || side(c, a, d) <= 0 || side(d, b, c) <= 0) return false;
  take(m_at[{a, b}]);
  take(m_at[{b, a}]);
  put({c, a, d});
  put({d, b, c});
  return true;
}

/// The edges that the segment crosses, from one end to the other; false where it goes through a point.
bool CutTriangle::crossed_edges(int from, int to, std::vector<std::array<int, 2>>& out) {
  int a = -1, b = -1;
  for (const auto& corners : m_triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      if (corners[k] != from) continue;
      const int p = corners[(k + 1) % 3], q = corners[(k + 2) % 3];
      const int at_p = side(from, to, p), at_q = side(from, to, q);
      if (at_p <= 0 && at_q >= 0 && (at_p == 0 || at_q == 0) && side(p, q, to) < 0) return false;
      if (at_p < 0 && at_q > 0) a = p, b = q;
    }
  if (a < 0) return false;
  for (;;) {  // a to the right of the way, b to the left
    out.push_back({a, b});
    const int next = opposite(b, a);
    if (next < 0) return false;
    if (next == to) return true;
    const int at = side(from, to, next);
    if (at == 0) return false;
    (at < 0 ? a : b) = next;
  }
}

void CutTriangle::constrain(int from, int to) {
  if (!m_good) return;
  m_constrained[lower_first(from, to)] = true;
  if (m_at.count({from, to}) > 0 || m_at.count({to, from}) > 0) return;
  std::vector<std::array<int, 2>> crossed;
  m_good = crossed_edges(from, to, crossed) &&
           std::none_of(crossed.begin(), crossed.end(), [&](const auto& e) { return is_constrained(e[0], e[1]); });
  std::deque<std::array<int, 2>> waiting(crossed.begin(), crossed.end());
  for (std::size_t steps = 0; m_good && !waiting.empty(); ++steps) {  // [Sloan 1993]
    const auto [a, b] = waiting.front();
    waiting.pop_front();
    const int c = opposite(a, b), d = opposite(b, a);
    if (!flip(a, b))
      waiting.push_back({a, b});
    else if (c != from && c != to && d != from && d != to && side(from, to, c) * side(from, to, d) < 0)
      waiting.push_back({c, d});
    m_good = m_good && steps < 100 * (crossed.size() + 1);
  }
  m_good = m_good && (m_at.count({from, to}) > 0 || m_at.count({to, from}) > 0);
}

void CutTriangle::widen() {
  bool any = m_good;
  for (int round = 0; any && round < 10; ++round) {
    any = false;
    std::vector<std::array<int, 2>> all;
    for (const auto& [edge, triangle] : m_at)
      if (edge[0] < edge[1]) all.push_back(edge);
    for (const auto& [a, b] : all) {
      const int c = opposite(a, b), d = opposite(b, a);
      if (c < 0 || d < 0 || is_constrained(a, b)) continue;
      const auto at = [&](int v) { return m_places[v]; };
      const double now = std::min(wideness(at(a), at(b), at(c)), wideness(at(b), at(a), at(d)));
      const double then = std::min(wideness(at(c), at(a), at(d)), wideness(at(d), at(b), at(c)));
      if (then > 1.0001 * now && flip(a, b)) any = true;
    }
  }
}

std::vector<std::array<int, 3>> CutTriangle::triangles() const {
  std::vector<std::array<int, 3>> out;
  for (const auto& corners : m_triangles)
    if (corners[0] >= 0) out.push_back(corners);
  return out;
}

}  // namespace trocar::geometry
