#include <algorithm>
#include <limits>
#include <numeric>

#include <trocar/geometry/repair/rim_patch.hpp>

namespace trocar::geometry {
namespace {

/// What triangles cost: how far neighbours turn away from each other at worst (1 - cosine), then area.
struct PatchCost {
  double turn = 0, area = 0;
  friend bool operator<(const PatchCost& a, const PatchCost& b) {
    return a.turn != b.turn ? a.turn < b.turn : a.area < b.area;
  }
};
constexpr PatchCost kNoPatch{std::numeric_limits<double>::infinity(), 0};

double turn_between(Vec3d a, Vec3d b) { return a == Vec3d{} || b == Vec3d{} ? 0 : 1 - dot(a, b); }

/// The best patch of every run of corners i .. k, from short runs to the whole loop.
class PatchTable {
 public:
  PatchTable(const PatchLoop& loop, std::vector<int> corners)
      : m_loop(loop),
        m_corners(std::move(corners)),
        m_count(int(m_corners.size())),
        m_runs(std::size_t(m_count) * m_count) {}

  bool fill() {
    for (int i = 0; i + 1 < m_count; ++i) at(i, i + 1).normal = outside(i);
    for (int span = 2; span < m_count; ++span)
      for (int i = 0; i + span < m_count; ++i) best(i, i + span);
    return at(0, m_count - 1).cost.turn < kNoPatch.turn;
  }

  void take(int i, int k, std::vector<std::array<int, 3>>& triangles) const {
    if (k - i < 2) return;
    const int middle = at(i, k).middle;
    triangles.push_back({m_corners[i], m_corners[middle], m_corners[k]});
    take(i, middle, triangles);
    take(middle, k, triangles);
  }
  int count() const { return m_count; }

 private:
  struct Run {
    PatchCost cost{};
    int middle = -1;
    Vec3d normal{};  ///< of the triangle at the edge i k, or of what is outside of it
  };
  const PatchLoop& m_loop;
  std::vector<int> m_corners;
  int m_count;
  std::vector<Run> m_runs;

  Run& at(int i, int k) { return m_runs[std::size_t(i) * m_count + k]; }
  const Run& at(int i, int k) const { return m_runs[std::size_t(i) * m_count + k]; }
  Vec3d place(int i) const { return m_loop.places[m_corners[i]]; }
  /// Across an edge of the loop; 0 where corners were cut off there.
  Vec3d outside(int i) const {
    const int a = m_corners[i], b = m_corners[(i + 1) % m_count], n = int(m_loop.places.size());
    return (a + 1) % n == b ? m_loop.normals[a] : Vec3d{};
  }

  void best(int i, int k) {
    Run& run = at(i, k);
    run.cost = kNoPatch;
    const bool whole = i == 0 && k == m_count - 1;
    if (!whole && m_loop.taken && m_loop.taken(m_corners[i], m_corners[k])) return;
    for (int m = i + 1; m < k; ++m) {
      const Run &low = at(i, m), &high = at(m, k);
      if (!(low.cost.turn < kNoPatch.turn && high.cost.turn < kNoPatch.turn)) continue;
      if (std::max(low.cost.turn, high.cost.turn) > run.cost.turn) continue;
      const Vec3d twice = cross(place(m) - place(i), place(k) - place(i)), normal = normalised(twice, Vec3d{});
      PatchCost cost{std::max({low.cost.turn, high.cost.turn, turn_between(normal, low.normal),
                               turn_between(normal, high.normal)}),
                     low.cost.area + high.cost.area + 0.5 * length(twice)};
      if (normal == Vec3d{}) cost.turn = std::max(cost.turn, 1.9);  // no area: rather anything else
      if (whole) cost.turn = std::max(cost.turn, turn_between(normal, outside(k)));
      if (cost < run.cost) run = {cost, m, normal};
    }
  }
};

/// Cuts off corners until so many are left: the one with the shortest new edge first, if it turns as the loop does.
std::vector<int> shortened(const PatchLoop& loop, std::vector<std::array<int, 3>>& triangles) {
  std::vector<int> left(loop.places.size());
  std::iota(left.begin(), left.end(), 0);
  Vec3d axis{};
  for (std::size_t i = 0; i < left.size(); ++i)
    axis += cross(loop.places[i] - loop.places[0], loop.places[(i + 1) % left.size()] - loop.places[0]);
  std::vector<double> cost(left.size());
  const auto look = [&](std::size_t i) {
    const std::size_t n = left.size();
    const int a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
    const Vec3d way = loop.places[c] - loop.places[a];
    const bool bent = dot(cross(loop.places[b] - loop.places[a], way), axis) <= 0;
    const bool taken = loop.taken && loop.taken(a, c);
    cost[i] = dot(way, way) + (bent ? 1e20 : 0) + (taken ? 1e40 : 0);
  };
  for (std::size_t i = 0; i < left.size(); ++i) look(i);
  while (int(left.size()) > kMostPatchCorners) {
    const std::size_t i = std::size_t(std::min_element(cost.begin(), cost.end()) - cost.begin()), n = left.size();
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(i));
    cost.erase(cost.begin() + std::ptrdiff_t(i));
    look(i % left.size());
    look((i + left.size() - 1) % left.size());
  }
  return left;
}

}  // namespace

std::vector<std::array<int, 3>> rim_patch(const PatchLoop& loop) {
  std::vector<std::array<int, 3>> triangles;
  if (loop.places.size() < 3) return triangles;
  PatchTable table(loop, shortened(loop, triangles));
  if (!table.fill()) return {};
  table.take(0, table.count() - 1, triangles);
  return triangles;
}

}  // namespace trocar::geometry
