// Compiling a body that can be cut.
#include <algorithm>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/tissue/network/stability.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {
namespace {

constexpr int kMostSpringsOfNode = 150;  // leaves room for those that cuts double

[[noreturn]] void refuse_cuttable(const std::string& what) {
  throw std::invalid_argument("cuttable body: expected " + what);
}

double volume(const CuttableDescription& d, int cell) {
  const geometry::Tet& c = d.cells[std::size_t(cell)];
  const auto x = [&](int i) { return d.points[std::size_t(c[std::size_t(i)])]; };
  return geometry::volume6(x(0), x(1), x(2), x(3)) / 6;
}

/// The spring along an edge, in the sorted first part of the list.
int edge_spring(const TetNetwork& t, int a, int b) {
  const auto end = t.network.springs.begin() + t.edge_springs;
  const std::array<int, 2> key{std::min(a, b), std::max(a, b)};
  const auto found =
      std::lower_bound(t.network.springs.begin(), end, key,
                       [](const SpringDescription& s, const auto& k) { return s.a != k[0] ? s.a < k[0] : s.b < k[1]; });
  return int(found - t.network.springs.begin());
}

struct Carried {
  float share, ratio;
};

/// Every cell gets its part, by volume, of the springs that it has an edge or a face of.
void share_out(const CuttableDescription& d, const TetNetwork& t, CuttableModel& m) {
  const auto drawn_length = [&](const SpringDescription& s) {
    return length(d.points[std::size_t(s.b)] - d.points[std::size_t(s.a)]);
  };
  const auto carried = [&](const SpringDescription& s, double part) {
    const double l = drawn_length(s);
    return Carried{float(part * s.k * l * l), float(s.rest_length / l)};
  };
  std::vector<double> around(std::size_t(t.edge_springs), 0.0);
  for (std::size_t c = 0; c < d.cells.size(); ++c)
    for (const auto& e : kCellEdges)
      around[std::size_t(edge_spring(t, d.cells[c][std::size_t(e[0])], d.cells[c][std::size_t(e[1])]))] +=
          volume(d, int(c));
  m.brings.resize(d.cells.size());
  for (std::size_t c = 0; c < d.cells.size(); ++c) {
    CellSprings& brings = m.brings[c];
    for (int e = 0; e < 6; ++e) {
      const int s =
          edge_spring(t, d.cells[c][std::size_t(kCellEdges[e][0])], d.cells[c][std::size_t(kCellEdges[e][1])]);
      const Carried x = carried(t.network.springs[std::size_t(s)], volume(d, int(c)) / around[std::size_t(s)]);
      brings.edge[e] = x.share, brings.edge_ratio[e] = x.ratio;
    }
    for (int f = 0; f < 4; ++f) brings.cross[f] = 0, brings.cross_ratio[f] = 1;
  }
  for (std::size_t i = 0; i < t.cells_of_cross_spring.size(); ++i) {
    const std::array<int, 2>& pair = t.cells_of_cross_spring[i];
    const SpringDescription& s = t.network.springs[std::size_t(t.edge_springs) + i];
    for (int which = 0; which < 2; ++which) {
      const geometry::Tet& across = m.drawn.across[std::size_t(pair[std::size_t(which)])];
      const auto face = std::find(across.begin(), across.end(), pair[std::size_t(1 - which)]) - across.begin();
      const Carried x = carried(s, 0.5);
      m.brings[std::size_t(pair[std::size_t(which)])].cross[face] = x.share;
      m.brings[std::size_t(pair[std::size_t(which)])].cross_ratio[face] = x.ratio;
    }
  }
}

void place_rows(const NetworkModel& n, int spare, CuttableModel& m) {
  m.own_nodes = n.nodes;
  m.own_rows = n.rows;
  m.rows = (n.rows + spare + kSlice - 1) / kSlice * kSlice;
  m.row_of_node = n.row_of_node;
  for (int i = 0; i < spare; ++i) m.row_of_node.push_back(n.rows + i);
  // A node beside a cut may keep both a neighbour and its double; spare rows are as wide as the widest.
  std::vector<int> springs(std::size_t(n.rows), 0), width(std::size_t(n.rows / kSlice), 0);
  for (const int node : n.spring_nodes) {
    const int row = n.row_of_node[std::size_t(node)];
    int& slice = width[std::size_t(row / kSlice)];
    slice = std::max(slice, ++springs[std::size_t(row)]);
  }
  int columns = 0;
  for (const int w : width) columns += w, m.widest = std::max(m.widest, w);
  m.packs = columns + columns / 2 + m.rows / kSlice * kFreeColumns + ((m.rows - m.own_rows) / kSlice + 1) * m.widest;
}

}  // namespace

CuttableModel build(const CuttableDescription& d, double tick) {
  if (d.spare_nodes < 0 || d.spare_nodes > 1'000'000) refuse_cuttable("0 to 1,000,000 spare nodes");
  if (!d.fixed.empty() && d.fixed.size() != d.points.size()) refuse_cuttable("fixed flags for every point, or none");
  TetNetwork t = tet_network(d.points, d.cells, d.material, d.fibres);
  stiffen(t.network, d.stiffness);
  t.network.gravity = d.gravity;
  t.network.global_damping = d.global_damping;
  if (!d.fixed.empty()) t.network.fixed = d.fixed;

  std::vector<int> springs_at(d.points.size(), 0);
  for (const SpringDescription& s : t.network.springs)
    for (const int node : {s.a, s.b})
      if (++springs_at[std::size_t(node)] > kMostSpringsOfNode)
        refuse_cuttable("at most " + std::to_string(kMostSpringsOfNode) + " springs at node " + std::to_string(node) +
                        ", got more");

  CuttableModel m;
  m.drawn = geometry::cuttable(d.points, d.cells, d.spare_nodes);
  m.anchors = d.anchors;
  const bool held =
      !m.anchors.empty() || std::any_of(d.fixed.begin(), d.fixed.end(), [](auto f) { return f != kFree; });
  if (held && dot(d.gravity, d.gravity) > 0) {
    const PrestressReport report = prestress(t.network, m.anchors);
    if (!report.converged || report.failed_springs > 0)
      refuse_cuttable("a body that its supports can hold against gravity");
    m.residual = report.residual;
  }
  share_out(d, t, m);

  const NetworkModel n = build(t.network, tick);
  m.fixed = n.fixed;
  m.fixed.resize(m.drawn.rest.size(), kFree);
  place_rows(n, d.spare_nodes, m);
  m.origin = n.origin;
  m.gravity = d.gravity;
  m.density = d.material.density;
  m.damping_time = d.material.damping_time;
  m.gamma = d.global_damping;
  m.p1 = n.p1, m.p2 = n.p2, m.cap = n.cap, m.cap_slope = n.cap_slope;
  m.bulk = n.bulk;
  m.tick = tick;
  m.dt = n.dt;
  m.dt_limit = n.dt_limit;
  m.opening = n.opening;
  m.substeps = n.substeps;
  m.misfit = t.misfit;
  return m;
}

CuttableState rest_state(const CuttableModel& m) {
  CuttableState s;
  s.tets = m.drawn;
  s.nodes.resize(std::size_t(m.rows));
  s.tet_phase.assign(m.drawn.cells.size(), 0);
  for (int i = 0; i < m.own_nodes; ++i) set_position(m, s, i, m.drawn.rest[std::size_t(i)]);
  return s;
}

namespace {

/// Cuts share a node's cells out between it and its doubles: no slice grows, and one of doubles is no wider than the
/// widest.
void make_room_for_volumes(const CuttableModel& m, CuttableWork& w) {
  const std::size_t cells = m.drawn.cells.size(), rows = std::size_t(m.rows), own = std::size_t(m.own_rows);
  for (std::size_t t = 0; t < cells; ++t)
    for (std::size_t i = 0; i < 4; ++i) w.guarded[t].row[i] = m.row_of_node[std::size_t(m.drawn.cells[t][i])];
  const ColumnCount columns = columns_of(w.guarded, own);
  w.volume_cells.resize(cells, rows, columns.all + (rows - own) / kSlice * columns.widest);
  w.volume.resize(cells, rows);
}

}  // namespace

CuttableWork make_work(const CuttableModel& m) {
  CuttableWork w;
  const std::size_t nodes = m.drawn.rest.size();
  w.other.resize(std::size_t(m.rows));
  w.packs.resize(std::size_t(m.packs));
  w.row_packs.resize(std::size_t(m.rows / kSlice));
  w.slice_begin.resize(std::size_t(m.rows / kSlice) + 1);
  w.slice_end.resize(std::size_t(m.rows / kSlice));
  w.mass.resize(nodes);
  w.bearable.resize(nodes);
  w.changed.resize(nodes);
  w.fixed.resize(nodes);
  w.begin.resize(nodes + 1);
  w.around.resize(4 * m.drawn.cells.size());
  w.node_of_row.resize(std::size_t(m.rows));
  w.now.resize(nodes);
  w.part.resize(nodes);
  w.guarded.resize(m.drawn.cells.size());
  w.guarded_packs.assign((m.drawn.cells.size() + kSlice - 1) / kSlice, empty_pack());
  w.open_tets.resize(m.drawn.cells.size());
  w.folded.resize(std::size_t(m.rows));
  w.below.resize(w.guarded_packs.size());
  w.loaded.resize(nodes);
  if (m.bulk.impulses > 0) make_room_for_volumes(m, w);
  w.cut = geometry::make_work(m.drawn);
  w.scars.inertia.resize(nodes);
  w.scars.nodes.resize(nodes);
  return w;
}

}  // namespace trocar::tissue
