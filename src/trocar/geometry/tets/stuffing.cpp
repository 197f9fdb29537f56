// Lattice points have whole coordinates in halves of a cube's edge: all even at the cubes' corners, all odd at their
// centres. An edge is long between two points of one kind, short between a corner and a centre. A cell has two long
// edges, which do not touch, and four short ones: it stands between two neighbouring cubes' centres and on one edge of
// the square that the cubes share.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <trocar/geometry/tets/stuffing.hpp>
#include <trocar/geometry/tets/stuffing_pinches.hpp>
#include <trocar/geometry/tets/tet_faces.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::geometry {
namespace {

using LatticePoint = std::array<int, 3>;

/// The ways along edges, upwards; the other seven are their opposites. The first three are long.
constexpr int kWays = 7, kLongWays = 3;
constexpr LatticePoint kWay[kWays] = {{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}};

/// The points of the lattice: numbered corners first, then centres.
class CentredLattice {
 public:
  CentredLattice(const Bounds& box, double cell, double most_cubes) : m_cell(cell) {
    double cubes = 1;
    for (int k = 0; k < 3; ++k) {
      const double extent = box.high[k] - box.low[k];
      const double along = std::ceil(extent / cell) + 2;  // one more cube beyond each side
      cubes *= along;
      if (!(extent >= 0 && cubes <= most_cubes))
        throw std::invalid_argument("larger cells expected: this lattice has more than " +
                                    std::to_string(std::int64_t(most_cubes)) + " cubes");
      m_cubes[k] = int(along);
      m_low[k] = 0.5 * (box.low[k] + box.high[k]) - 0.5 * cell * along;
    }
    m_corners = (m_cubes[0] + 1) * (m_cubes[1] + 1) * (m_cubes[2] + 1);
    m_points = m_corners + m_cubes[0] * m_cubes[1] * m_cubes[2];
  }

  int points() const { return m_points; }
  const LatticePoint& cubes() const { return m_cubes; }

  /// -1 outside.
  int number(const LatticePoint& p) const {
    const int odd = p[0] & 1;
    const int nx = m_cubes[0] + 1 - odd, ny = m_cubes[1] + 1 - odd, nz = m_cubes[2] + 1 - odd;
    if (p[0] < 0 || p[1] < 0 || p[2] < 0) return -1;
    const int i = p[0] >> 1, j = p[1] >> 1, k = p[2] >> 1;
    if (i >= nx || j >= ny || k >= nz) return -1;
    return (odd ? m_corners : 0) + i + nx * (j + ny * k);
  }
  LatticePoint place(int number) const {
    const int odd = number >= m_corners;
    const int nx = m_cubes[0] + 1 - odd, ny = m_cubes[1] + 1 - odd;
    if (odd) number -= m_corners;
    return {2 * (number % nx) + odd, 2 * (number / nx % ny) + odd, 2 * (number / nx / ny) + odd};
  }
  Vec3d position(const LatticePoint& p) const {
    return m_low + (0.5 * m_cell) * Vec3d{double(p[0]), double(p[1]), double(p[2])};
  }

 private:
  double m_cell;
  Vec3d m_low;
  LatticePoint m_cubes{};
  int m_corners = 0, m_points = 0;
};

LatticePoint step(const LatticePoint& p, int way, int sign) {
  return {p[0] + sign * kWay[way][0], p[1] + sign * kWay[way][1], p[2] + sign * kWay[way][2]};
}

/// Share of the way from a, which is on one side, to b, which is on the other, at which the field is 0: by the false
/// position, and by halves wherever that does not halve the bracket.
double crossing(const Field& field, Vec3d a, double at_a, Vec3d b, double at_b) {
  double low = 0, high = 1, f_low = at_a, f_high = at_b;
  constexpr double kEnough = 1e-9;
  for (int i = 0; i < 100 && high - low > kEnough; ++i) {
    const double before = high - low;
    const auto look = [&](double s) {
      const double f = field.inside(a + s * (b - a));
      if ((f > 0) == (f_low > 0)) {
        low = s;
        f_low = f;
      } else {
        high = s;
        f_high = f;
      }
    };
    // A little beyond the guess, so that the bracket closes from both sides.
    const double guess = low + before * (f_low / (f_low - f_high)), margin = 0.25 * kEnough;
    look(std::clamp(guess + (i % 2 ? margin : -margin), low + margin, high - margin));
    if (high - low > 0.5 * before && high - low > kEnough) look(0.5 * (low + high));
  }
  return 0.5 * (low + high);
}

/// What the surface does to the lattice.
struct Cut {
  int from;      ///< a point; the edge leads from it along a way
  double share;  ///< of the edge, from there
  Vec3d position;
};

class Stuffing {
 public:
  Stuffing(const Field& field, double cell, const StuffingOptions& options)
      : m_field(field), m_options(options), m_cell(cell), m_lattice(field.box, cell, 4.0 * options.most_cells) {}

  TetMesh run() {
    look_at_points();
    find_cuts();
    move_points();
    fill();
    std::vector<Vec3d> points = m_position;
    for (const Cut& cut : m_cuts) points.push_back(cut.position);
    leave_out_pinches(points, on_surface(), m_cells);
    if (m_cells.empty())
      throw std::invalid_argument("smaller cells expected: no cell of this lattice is inside the shape");
    return finished(points);
  }

 private:
  const Field& m_field;
  StuffingOptions m_options;
  double m_cell;
  CentredLattice m_lattice;
  std::vector<double> m_value;                   ///< of points
  std::vector<signed char> m_side;               ///< of points: 1 inside, 0 on the surface, -1 outside
  std::vector<Vec3d> m_position;                 ///< of points
  std::vector<int> m_row;                        ///< of points: of m_cut_at, or -1
  std::vector<std::array<int, kWays>> m_cut_at;  ///< of the edges upwards from a point: a cut or -1
  std::vector<Cut> m_cuts;
  std::vector<std::array<int, 4>> m_cells;  ///< of points, then of cuts

  void look_at_points() {
    const int n = m_lattice.points();
    m_value.resize(n);
    m_side.resize(n);
    m_position.resize(n);
    for (int p = 0; p < n; ++p) m_position[p] = m_lattice.position(m_lattice.place(p));
    const LatticePoint& cubes = m_lattice.cubes();
    look_at({0, 0, 0}, {2 * cubes[0], 2 * cubes[1], 2 * cubes[2]});
    for (int p = 0; p < n; ++p) m_side[p] = m_value[p] > 0 ? 1 : (m_value[p] == 0 ? 0 : -1);
  }

  /// The values of the points between two places, these included. Where the surface is further from the middle than the
  /// farthest of them and an edge more, they are all on the middle's side, and no edge from them is cut: then one value
  /// does for all.
  void look_at(const LatticePoint& low, const LatticePoint& high) {
    const LatticePoint extent{high[0] - low[0], high[1] - low[1], high[2] - low[2]};
    const int axis = int(std::max_element(extent.begin(), extent.end()) - extent.begin());
    if (extent[axis] < 4) return set_values(low, high, [&](int p) { return m_field.inside(m_position[p]); });
    const Vec3d a = m_lattice.position(low), b = m_lattice.position(high);
    const double middle = m_field.inside(0.5 * (a + b));
    if (std::fabs(middle) > m_field.steepest * (0.5 * length(b - a) + 1.01 * m_cell))
      return set_values(low, high, [&](int) { return middle; });
    LatticePoint end = high, start = low;
    end[axis] = low[axis] + extent[axis] / 2;
    start[axis] = end[axis] + 1;
    look_at(low, end);
    look_at(start, high);
  }
  template <class F>
  void set_values(const LatticePoint& low, const LatticePoint& high, F&& value) {
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x) {
          if (((x ^ y) & 1) != 0 || ((x ^ z) & 1) != 0) continue;
          const int p = m_lattice.number({x, y, z});
          m_value[p] = value(p);
        }
  }

  void find_cuts() {
    m_row.assign(m_lattice.points(), -1);
    for (int p = 0; p < m_lattice.points(); ++p) {
      const LatticePoint place = m_lattice.place(p);
      for (int way = 0; way < kWays; ++way) {
        const int q = m_lattice.number(step(place, way, 1));
        if (q < 0 || m_side[p] * m_side[q] >= 0) continue;
        if (m_row[p] < 0) {
          m_row[p] = int(m_cut_at.size());
          m_cut_at.emplace_back().fill(-1);
        }
        const double share = crossing(m_field, m_position[p], m_value[p], m_position[q], m_value[q]);
        m_cut_at[m_row[p]][way] = int(m_cuts.size());
        m_cuts.push_back({p, share, m_position[p] + share * (m_position[q] - m_position[p])});
      }
    }
  }

  /// The cut between a point and its neighbour, and the share of the edge from the point; -1: none.
  int cut_along(int p, const LatticePoint& place, int way, int sign, double& share) const {
    const int q = m_lattice.number(step(place, way, sign));
    if (q < 0 || m_side[p] * m_side[q] >= 0) return -1;
    const int from = sign > 0 ? p : q;
    const int cut = m_cut_at[m_row[from]][way];
    share = sign > 0 ? m_cuts[cut].share : 1 - m_cuts[cut].share;
    return cut;
  }

  /// Every point that a cut is too near to goes to the nearest such cut. The cuts on its edges are then no more, as it
  /// is on neither side.
  void move_points() {
    for (int p = 0; p < m_lattice.points(); ++p) {
      if (m_side[p] == 0) continue;
      const LatticePoint place = m_lattice.place(p);
      int nearest = -1;
      double least = std::numeric_limits<double>::max();
      for (int way = 0; way < kWays; ++way)
        for (const int sign : {1, -1}) {
          double share = 0;
          const int cut = cut_along(p, place, way, sign, share);
          if (cut < 0 || !(share < (way < kLongWays ? m_options.snap_long : m_options.snap_short))) continue;
          const Vec3d d = m_cuts[cut].position - m_position[p];
          if (dot(d, d) < least * (1 - 1e-6)) {  // of equal ones the first, also where rounding differs
            least = dot(d, d);
            nearest = cut;
          }
        }
      if (nearest < 0) continue;
      m_position[p] = m_cuts[nearest].position;
      m_side[p] = 0;
    }
  }

  /// The node where the surface crosses the edge between two points on its two sides.
  int cut_between(int p, int q) const {
    const LatticePoint a = m_lattice.place(p), b = m_lattice.place(q);
    LatticePoint d{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    const bool swap = d[0] + d[1] + d[2] < 0;
    if (swap) d = {-d[0], -d[1], -d[2]};
    const int way = int(std::find(std::begin(kWay), std::end(kWay), d) - std::begin(kWay));
    return m_lattice.points() + m_cut_at[m_row[swap ? q : p]][way];
  }

  void fill() {
    const LatticePoint& cubes = m_lattice.cubes();
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      LatticePoint below{};  // the cube before the square
      for (below[2] = 0; below[2] < cubes[2] - (axis == 2); ++below[2])
        for (below[1] = 0; below[1] < cubes[1] - (axis == 1); ++below[1])
          for (below[0] = 0; below[0] < cubes[0] - (axis == 0); ++below[0]) around_square(below, axis, u, v);
    }
  }

  /// The four cells on the square between a cube and the next along `axis`.
  void around_square(const LatticePoint& below, int axis, int u, int v) {
    const LatticePoint centre{2 * below[0] + 1, 2 * below[1] + 1, 2 * below[2] + 1};
    LatticePoint next = centre;
    next[axis] += 2;
    constexpr int kRound[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    std::array<int, 5> corner{};
    for (int k = 0; k < 5; ++k) {
      LatticePoint p = centre;
      p[axis] += 1;
      p[u] += kRound[k][0];
      p[v] += kRound[k][1];
      corner[k] = m_lattice.number(p);
    }
    const int low = m_lattice.number(centre), high = m_lattice.number(next);
    for (int k = 0; k < 4; ++k) divide({corner[k], corner[k + 1], low, high});
  }

  void add(bool turned, int a, int b, int c, int d) {
    if (turned) std::swap(c, d);
    m_cells.push_back({a, b, c, d});
    if (int(m_cells.size()) > m_options.most_cells)
      throw std::invalid_argument("larger cells expected: the body would have more than " +
                                  std::to_string(m_options.most_cells));
  }

  /// The part of a lattice cell that is inside. Its corners, sorted from inside to outside, tell the pattern.
  void divide(std::array<int, 4> c) {
    bool turned = false;
    for (int last = 3; last > 0; --last)
      for (int k = 0; k < last; ++k)
        if (m_side[c[k]] < m_side[c[k + 1]]) {
          std::swap(c[k], c[k + 1]);
          turned = !turned;
        }
    const auto count = [&](int side) {
      return std::count_if(c.begin(), c.end(), [&](int p) { return m_side[p] == side; });
    };
    const auto inside = count(1), outside = count(-1);
    const int p = c[0], q = c[1], r = c[2], s = c[3];
    if (inside == 0) return;
    if (outside == 0) return add(turned, p, q, r, s);
    if (inside == 1) {  // the corner that is inside; those outside become cuts
      const auto end = [&](int corner) { return m_side[corner] < 0 ? cut_between(p, corner) : corner; };
      return add(turned, p, end(q), end(r), end(s));
    }
    if (inside == 2 && outside == 1) return pyramid(turned, p, q, r, s);
    if (inside == 3)
      return prism(turned, {p, q, r}, {cut_between(p, s), cut_between(q, s), cut_between(r, s)},
                   {from_first(p, q, s), from_first(q, r, s), from_first(r, p, s)});
    const bool at_r = from_first(p, q, r), at_s = from_first(p, q, s);
    prism(turned, {p, cut_between(p, r), cut_between(p, s)}, {q, cut_between(q, r), cut_between(q, s)},
          {at_r, !at_r, !at_s});
  }

  /// p, q inside, r on the surface, s outside.
  void pyramid(bool turned, int p, int q, int r, int s) {
    const int at_p = cut_between(p, s), at_q = cut_between(q, s);
    if (from_first(p, q, s)) {
      add(turned, p, q, r, at_q);
      add(turned, p, at_q, r, at_p);
    } else {
      add(turned, p, q, r, at_p);
      add(turned, at_p, q, r, at_q);
    }
  }

  /// Three tetrahedra between the triangles a and b, a0 a1 a2 b0 being upright. Which diagonal the square between the
  /// columns k and k + 1 has: from a_k to b_k+1, or from a_k+1 to b_k.
  void prism(bool turned, const std::array<int, 3>& a, const std::array<int, 3>& b, const std::array<bool, 3>& up) {
    // The column that both its diagonals leave upwards comes first, the one where they arrive last.
    int first = 0;
    while (!(up[first] && !up[(first + 2) % 3])) ++first;
    const int next = (first + 1) % 3, other = (first + 2) % 3;
    const bool in_turn = up[next];
    const int i = first, j = in_turn ? next : other, k = in_turn ? other : next;
    const bool flip = turned != !in_turn;
    add(flip, a[i], a[j], a[k], b[k]);
    add(flip, a[i], a[j], b[k], b[j]);
    add(flip, a[i], b[i], b[j], b[k]);
  }

  /// Where p and q are inside and s is outside, what is left of their triangle is a quadrangle. Is its diagonal the one
  /// from p to the cut on q's edge, or that from q to the cut on p's? Both cells at the triangle find the same answer,
  /// and no prism gets three diagonals that go round it, which could not be filled.
  bool from_first(int p, int q, int s) const {
    const LatticePoint a = m_lattice.place(p), b = m_lattice.place(q), c = m_lattice.place(s);
    const auto long_edge = [](const LatticePoint& x, const LatticePoint& y) { return ((x[0] ^ y[0]) & 1) == 0; };
    if (!long_edge(a, b)) return long_edge(b, c);  // to the cut that is on a long edge
    const int beyond = (a[0] > c[0]) + (a[1] > c[1]) + (a[2] > c[2]);
    return beyond % 2 == 0;  // symmetric: the parity rule, odd for exactly one of p and q
  }

  /// Points inside have all their cells, so only the others can be in the surface.
  std::vector<bool> on_surface() const {
    std::vector<bool> out(m_position.size() + m_cuts.size(), true);
    for (int p = 0; p < m_lattice.points(); ++p) out[p] = m_side[p] <= 0;
    return out;
  }

  TetMesh finished(const std::vector<Vec3d>& points) const;
};

/// Position along a Morton curve through the box.
std::uint64_t morton(Vec3d p, const Bounds& box, double side) {
  std::uint64_t code = 0;
  for (int k = 0; k < 3; ++k) {
    const auto cell = std::uint64_t(std::clamp((p[k] - box.low[k]) / side, 0.0, 1.0) * 65535.0);
    for (int bit = 0; bit < 16; ++bit) code |= (cell >> bit & 1u) << (3 * bit + k);
  }
  return code;
}

/// The nodes that cells have, along the curve; cells by their nodes, the lowest first.
TetMesh in_order(const std::vector<Vec3d>& points, const std::vector<std::array<int, 4>>& cells) {
  TetMesh mesh;
  mesh.cells = cells;
  const std::vector<bool> used = used_nodes({points, cells, {}});
  const Bounds box = bounds_of(points, used);
  const Vec3d extent = box.high - box.low;
  const double side = std::max({extent.x, extent.y, extent.z});
  std::vector<std::pair<std::uint64_t, int>> order;
  for (int p = 0; p < int(points.size()); ++p)
    if (used[p]) order.push_back({morton(points[p], box, side), p});
  std::sort(order.begin(), order.end());
  std::vector<int> number(points.size(), -1);
  for (const auto& [code, p] : order) {
    number[p] = int(mesh.points.size());
    mesh.points.push_back(points[p]);
  }
  for (auto& cell : mesh.cells)
    for (int& node : cell) node = number[node];
  const auto sorted = [](std::array<int, 4> cell) {
    std::sort(cell.begin(), cell.end());
    return cell;
  };
  std::sort(mesh.cells.begin(), mesh.cells.end(), [&](const auto& a, const auto& b) { return sorted(a) < sorted(b); });
  return mesh;
}

/// The cells of the group with the largest volume; of equal ones the one with the lowest cell.
std::vector<std::array<int, 4>> largest_part(const TetMesh& mesh) {
  const int cells = int(mesh.cells.size());
  std::vector<std::array<int, 4>> across(cells, {-1, -1, -1, -1});
  const std::vector<TetFace> faces = sorted_faces(mesh);
  for_each_face(faces, [&](std::span<const TetFace> same) {
    for (std::size_t k = 1; k < same.size(); ++k) {
      across[same[k - 1].cell][same[k - 1].opposite] = same[k].cell;
      across[same[k].cell][same[k].opposite] = same[k - 1].cell;
    }
  });
  std::vector<int> part(cells, -1), waiting;
  int best = -1, parts = 0;
  double most = -1;
  for (int start = 0; start < cells; ++start) {
    if (part[start] >= 0) continue;
    double sum = 0;
    part[start] = parts;
    waiting.assign(1, start);
    while (!waiting.empty()) {
      const int c = waiting.back();
      waiting.pop_back();
      sum += volume(mesh, c);
      for (const int next : across[c])
        if (next >= 0 && part[next] < 0) {
          part[next] = parts;
          waiting.push_back(next);
        }
    }
    if (sum > most) {
      most = sum;
      best = parts;
    }
    ++parts;
  }
  std::vector<std::array<int, 4>> kept;
  for (int c = 0; c < cells; ++c)
    if (part[c] == best) kept.push_back(mesh.cells[c]);
  return kept;
}

TetMesh Stuffing::finished(const std::vector<Vec3d>& points) const {
  const TetMesh all = in_order(points, m_cells);
  return m_options.largest_part ? in_order(all.points, largest_part(all)) : all;
}

/// Cosine of the angle between the faces opposite to corners i and j, within the cell.
double dihedral_cosine(const std::array<Vec3d, 4>& x, int i, int j) {
  const int k = i == 0 || j == 0 ? (i == 1 || j == 1 ? 2 : 1) : 0, l = 6 - i - j - k;
  const Vec3d along = normalised(x[l] - x[k]);
  const Vec3d a = x[i] - x[k], b = x[j] - x[k];
  return dot(normalised(a - dot(a, along) * along), normalised(b - dot(b, along) * along));
}

}  // namespace

TetMesh stuffed(const Field& field, double cell, const StuffingOptions& options) {
  if (!(cell > 0)) throw std::invalid_argument("a cell above 0 expected");
  return Stuffing(field, cell, options).run();
}
TetMesh stuffed(const TriMesh& closed, double cell, const StuffingOptions& options) {
  return stuffed(field_of(closed), cell, options);
}
TetMesh stuffed(const Voxels& voxels, int label, double cell, const StuffingOptions& options) {
  return stuffed(field_of_label(voxels, label), cell, options);
}

namespace {

void measure_angles(const TetMesh& body, StuffingReport& report) {
  double least = 1, most = -1;  // cosines
  for (const auto& cell : body.cells) {
    std::array<Vec3d, 4> x{};
    for (int k = 0; k < 4; ++k) x[k] = body.points[cell[k]];
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        const double c = dihedral_cosine(x, i, j);
        least = std::min(least, c);
        most = std::max(most, c);
      }
  }
  report.least_dihedral = portable::acos(most) * 180 / portable::pi;
  report.most_dihedral = portable::acos(least) * 180 / portable::pi;
}

}  // namespace

StuffingReport compare(const TetMesh& body, const Field& field) {
  const TetFacts facts = inspect(body, 0);
  StuffingReport report;
  report.nodes = facts.nodes;
  report.cells = facts.cells;
  report.parts = facts.parts;
  report.odd_edges = facts.odd_edges;
  report.volume = facts.volume;
  measure_angles(body, report);
  const TriMesh surface = surface_of(body).mesh;
  const auto off = [&](Vec3d p) { return std::fabs(field.inside(p)); };
  for (const Vec3d p : surface.positions) report.nodes_off = std::max(report.nodes_off, off(p));
  for (const auto& t : surface.triangles) {
    const Vec3d a = surface.positions[t[0]], b = surface.positions[t[1]], c = surface.positions[t[2]];
    for (const Vec3d p : {0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0})
      report.surface_off = std::max(report.surface_off, off(p));
  }
  return report;
}

ShapeReport compare(const TetMesh& body, const TriMesh& closed) {
  ShapeReport report{compare(body, field_of(closed)), 0, 0};
  report.shape_volume = volume(closed);
  const auto distance = distance_to(surface_of(body).mesh);
  for (const Vec3d p : closed.positions) report.shape_off = std::max(report.shape_off, distance(p));
  return report;
}

}  // namespace trocar::geometry
