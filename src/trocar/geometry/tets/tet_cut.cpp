#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_cut.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>
#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

constexpr int kPairs[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
constexpr int kFace[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};  // seen from outside counter-clockwise
constexpr double kMostCosine = 0.98480775301220802;                        // of kLeastDihedral
// Of the volume of the cells around a node, what a snap along the surface may change it by: on curved organs few snaps
// keep it, and each is booked.
constexpr double kMostLoss = 0.005;
constexpr double kSnapShares[] = {1, 0.5, 0.25};  // of the way, whatever fits first

double volume6(const std::array<Vec3d, 4>& x) noexcept { return geometry::volume6(x[0], x[1], x[2], x[3]); }

/// Largest cosine of a cell's dihedral angles; 2 where it has no volume.
double most_cosine(const std::array<Vec3d, 4>& x) noexcept {
  if (!(volume6(x) > 0)) return 2;
  std::array<Vec3d, 4> n;
  for (int f = 0; f < 4; ++f) {
    const Vec3d v = cross(x[kFace[f][1]] - x[kFace[f][0]], x[kFace[f][2]] - x[kFace[f][0]]);
    n[f] = v / length(v);
  }
  double most = -1;
  for (const auto& p : kPairs) most = std::max(most, -dot(n[p[0]], n[p[1]]));
  return most;
}

template <class Points>
std::array<Vec3d, 4> corners(const Points& points, const Tet& c) noexcept {
  return {points[std::size_t(c[0])], points[std::size_t(c[1])], points[std::size_t(c[2])], points[std::size_t(c[3])]};
}

int corner_of(const Tet& cell, std::int32_t node) noexcept {
  for (int i = 0; i < 4; ++i)
    if (cell[std::size_t(i)] == node) return i;
  return -1;
}

/// One cut, stage after stage.
class Cutter {
 public:
  Cutter(CuttableTets& body, const Blade& blade, std::span<Vec3d> now, CutWork& work) noexcept
      : b(body), m_plane(blade), m_now(now), w(work) {
    m_book.first_new = b.nodes;
  }

  CutResult run() noexcept {
    w.touched_count = 0;
    if (!m_plane.flat) return m_book;
    gather_cells(b.cells, w.begin, w.around);
    find_crossings();
    snap();
    take_sides();
    part_faces();
    double_nodes();
    return m_book;
  }

 private:
  std::span<const std::int32_t> cells_at(std::int32_t node) const noexcept {
    const std::size_t first = std::size_t(w.begin[std::size_t(node)]);
    return {w.around.data() + first, std::size_t(w.begin[std::size_t(node) + 1]) - first};
  }

  /// Of every edge that the blade crosses the nearer end is at the blade.
  void find_crossings() noexcept {
    for (std::int32_t i = 0; i < b.nodes; ++i) {
      w.height[std::size_t(i)] = m_plane.height(m_now[std::size_t(i)]);
      w.at_blade[std::size_t(i)] = 0;
      w.nearest[std::size_t(i)] = 1e300;
    }
    for (const Tet& c : b.cells) {
      int above = 0;
      for (const std::int32_t node : c) above += w.height[std::size_t(node)] >= 0;
      if (above == 0 || above == 4) continue;
      for (const auto& p : kPairs) cross_edge(c[std::size_t(p[0])], c[std::size_t(p[1])]);
    }
  }
  void cross_edge(std::int32_t i, std::int32_t j) noexcept {
    if (j < i) std::swap(i, j);  // the same arithmetic from every cell
    const double hi = w.height[std::size_t(i)], hj = w.height[std::size_t(j)];
    if ((hi >= 0) == (hj >= 0)) return;
    const double t = hi / (hi - hj);
    const Vec3d from = m_now[std::size_t(i)], along = m_now[std::size_t(j)] - from;
    if (!m_plane.covers(from + t * along)) return;
    const bool first = t <= 0.5;
    const std::int32_t near = first ? i : j;
    const double share = first ? t : 1 - t, way = share * length(along);
    w.at_blade[std::size_t(near)] = 1;
    if (way >= w.nearest[std::size_t(near)]) return;
    w.nearest[std::size_t(near)] = way;
    w.towards[std::size_t(near)] = first ? j : i;
    const Vec3d rest = b.rest[std::size_t(near)];
    w.target_rest[std::size_t(near)] = rest + share * (b.rest[std::size_t(w.towards[std::size_t(near)])] - rest);
    w.target_now[std::size_t(near)] = from + t * along;
  }

  void snap() noexcept {
    for (std::int32_t node = 0; node < b.nodes; ++node) {
      if (!w.at_blade[std::size_t(node)]) continue;
      bool done = w.nearest[std::size_t(node)] == 0;
      for (const double part : kSnapShares) {
        if (done) break;
        done = try_snap(node, part);
      }
      ++(done ? m_book.snapped : m_book.refused);
    }
  }
  /// Moves the node along its edge if every cell around it stays well shaped, or at least no worse than it was.
  bool try_snap(std::int32_t node, double share) noexcept {
    const std::int32_t other = w.towards[std::size_t(node)];
    if (on_surface(node) && !surface_edge(node, other)) return false;
    Vec3d& rest = b.rest[std::size_t(node)];
    const Vec3d before = rest;
    double volume = 0, whole = 0, worst_before = -1, worst = -1;
    for (const std::int32_t t : cells_at(node)) {
      const std::array<Vec3d, 4> x = corners(b.rest, b.cells[std::size_t(t)]);
      volume -= volume6(x);
      whole += volume6(x);
      worst_before = std::max(worst_before, most_cosine(x));
    }
    rest = before + share * (w.target_rest[std::size_t(node)] - before);
    for (const std::int32_t t : cells_at(node)) {
      const std::array<Vec3d, 4> x = corners(b.rest, b.cells[std::size_t(t)]);
      volume += volume6(x);
      worst = std::max(worst, most_cosine(x));
    }
    if ((worst > kMostCosine && worst >= worst_before) || std::fabs(volume) > kMostLoss * whole) {
      rest = before;
      return false;
    }
    m_book.volume += volume / 6;
    Vec3d& now = m_now[std::size_t(node)];
    now += share * (w.target_now[std::size_t(node)] - now);
    w.height[std::size_t(node)] = m_plane.height(now);
    return true;
  }
  bool on_surface(std::int32_t node) const noexcept {
    for (const std::int32_t t : cells_at(node))
      for (int f = 0; f < 4; ++f)
        if (b.across[std::size_t(t)][std::size_t(f)] < 0 && b.cells[std::size_t(t)][std::size_t(f)] != node)
          return true;
    return false;
  }
  bool surface_edge(std::int32_t i, std::int32_t j) const noexcept {
    for (const std::int32_t t : cells_at(i)) {
      const Tet& c = b.cells[std::size_t(t)];
      if (corner_of(c, j) < 0) continue;
      for (int f = 0; f < 4; ++f)
        if (b.across[std::size_t(t)][std::size_t(f)] < 0 && c[std::size_t(f)] != i && c[std::size_t(f)] != j)
          return true;
    }
    return false;
  }

  /// A cell with a corner at the blade lies on one side of it, or on neither at the blade's end.
  void take_sides() noexcept {
    for (std::size_t t = 0; t < b.cells.size(); ++t) {
      const Tet& c = b.cells[t];
      int at = 0, above = 0, below = 0;
      double height = 0;
      for (const std::int32_t node : c) {
        height += w.height[std::size_t(node)];
        if (w.at_blade[std::size_t(node)])
          ++at;
        else
          ++(w.height[std::size_t(node)] >= 0 ? above : below);
      }
      if (at == 0 || (above > 0 && below > 0))
        w.side[t] = 0;
      else if (at == 4)
        w.side[t] = height >= 0 ? 1 : -1;
      else
        w.side[t] = above > 0 ? 1 : -1;
      if (at > 0) w.touched[std::size_t(w.touched_count++)] = std::int32_t(t);
    }
  }

  void part_faces() noexcept {
    for (std::int32_t k = 0; k < w.touched_count; ++k) {
      const std::int32_t t = w.touched[std::size_t(k)];
      for (int f = 0; f < 4; ++f) {
        const std::int32_t u = b.across[std::size_t(t)][std::size_t(f)];
        if (u < 0 || w.side[std::size_t(t)] * w.side[std::size_t(u)] >= 0) continue;
        if (!all_at_blade(b.cells[std::size_t(t)], f)) continue;
        b.across[std::size_t(t)][std::size_t(f)] = -1;
        for (std::int32_t& back : b.across[std::size_t(u)])
          if (back == t) back = -1;
        ++m_book.parted;
      }
    }
  }
  bool all_at_blade(const Tet& c, int face) const noexcept {
    for (int i = 0; i < 4; ++i)
      if (i != face && !w.at_blade[std::size_t(c[std::size_t(i)])]) return false;
    return true;
  }

  /// Around a node the cells that hang together over faces share it; each further fan gets a node of its own.
  void double_nodes() noexcept {
    const std::int32_t before = b.nodes;
    for (std::int32_t node = 0; node < before; ++node) {
      if (!w.at_blade[std::size_t(node)]) continue;
      const std::span<const std::int32_t> around = cells_at(node);
      for (const std::int32_t t : around) w.seen[std::size_t(t)] = 0;
      bool first = true;
      for (const std::int32_t t : around) {
        if (w.seen[std::size_t(t)]) continue;
        const int size = collect_fan(t, node);
        if (!first) give_own_node(node, size);
        first = false;
      }
    }
  }
  int collect_fan(std::int32_t start, std::int32_t node) noexcept {
    int size = 0;
    w.fan[std::size_t(size++)] = start;
    w.seen[std::size_t(start)] = 1;
    for (int head = 0; head < size; ++head) {
      const std::int32_t t = w.fan[std::size_t(head)];
      for (int f = 0; f < 4; ++f) {
        const std::int32_t u = b.across[std::size_t(t)][std::size_t(f)];
        if (u < 0 || b.cells[std::size_t(t)][std::size_t(f)] == node || w.seen[std::size_t(u)]) continue;
        w.seen[std::size_t(u)] = 1;
        w.fan[std::size_t(size++)] = u;
      }
    }
    return size;
  }
  void give_own_node(std::int32_t node, int fan) noexcept {
    if (std::size_t(b.nodes) == b.rest.size()) {
      m_book.full = true;
      return;
    }
    const std::int32_t twin = b.nodes++;
    b.rest[std::size_t(twin)] = b.rest[std::size_t(node)];
    b.source[std::size_t(twin)] = node;
    m_now[std::size_t(twin)] = m_now[std::size_t(node)];
    for (int i = 0; i < fan; ++i) {
      Tet& c = b.cells[std::size_t(w.fan[std::size_t(i)])];
      c[std::size_t(corner_of(c, node))] = twin;
    }
    ++m_book.doubled;
  }

  CuttableTets& b;
  BladePlane m_plane;
  std::span<Vec3d> m_now;
  CutWork& w;
  CutResult m_book;
};

}  // namespace

double least_dihedral(const std::array<Vec3d, 4>& x) noexcept {
  const double cosine = most_cosine(x);
  return cosine > 1 ? 0 : portable::acos(std::min(1.0, std::max(-1.0, cosine))) * 180 / portable::pi;
}

CuttableTets cuttable(std::span<const Vec3d> points, std::span<const Tet> cells, int spare_nodes) {
  CuttableTets b;
  b.nodes = std::int32_t(points.size());
  b.rest.assign(points.begin(), points.end());
  b.rest.resize(points.size() + std::size_t(std::max(spare_nodes, 0)));
  for (std::size_t i = 0; i < b.rest.size(); ++i) b.source.push_back(std::int32_t(i));
  b.cells.assign(cells.begin(), cells.end());
  b.across.assign(cells.size(), {-1, -1, -1, -1});
  for (std::size_t t = 0; t < cells.size(); ++t) {
    for (const std::int32_t node : cells[t])
      if (node < 0 || std::size_t(node) >= points.size())
        throw std::invalid_argument("cell " + std::to_string(t) + ": expected corners that exist");
    if (!(volume6(corners(points, cells[t])) > 0))
      throw std::invalid_argument("cell " + std::to_string(t) + ": expected positive volume");
  }
  const TetMesh mesh{{points.begin(), points.end()}, b.cells, {}};
  for_each_face(sorted_faces(mesh), [&](std::span<const TetFace> same) {
    if (same.size() > 2)
      throw std::invalid_argument("cell " + std::to_string(same[2].cell) + ": expected at most two cells at a face");
    if (same.size() < 2) return;
    for (int i = 0; i < 2; ++i)
      b.across[std::size_t(same[std::size_t(i)].cell)][std::size_t(same[std::size_t(i)].opposite)] =
          same[std::size_t(1 - i)].cell;
  });
  return b;
}

void gather_cells(std::span<const Tet> cells, std::span<std::int32_t> begin, std::span<std::int32_t> around) noexcept {
  std::fill(begin.begin(), begin.end(), 0);
  for (const Tet& c : cells)
    for (const std::int32_t node : c) ++begin[std::size_t(node) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  for (std::size_t t = 0; t < cells.size(); ++t)
    for (const std::int32_t node : cells[t]) around[std::size_t(begin[std::size_t(node)]++)] = std::int32_t(t);
  for (std::size_t i = begin.size() - 1; i > 0; --i) begin[i] = begin[i - 1];
  begin[0] = 0;
}

CutWork make_work(const CuttableTets& body) {
  CutWork w;
  const std::size_t nodes = body.rest.size(), cells = body.cells.size();
  w.height.resize(nodes);
  w.at_blade.resize(nodes);
  w.nearest.resize(nodes);
  w.towards.resize(nodes);
  w.target_rest.resize(nodes);
  w.target_now.resize(nodes);
  w.side.resize(cells);
  w.begin.resize(nodes + 1);
  w.around.resize(4 * cells);
  w.fan.resize(cells);
  w.seen.resize(cells);
  w.touched.resize(cells);
  return w;
}

CutResult cut(CuttableTets& body, const Blade& blade, std::span<Vec3d> now, CutWork& work) noexcept {
  return Cutter(body, blade, now, work).run();
}

}  // namespace trocar::geometry
