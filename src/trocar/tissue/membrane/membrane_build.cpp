// Compiling a sheet: springs and bending stencils of its cells, the steps it needs, and the shape in which it hangs.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/tissue/membrane/membrane.hpp>
#include <trocar/tissue/network/stability.hpp>

namespace trocar::tissue {
namespace {

[[noreturn]] void refuse_membrane(const std::string& what) {
  throw std::invalid_argument("membrane: expected " + what);
}

void check_closed(const MembraneDescription& d) {
  if (d.columns != 0 || d.rows != 0) refuse_membrane("either a grid or triangles");
  for (const auto& t : d.triangles)
    for (int i : t)
      if (i < 0 || std::size_t(i) >= d.positions.size()) refuse_membrane("triangles of known nodes");
  const geometry::TriMesh mesh{d.positions, d.triangles};
  if (!geometry::check_edges(mesh).closed()) refuse_membrane("triangles that close");
  if (!(geometry::volume(mesh) > 0)) refuse_membrane("triangles that face outwards");
}

void check_enclosure(const Enclosure& e, bool closed) {
  if (e.kind == Enclosure::none) return;
  if (!closed) refuse_membrane("nothing enclosed by a sheet that is open");
  if (!(e.density >= 0 && std::isfinite(e.pressure))) refuse_membrane("contents with a pressure and a density >= 0");
  if (e.kind == Enclosure::liquid && !(e.bulk > 0)) refuse_membrane("a liquid with a bulk modulus > 0");
  if (e.kind == Enclosure::gas && !(e.pressure > -kAtmosphere)) refuse_membrane("gas at an absolute pressure > 0");
}

void check(const MembraneDescription& d, double tick) {
  const bool closed = !d.triangles.empty();
  check_enclosure(d.enclosure, closed);
  if (closed)
    check_closed(d);
  else if (d.columns < 2 || d.rows < 2 || d.columns > 10000 || d.rows > 10000)
    refuse_membrane("2 to 10000 columns and rows");
  const std::size_t n = closed ? d.positions.size() : std::size_t(d.columns) * std::size_t(d.rows);
  if (d.positions.size() != n) refuse_membrane("columns x rows positions, got " + std::to_string(d.positions.size()));
  if (!d.held.empty() && d.held.size() != n) refuse_membrane("no held flags, or one per node");
  if (!(tick > 0)) refuse_membrane("tick > 0 s");
  if (!(d.thickness > 0 && d.youngs_modulus > 0 && d.density > 0))
    refuse_membrane("thickness, youngs_modulus, density > 0");
  if (!d.law.monotone()) refuse_membrane("a law whose force grows with strain (P1^2 < 3 P2)");
  if (!(d.damping_time >= 0 && d.bending_damping_time >= 0 && d.global_damping >= 0)) refuse_membrane("damping >= 0");
}

/// A cell's corners, row by row, and its mean width, height and area.
struct SheetCell {
  int a, b, c, d;  // (column, row), (column + 1, row), (column, row + 1), (column + 1, row + 1)
  double width, height, area, diagonal2;
};

SheetCell cell_at(const MembraneDescription& m, int column, int row) {
  SheetCell e{};
  e.a = row * m.columns + column, e.b = e.a + 1, e.c = e.a + m.columns, e.d = e.c + 1;
  const auto& x = m.positions;
  const auto far = [&](int i, int j) { return length(x[std::size_t(j)] - x[std::size_t(i)]); };
  e.width = 0.5 * (far(e.a, e.b) + far(e.c, e.d));
  e.height = 0.5 * (far(e.a, e.c) + far(e.b, e.d));
  const Vec3d across = x[std::size_t(e.d)] - x[std::size_t(e.a)], down = x[std::size_t(e.c)] - x[std::size_t(e.b)];
  e.area = 0.5 * length(cross(across, down));
  e.diagonal2 = 0.5 * (dot(across, across) + dot(down, down));
  if (!(e.area > 1e-3 * e.width * e.height) || !(e.width > 1e-6 && e.height > 1e-6))
    refuse_membrane("cells with an area, got none at column " + std::to_string(column) + ", row " +
                    std::to_string(row));
  return e;
}

/// The net's springs before they are described: k and the two nodes, summed over the cells that share them.
struct NetSpring {
  int a, b;
  double k;
};

/// An edge of a closed surface: its ends, its two triangles, the corners that face it.
struct Edge {
  int a, b;
  int triangle[2], facing[2];
};

std::vector<Edge> edges_of(const MembraneDescription& m) {
  struct Side {
    int low, high, triangle, facing;
  };
  std::vector<Side> sides;
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = m.triangles[t][k], b = m.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), int(t), m.triangles[t][(k + 2) % 3]});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& x, const Side& y) {
    if (x.low != y.low) return x.low < y.low;
    if (x.high != y.high) return x.high < y.high;
    return x.triangle < y.triangle;
  });
  std::vector<Edge> out;
  for (std::size_t i = 0; i + 1 < sides.size(); i += 2)
    out.push_back({sides[i].low,
                   sides[i].high,
                   {sides[i].triangle, sides[i + 1].triangle},
                   {sides[i].facing, sides[i + 1].facing}});
  return out;
}

/// Of the angle at `at` in a triangle with a and b.
double cotangent(const MembraneDescription& m, int at, int a, int b) {
  const Vec3d u = m.positions[std::size_t(a)] - m.positions[std::size_t(at)];
  const Vec3d v = m.positions[std::size_t(b)] - m.positions[std::size_t(at)];
  const double area = length(cross(u, v));
  if (!(area > 1e-4 * length(u) * length(v))) refuse_membrane("triangles with an area");
  return dot(u, v) / area;
}

double area_of(const MembraneDescription& m, std::size_t t) {
  return 0.5 * length(geometry::area_vector(
                   {{m.positions[std::size_t(m.triangles[t][0])], m.positions[std::size_t(m.triangles[t][1])],
                     m.positions[std::size_t(m.triangles[t][2])]},
                    {{0, 1, 2}}},
                   0));
}

/// Equal tension T pulls along a triangle's side s with T s cot(facing angle) / 2, and T = E t e / (1 - nu) at the
/// strain e. Sides that face wide angles on both sides keep a little.
std::vector<NetSpring> springs_of_triangles(const MembraneDescription& m) {
  const double modulus = m.youngs_modulus * m.thickness;
  std::vector<NetSpring> out;
  for (const Edge& e : edges_of(m)) {
    const double cot = cotangent(m, e.facing[0], e.a, e.b) + cotangent(m, e.facing[1], e.a, e.b);
    out.push_back({e.a, e.b, 0.5 * modulus / (1 - kSheetPoisson) * std::max(0.02, cot)});
  }
  return out;
}

/// With k_x = (3/8) E t (3 h/w - w/h), k_y the same turned, k_d = (3/16) E t d^2 / (w h) a rectangle of w x h has the
/// plane-stress stiffness of E t and nu = 1/3. Beyond w/h = sqrt 3 one of them would be negative: it is kept above a
/// twentieth.
std::vector<NetSpring> springs_of(const MembraneDescription& m) {
  if (!m.triangles.empty()) return springs_of_triangles(m);
  const double modulus = m.youngs_modulus * m.thickness;
  const std::size_t n = m.positions.size();
  std::vector<double> along(n, 0.0), down(n, 0.0), first(n, 0.0), second(n, 0.0);  // at each node's own corner
  for (int r = 0; r + 1 < m.rows; ++r)
    for (int c = 0; c + 1 < m.columns; ++c) {
      const SheetCell e = cell_at(m, c, r);
      const double kx = 0.375 * modulus * std::max(0.05, 3 * e.height / e.width - e.width / e.height);
      const double ky = 0.375 * modulus * std::max(0.05, 3 * e.width / e.height - e.height / e.width);
      const double kd = 0.1875 * modulus * e.diagonal2 / e.area;
      along[std::size_t(e.a)] += 0.5 * kx, along[std::size_t(e.c)] += 0.5 * kx;
      down[std::size_t(e.a)] += 0.5 * ky, down[std::size_t(e.b)] += 0.5 * ky;
      first[std::size_t(e.a)] = second[std::size_t(e.a)] = kd;
    }
  std::vector<NetSpring> out;
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.columns; ++c) {
      const int a = r * m.columns + c;
      const bool right = c + 1 < m.columns, below = r + 1 < m.rows;
      if (right) out.push_back({a, a + 1, along[std::size_t(a)]});
      if (below) out.push_back({a, a + m.columns, down[std::size_t(a)]});
      if (right && below) {
        out.push_back({a, a + m.columns + 1, first[std::size_t(a)]});
        out.push_back({a + 1, a + m.columns, second[std::size_t(a)]});
      }
    }
  return out;
}

constexpr double kLeastMass = 0.5;  // of a node, of the mean

/// What is enclosed goes along with the wall: its mass, shared out by area.
std::vector<double> contents_of(const MembraneDescription& m) {
  std::vector<double> share;
  if (m.enclosure.kind == Enclosure::none) return share;
  share.assign(m.positions.size(), 0.0);
  double whole = 0;
  for (std::size_t t = 0; t < m.triangles.size(); ++t) whole += area_of(m, t);
  const double mass = m.enclosure.density * geometry::volume({m.positions, m.triangles});
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (int i : m.triangles[t]) share[std::size_t(i)] += mass * area_of(m, t) / (3 * whole);
  return share;
}

}  // namespace

NetworkDescription network_of(const MembraneDescription& m) {
  NetworkDescription d;
  d.positions = m.positions;
  d.gravity = m.gravity;
  d.mass.assign(m.positions.size(), 0.0);
  d.fixed.assign(m.positions.size(), kFree);
  for (std::size_t i = 0; i < m.held.size(); ++i) d.fixed[i] = m.held[i] ? kHeld : kFree;
  for (int r = 0; r + 1 < m.rows; ++r)
    for (int c = 0; c + 1 < m.columns; ++c) {
      const SheetCell e = cell_at(m, c, r);
      for (int i : {e.a, e.b, e.c, e.d}) d.mass[std::size_t(i)] += 0.25 * m.density * m.thickness * e.area;
    }
  for (std::size_t t = 0; t < m.triangles.size(); ++t)
    for (int i : m.triangles[t]) d.mass[std::size_t(i)] += m.density * m.thickness * area_of(m, t) / 3;
  // Nodes of cells that are much smaller than the others would need steps of their own: they get half the mean mass.
  double mean = 0;
  for (double each : d.mass) mean += each / double(d.mass.size());
  for (double& each : d.mass) each = std::max(each, kLeastMass * mean);
  const std::vector<double> contents = contents_of(m);
  for (std::size_t i = 0; i < contents.size(); ++i) d.mass[i] += contents[i];
  for (const NetSpring& s : springs_of(m)) {
    SpringDescription e;
    e.a = s.a, e.b = s.b, e.k = s.k;
    e.rest_length = length(m.positions[std::size_t(s.b)] - m.positions[std::size_t(s.a)]);
    e.p1 = m.law.p1, e.p2 = m.law.p2, e.cap = m.law.cap;
    d.springs.push_back(e);
  }
  stiffen(d, m.stiffness);
  return d;
}

namespace {

std::vector<std::array<int, 3>> triangles_of(const MembraneDescription& m) {
  if (!m.triangles.empty()) return m.triangles;
  std::vector<std::array<int, 3>> t;
  for (int r = 0; r + 1 < m.rows; ++r)
    for (int c = 0; c + 1 < m.columns; ++c) {
      const int a = r * m.columns + c, b = a + 1, e = a + m.columns, f = e + 1;
      if ((r + c) % 2 == 0) {
        t.push_back({a, b, f});
        t.push_back({a, f, e});
      } else {
        t.push_back({a, b, e});
        t.push_back({b, f, e});
      }
    }
  return t;
}

void add_weight(BendStencil& s, int node, double w) {
  for (std::int32_t i = 0; i < s.count; ++i)
    if (s.node[std::size_t(i)] == node) {
      s.c[std::size_t(i)] += float(w);
      return;
    }
  s.node[std::size_t(s.count)] = node;
  s.c[std::size_t(s.count++)] = float(w);
}

/// Adds the second difference along three nodes of a grid line, which may lie at different distances.
void add_second_difference(const MembraneDescription& m, int before, int centre, int after, BendStencil& s) {
  const double a = length(m.positions[std::size_t(centre)] - m.positions[std::size_t(before)]);
  const double b = length(m.positions[std::size_t(after)] - m.positions[std::size_t(centre)]);
  add_weight(s, centre, -2 / (a * b));
  add_weight(s, before, 2 / ((a + b) * a));
  add_weight(s, after, 2 / ((a + b) * b));
}

/// Squares of the plate's energy at a node: both second differences where it lies inside; on a side only the one along
/// it, as stiff as a beam there is.
void add_node_bends(const MembraneDescription& m, int column, int row, double stiffness,
                    std::vector<BendStencil>& out) {
  constexpr double nu = kSheetPoisson;
  const int i = row * m.columns + column;
  const bool inner_column = column > 0 && column + 1 < m.columns, inner_row = row > 0 && row + 1 < m.rows;
  const double each = (inner_column && inner_row ? 1 - nu : 1 - nu * nu) * stiffness;
  BendStencil along, down, both;
  along.k = down.k = float(each);
  if (inner_column) add_second_difference(m, i - 1, i, i + 1, along);
  if (inner_row) add_second_difference(m, i - m.columns, i, i + m.columns, down);
  if (inner_column) out.push_back(along);
  if (inner_row) out.push_back(down);
  if (!inner_column || !inner_row) return;
  both.k = float(nu * stiffness);
  add_second_difference(m, i - 1, i, i + 1, both);
  add_second_difference(m, i - m.columns, i, i + m.columns, both);
  out.push_back(both);
}

BendStencil twist_of(const SheetCell& e, double stiffness) {
  BendStencil s;
  const double w = 1 / (e.width * e.height);
  add_weight(s, e.a, w);
  add_weight(s, e.b, -w);
  add_weight(s, e.c, -w);
  add_weight(s, e.d, w);
  s.k = float(2 * (1 - kSheetPoisson) * stiffness * e.area);
  return s;
}

/// D/2 times the square of the laplacian over an edge's two triangles. [Bergou et al. 06]
BendStencil hinge_of(const MembraneDescription& m, const Edge& e, double stiffness) {
  BendStencil s;
  const int c = e.facing[0], d = e.facing[1];
  const double ac = cotangent(m, e.a, e.b, c), ad = cotangent(m, e.a, e.b, d);
  const double bc = cotangent(m, e.b, e.a, c), bd = cotangent(m, e.b, e.a, d);
  const double area = area_of(m, std::size_t(e.triangle[0])) + area_of(m, std::size_t(e.triangle[1]));
  const double unit = 1 / area;  // weights in 1/m^2, as those of grids
  add_weight(s, e.a, unit * (bc + bd));
  add_weight(s, e.b, unit * (ac + ad));
  add_weight(s, c, -unit * (ac + bc));
  add_weight(s, d, -unit * (ad + bd));
  s.k = float(3 * stiffness * area);
  return s;
}

std::vector<BendStencil> grid_bends(const MembraneDescription& m, double stiffness) {
  std::vector<double> area(m.positions.size(), 0.0);
  std::vector<BendStencil> all;
  for (int r = 0; r + 1 < m.rows; ++r)
    for (int c = 0; c + 1 < m.columns; ++c) {
      const SheetCell e = cell_at(m, c, r);
      for (int i : {e.a, e.b, e.c, e.d}) area[std::size_t(i)] += 0.25 * e.area;
      all.push_back(twist_of(e, stiffness));
    }
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.columns; ++c) add_node_bends(m, c, r, stiffness * area[std::size_t(r * m.columns + c)], all);
  return all;
}

/// The triangles of a grid that a stencil bends: those of all cells between its nodes; along one line, the cells at
/// both of its sides.
std::vector<int> bent_cells(const MembraneDescription& m, const BendStencil& e) {
  int low_column = m.columns, high_column = 0, low_row = m.rows, high_row = 0;
  for (std::int32_t j = 0; j < e.count; ++j) {
    const int column = e.node[std::size_t(j)] % m.columns, row = e.node[std::size_t(j)] / m.columns;
    low_column = std::min(low_column, column), high_column = std::max(high_column, column);
    low_row = std::min(low_row, row), high_row = std::max(high_row, row);
  }
  if (low_row == high_row) --low_row, ++high_row;
  if (low_column == high_column) --low_column, ++high_column;
  std::vector<int> out;
  for (int r = low_row; r < high_row; ++r)
    for (int c = low_column; c < high_column; ++c) {
      if (r < 0 || c < 0 || r + 1 >= m.rows || c + 1 >= m.columns) continue;
      const int t = 2 * (r * (m.columns - 1) + c);
      out.push_back(t), out.push_back(t + 1);
    }
  return out;
}

/// As much stiffer as the tissue is at the middle of its nodes.
void stiffen_bend(const MembraneDescription& m, BendStencil& s) {
  if (!m.stiffness) return;
  Vec3d middle;
  for (std::int32_t k = 0; k < s.count; ++k) middle += m.positions[std::size_t(s.node[std::size_t(k)])];
  s.k = float(double(s.k) * m.stiffness(middle / double(s.count)));
}

/// Bending of what moves, and which triangles each of its squares belongs to.
void fill_bends(const MembraneDescription& d, MembraneModel& m) {
  std::vector<BendStencil> all;
  std::vector<std::vector<int>> bent;
  if (d.triangles.empty()) {
    all = grid_bends(d, m.bending_stiffness);
    for (const BendStencil& s : all) bent.push_back(bent_cells(d, s));
  } else {
    for (const Edge& e : edges_of(d)) {
      all.push_back(hinge_of(d, e, m.bending_stiffness));
      bent.push_back({e.triangle[0], e.triangle[1]});
    }
  }
  const auto is_held = [&d](int i) { return !d.held.empty() && d.held[std::size_t(i)]; };
  m.bend_first.assign(1, 0);
  for (std::size_t b = 0; b < all.size(); ++b) {
    bool moves = false;
    for (std::int32_t k = 0; k < all[b].count; ++k) moves = moves || !is_held(all[b].node[std::size_t(k)]);
    if (!moves) continue;
    stiffen_bend(d, all[b]);
    m.bends.push_back(all[b]);
    m.bend_triangle.insert(m.bend_triangle.end(), bent[b].begin(), bent[b].end());
    m.bend_first.push_back(int(m.bend_triangle.size()));
  }
}

/// Bound of each node's bending stiffness [N/m]: (sum c x)^2 <= (sum |c|) (sum |c| x^2), so the whole matrix lies below
/// this diagonal.
std::vector<double> bending_bound(const std::vector<BendStencil>& bends, std::size_t nodes) {
  std::vector<double> bound(nodes, 0.0);
  for (const BendStencil& s : bends) {
    double sum = 0;
    for (std::int32_t k = 0; k < s.count; ++k) sum += std::fabs(double(s.c[std::size_t(k)]));
    for (std::int32_t k = 0; k < s.count; ++k)
      bound[std::size_t(s.node[std::size_t(k)])] += double(s.k) * sum * std::fabs(double(s.c[std::size_t(k)]));
  }
  return bound;
}

/// Half the limit of bending alone: it is applied beside stretch.
constexpr double kBendSafety = 0.5;

void fill_steps(const MembraneDescription& d, const std::vector<double>& mass, double tick, MembraneModel& m) {
  std::vector<double> bound = bending_bound(m.bends, d.positions.size());
  for (const auto& t : d.triangles)  // the pressure turns with its triangles: |p| side / 6 from each, in pairs
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t j = 1; j < 3; ++j)
        bound[std::size_t(t[k])] += std::fabs(m.enclosure.pressure) / 3 *
                                    length(d.positions[std::size_t(t[(k + j) % 3])] - d.positions[std::size_t(t[k])]);
  double limit = 1e30;
  for (std::size_t i = 0; i < bound.size(); ++i) {
    if ((!d.held.empty() && d.held[i]) || !(bound[i] > 0)) continue;
    // K <= diag(bound) where dt_limit_node() asks for half of such a bound.
    limit = std::min(limit, dt_limit_node(mass[i], 0.5 * bound[i], 0.5 * d.bending_damping_time * bound[i]));
  }
  m.bend_limit = limit;
  m.bend_steps = substeps_for(tick, limit, kBendSafety);
  for (int i : m.held_nodes) m.border_bending.push_back(bound[std::size_t(i)]);
}

/// Impulses every dt drive a stretch mode of frequency w >= pi / dt by at most w_b^2 dt / 2 w a step (w_b: bending's
/// largest frequency), stretch damping takes t w^2 dt / 2 from it: more is taken than given from this time t on.
double least_damping_time(const MembraneModel& m, double tick) {
  const double dt = tick / m.bend_steps, pi3 = 31.0;
  return 4 * (4 / (m.bend_limit * m.bend_limit)) * dt * dt * dt / pi3;
}

void fill_border(const NetworkDescription& net, MembraneModel& m) {
  m.border_first.assign(1, 0);
  for (int i : m.held_nodes) {
    for (std::size_t s = 0; s < net.springs.size(); ++s) {
      const SpringDescription& e = net.springs[s];
      if (e.a != i && e.b != i) continue;
      const int other = e.a == i ? e.b : e.a;
      if (net.fixed[std::size_t(other)] == kHeld) continue;
      m.border_spring.push_back({std::int32_t(s), other, e.k * e.rest_length, e.rest_length, e.damping});
    }
    m.border_first.push_back(int(m.border_spring.size()));
  }
}

double kinetic(const MembraneModel& m, const MembraneState& s) {
  double sum = 0;
  for (int i = 0; i < m.nodes(); ++i) {
    const Vec3d v = velocity(m.network, s.network, i);
    sum += 0.5 * m.network.mass[std::size_t(i)] * dot(v, v);
  }
  return sum;
}

/// Largest change of a free node's velocity in a further tick, as a force [N].
double residual(const MembraneModel& m, const MembraneState& s) {
  MembraneState next = s;
  MembraneWork work = make_work(m);
  advance(m, {}, {}, {}, next, work);
  double worst = 0;
  for (int i = 0; i < m.nodes(); ++i) {
    const Vec3d v = velocity(m.network, next.network, i) - velocity(m.network, s.network, i);
    worst = std::max(worst, m.network.mass[std::size_t(i)] * length(v) / m.tick);
  }
  return worst;
}

double volume_of(const std::vector<Vec3d>& positions, const MembraneModel& m) {
  return m.enclosure.kind == Enclosure::none ? 0 : geometry::volume({positions, m.triangles});
}

/// That the pressure has at a node, on the average [m^2].
double area_of_node(const std::vector<Vec3d>& positions, const MembraneModel& m) {
  return m.enclosure.kind == Enclosure::none ? 0 : geometry::area({positions, m.triangles}) / double(positions.size());
}

/// By how much the pressure alone would widen the drawn volume in a step: at rest all else takes it back [m^3].
double swell_of_a_step(const MembraneModel& m) {
  if (m.enclosure.kind == Enclosure::none) return 0;
  std::vector<Vec3d> gradient(m.network.rest.size());
  enclosed_volume(m.triangles, m.network.rest, gradient);
  const double dt = m.tick / m.bend_steps;
  double give = 0;
  for (std::size_t i = 0; i < gradient.size(); ++i)
    if (m.network.fixed[i] != kHeld) give += dot(gradient[i], gradient[i]) / m.network.mass[i];
  return dt * dt * give * m.enclosure.pressure;
}

constexpr int kSettleTicks = 3000;

/// Lets the sheet swing and stops it whenever it slows down by itself (dynamic relaxation with kinetic damping
/// [Cundall 76]), until it is in equilibrium.
void settle(double tick, NetworkDescription& net, MembraneModel& m) {
  const Enclosure::Kind kind = m.enclosure.kind;
  if (kind != Enclosure::none) m.enclosure.kind = Enclosure::constant;  // the volume is what it will be
  m.enclosure.volume = volume_of(net.positions, m);
  MembraneState s = rest_state(m);
  MembraneWork w = make_work(m);
  double before = 0, weight = 0;
  for (std::size_t i = 0; i < net.mass.size(); ++i) weight = std::max(weight, net.mass[i] * length(net.gravity));
  weight = std::max(weight, std::fabs(m.enclosure.pressure) * area_of_node(net.positions, m));
  for (int t = 0; t < kSettleTicks; ++t) {
    if (!advance(m, {}, {}, {}, s, w).fine()) refuse_membrane("a sheet that is in equilibrium");
    const double now = kinetic(m, s);
    const bool slower = now < before;
    before = slower ? 0 : now;
    if (!slower) continue;
    for (int i = 0; i < m.nodes(); ++i) set_velocity(m.network, s.network, i, {});
    if (t % 8 == 7 && residual(m, s) < 5e-3 * weight) break;
  }
  for (int i = 0; i < m.nodes(); ++i) set_velocity(m.network, s.network, i, {});
  m.settled_residual = residual(m, s);
  for (std::size_t i = 0; i < net.positions.size(); ++i)
    if (net.fixed[i] != kHeld) net.positions[i] = position(m.network, s.network, int(i));
  m.network = build(net, tick / m.bend_steps);
  m.enclosure.kind = kind;
}

/// @param hung  where its nodes are as it hangs; empty: as described, or let hang here
MembraneModel build_at(const MembraneDescription& d, double tick, std::span<const Vec3d> hung) {
  check(d, tick);
  NetworkDescription net = network_of(d);
  MembraneModel m;
  m.columns = d.columns;
  m.rows = d.rows;
  m.law = d.law;
  m.tick = tick;
  m.thickness = d.thickness;
  m.bending_stiffness =
      d.youngs_modulus * d.thickness * d.thickness * d.thickness / (12 * (1 - kSheetPoisson * kSheetPoisson));
  m.bending_damping_time = d.bending_damping_time;
  m.gamma = d.global_damping;
  m.triangles = triangles_of(d);
  fill_bends(d, m);
  m.enclosure = d.enclosure;
  m.contents = contents_of(d);
  for (std::size_t i = 0; i < d.held.size(); ++i)
    if (d.held[i]) m.held_nodes.push_back(int(i));
  fill_steps(d, net.mass, tick, m);
  const double damping = std::max(d.damping_time, least_damping_time(m, tick));
  for (SpringDescription& e : net.springs) e.damping = e.k * damping;
  fill_border(net, m);
  m.network = build(net, tick / m.bend_steps);
  if (double(m.bend_steps) * m.network.substeps > kMostSubsteps)
    refuse_membrane("at most " + std::to_string(kMostSubsteps) +
                    " sub-steps a tick, which a wider spacing or a softer tissue needs");
  const bool loaded = dot(d.gravity, d.gravity) > 0 || m.enclosure.pressure != 0;
  if (!hung.empty()) {
    net.positions.assign(hung.begin(), hung.end());
    m.network = build(net, tick / m.bend_steps);
  } else if (d.settle && loaded && !m.held_nodes.empty()) {
    settle(tick, net, m);
  }
  m.enclosure.volume = volume_of(m.network.rest, m);
  m.first_swell = swell_of_a_step(m);
  return m;
}

}  // namespace

MembraneModel build(const MembraneDescription& description, double tick) { return build_at(description, tick, {}); }

TiedMembrane build_tied(const MembraneDescription& description, std::span<const std::uint8_t> tied, double tick) {
  MembraneDescription all_held = description;
  all_held.held.resize(description.positions.size(), 0);
  for (std::size_t i = 0; i < tied.size(); ++i) all_held.held[i] |= tied[i];
  const MembraneModel hung = build(all_held, tick);
  MembraneWork work = make_work(hung);
  std::vector<BorderPull> pulls(hung.held_nodes.size());
  border_pulls(hung, rest_state(hung), work, pulls);

  TiedMembrane out;
  for (std::size_t h = 0; h < pulls.size(); ++h) {
    const std::size_t node = std::size_t(hung.held_nodes[h]);
    if (!tied[node]) continue;
    // Of what is enclosed the nodes have the inertia; its weight is in the border's pull.
    const double own = hung.network.mass[node] - (hung.contents.empty() ? 0 : hung.contents[node]);
    out.pull.push_back(pulls[h].force + own * description.gravity);
  }
  out.model = build_at(description, tick, hung.network.rest);
  out.model.settled_residual = hung.settled_residual;
  return out;
}

MembraneState rest_state(const MembraneModel& m) {
  MembraneState s;
  s.network = rest_state(m.network);
  s.torn.assign(m.bends.size(), 0);
  s.enclosure.pressure = m.enclosure.kind == Enclosure::none ? 0 : m.enclosure.pressure;
  s.enclosure.volume = m.enclosure.volume;
  s.enclosure.expected = m.enclosure.volume + m.first_swell;
  return s;
}

MembraneWork make_work(const MembraneModel& m, std::size_t loads) {
  MembraneWork w;
  w.network = make_work(m.network);
  w.force.resize(m.network.node_of_row.size());
  w.reaction.resize(loads);
  const std::size_t inside = m.enclosure.kind == Enclosure::none ? 0 : std::size_t(m.nodes());
  w.place.resize(inside), w.gradient.resize(inside), w.weight.resize(inside);
  return w;
}

}  // namespace trocar::tissue
