// The nearest triangle is found in a tree of boxes (triangle_tree.hpp). Inside or outside is asked along the third
// axis, as lattice.cpp does: every triangle above the point adds or takes one turn of the surface. Which of two
// neighbours the ray meets on their common edge is decided in whole numbers, of positions rounded to a fine grid, so
// that a closed mesh never leaks.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numeric>
#include <span>
#include <stdexcept>
#include <vector>

#include <trocar/geometry/surfaces/triangle_tree.hpp>
#include <trocar/geometry/volumes/field.hpp>

namespace trocar::geometry {
namespace {

std::array<Vec3d, 3> corners(const TriMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

/// Where a point is seen along the third axis, in steps of the fine grid.
struct GridPlace {
  std::int64_t x, y;
};
constexpr int kGridBits = 30;  // products of two differences and what lies between two of these fit in 64 bits

/// Twice the signed area of (p, a, b) is above 0; on the line, as if p lay a little further along y, then back along x.
bool to_the_left(GridPlace p, GridPlace a, GridPlace b) {
  const std::int64_t area = (a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x);
  if (area != 0) return area > 0;
  return a.x < b.x || (a.x == b.x && a.y < b.y);
}
double area_of(GridPlace p, GridPlace a, GridPlace b) {
  return double((a.x - p.x) * (b.y - p.y) - (a.y - p.y) * (b.x - p.x));
}

/// How often the surface goes around a point.
class Turns {
 public:
  explicit Turns(const TriMesh& mesh) : m_mesh(mesh), m_box(bounds(mesh.positions)) {
    const Vec3d side = m_box.high - m_box.low;
    m_step = std::max({side.x, side.y, side.z}) / double(std::int64_t(1) << kGridBits);
    for (const Vec3d& p : mesh.positions) m_places.push_back(place(p));
    int bits = 0;  // about as many columns as triangles
    while (bits < 10 && (std::size_t(1) << (2 * bits)) < mesh.triangles.size()) ++bits;
    set_columns(bits);
    while (bits > 0 && listed() > kMostColumns * double(mesh.triangles.size())) set_columns(--bits);
    fill_columns();
  }

  int around(Vec3d p) const {
    for (int k = 0; k < 3; ++k)
      if (!(p[k] >= m_box.low[k] && p[k] <= m_box.high[k])) return 0;
    const GridPlace at = place(p);
    int turns = 0;
    for (const int t : m_columns.row(column(at.x >> m_shift, at.y >> m_shift))) turns += crossed_above(t, at, p.z);
    return turns;
  }

 private:
  const TriMesh& m_mesh;
  Bounds m_box;
  double m_step;
  std::vector<GridPlace> m_places;
  int m_shift, m_side;
  Csr m_columns;  ///< of triangles

  static constexpr double kMostColumns = 32;  ///< of a triangle, in the mean: there are meshes of needles

  void set_columns(int bits) {
    m_shift = kGridBits - bits;
    m_side = (1 << bits) + 1;  // the highest place has a column of its own
  }
  /// How often triangles stand in columns.
  double listed() const {
    double sum = 0;
    for (int t = 0; t < int(m_mesh.triangles.size()); ++t) {
      const auto [x0, x1, y0, y1] = columns_of(t);
      sum += double(x1 - x0 + 1) * double(y1 - y0 + 1);
    }
    return sum;
  }
  GridPlace place(Vec3d p) const {
    return {std::int64_t((p.x - m_box.low.x) / m_step), std::int64_t((p.y - m_box.low.y) / m_step)};
  }
  int column(std::int64_t i, std::int64_t j) const { return int(i) + m_side * int(j); }

  std::array<std::int64_t, 4> columns_of(int t) const {
    const auto& [a, b, c] = m_mesh.triangles[t];
    const auto [x0, x1] = std::minmax({m_places[a].x, m_places[b].x, m_places[c].x});
    const auto [y0, y1] = std::minmax({m_places[a].y, m_places[b].y, m_places[c].y});
    return {x0 >> m_shift, x1 >> m_shift, y0 >> m_shift, y1 >> m_shift};
  }
  template <class F>
  void for_each_column(int t, F&& f) const {
    const auto [x0, x1, y0, y1] = columns_of(t);
    for (std::int64_t j = y0; j <= y1; ++j)
      for (std::int64_t i = x0; i <= x1; ++i) f(column(i, j));
  }

  void fill_columns() {
    m_columns.start.assign(std::size_t(m_side) * m_side + 1, 0);
    const int triangles = int(m_mesh.triangles.size());
    for (int t = 0; t < triangles; ++t) for_each_column(t, [&](int c) { ++m_columns.start[c + 1]; });
    std::partial_sum(m_columns.start.begin(), m_columns.start.end(), m_columns.start.begin());
    m_columns.items.resize(std::size_t(m_columns.start.back()));
    std::vector<int> next(m_columns.start.begin(), m_columns.start.end() - 1);
    for (int t = 0; t < triangles; ++t) for_each_column(t, [&](int c) { m_columns.items[next[c]++] = t; });
  }

  /// 1 where a ray upwards leaves the body through this triangle, -1 where it enters, 0 where it passes by.
  int crossed_above(int t, GridPlace p, double z) const {
    const auto& [a, b, c] = m_mesh.triangles[t];
    const GridPlace pa = m_places[a], pb = m_places[b], pc = m_places[c];
    const bool left = to_the_left(p, pa, pb);
    if (left != to_the_left(p, pb, pc) || left != to_the_left(p, pc, pa)) return 0;
    const double wa = area_of(p, pb, pc), wb = area_of(p, pc, pa), wc = area_of(p, pa, pb), whole = wa + wb + wc;
    if (whole == 0.0) return 0;
    const auto [qa, qb, qc] = corners(m_mesh, t);
    const double height = (wa * qa.z + wb * qb.z + wc * qc.z) / whole;
    return height > z ? (left ? 1 : -1) : 0;
  }
};

struct SignedDistance {
  TriMesh mesh;
  TriangleTree tree{mesh};
  Turns turns{mesh};
  explicit SignedDistance(const TriMesh& closed) : mesh(closed) {}

  double operator()(Vec3d p) const {
    const double distance = std::sqrt(tree.distance2(p));
    return turns.around(p) > 0 ? distance : -distance;
  }
};

struct Distance {
  TriMesh mesh;
  TriangleTree tree{mesh};
  explicit Distance(const TriMesh& any) : mesh(any) {}
};

}  // namespace

std::function<double(Vec3d)> distance_to(const TriMesh& mesh) {
  if (mesh.triangles.empty()) throw std::invalid_argument("a mesh with triangles expected");
  const auto distance = std::make_shared<const Distance>(mesh);
  return [distance](Vec3d p) { return std::sqrt(distance->tree.distance2(p)); };
}

Field field_of(const TriMesh& closed) {
  if (!check_edges(closed).closed()) throw std::invalid_argument("a closed mesh expected, got one with open edges");
  if (!(volume(closed) > 0)) throw std::invalid_argument("a mesh that faces outwards expected, got no volume within");
  const auto distance = std::make_shared<const SignedDistance>(closed);
  return {[distance](Vec3d p) { return (*distance)(p); }, bounds(closed.positions), 1.0};
}

}  // namespace trocar::geometry
