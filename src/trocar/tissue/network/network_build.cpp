// Compiling a network: node order, slices, half-edges, the time step.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/tissue/base/law.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/stability.hpp>

namespace trocar::tissue {
namespace {

constexpr std::size_t kWindow = 256;  // rows sorted by degree within such windows, so that slices pad little

[[noreturn]] void refuse(const std::string& what, std::size_t index, const std::string& expected) {
  throw std::invalid_argument("network: " + what + " " + std::to_string(index) + ": expected " + expected);
}

void check(const NetworkDescription& d, double tick) {
  const std::size_t n = d.positions.size();
  const auto inside = [n](int i) { return i >= 0 && std::size_t(i) < n; };
  if (n == 0 || n > std::size_t(1) << 26) refuse("nodes", n, "1 to 2^26");
  if (d.mass.size() != n) refuse("masses", d.mass.size(), "as many as nodes");
  if (!d.fixed.empty() && d.fixed.size() != n) refuse("fixed flags", d.fixed.size(), "none, or as many as nodes");
  if (!(tick > 0)) refuse("tick", 0, "> 0 s");
  if (!(d.global_damping >= 0)) refuse("global damping", 0, ">= 0");
  if (!(d.max_stiffness_scale >= 1)) refuse("max_stiffness_scale", 0, ">= 1");
  for (std::size_t i = 0; i < n; ++i) {
    if (!(d.mass[i] > 0 && d.mass[i] < 1e12)) refuse("mass of node", i, "> 0 kg");
    const Vec3d p = d.positions[i];
    if (!(std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) < 1e5)) refuse("position of node", i, "finite");
  }
  for (std::size_t s = 0; s < d.springs.size(); ++s) {
    const SpringDescription& e = d.springs[s];
    if (!inside(e.a) || !inside(e.b) || e.a == e.b) refuse("spring", s, "two different nodes that exist");
    if (!(e.rest_length > 0 && e.rest_length < 1e5)) refuse("rest length of spring", s, "> 0 m");
    if (!(e.k >= 0 && e.damping >= 0 && e.k < 1e15 && e.damping < 1e15)) refuse("spring", s, "k, damping >= 0");
    if (!SpringLaw{e.p1, e.p2, e.cap}.monotone())
      refuse("law of spring", s, "cap > 0 and P1^2 < 3 P2 or P1, P2 >= 0 (force grows)");
  }
  for (std::size_t t = 0; t < d.tets.size(); ++t) {
    const auto& c = d.tets[t];
    if (!inside(c[0]) || !inside(c[1]) || !inside(c[2]) || !inside(c[3])) refuse("cell", t, "nodes that exist");
    const auto& x = d.positions;
    if (!(geometry::volume6(x[c[0]], x[c[1]], x[c[2]], x[c[3]]) > 0)) refuse("cell", t, "positive volume");
  }
}

struct Adjacency {
  std::vector<int> begin;          // (n + 1)
  std::vector<int> spring, other;  // per half-edge
  int degree(int i) const { return begin[i + 1] - begin[i]; }
};

Adjacency adjacency_of(const NetworkDescription& d) {
  const int n = int(d.positions.size());
  Adjacency a;
  a.begin.assign(n + 1, 0);
  for (const auto& e : d.springs) ++a.begin[e.a + 1], ++a.begin[e.b + 1];
  std::partial_sum(a.begin.begin(), a.begin.end(), a.begin.begin());
  a.spring.resize(2 * d.springs.size());
  a.other.resize(2 * d.springs.size());
  std::vector<int> next(a.begin.begin(), a.begin.end() - 1);
  for (int s = 0; s < int(d.springs.size()); ++s) {
    const auto& e = d.springs[s];
    a.spring[next[e.a]] = s, a.other[next[e.a]++] = e.b;
    a.spring[next[e.b]] = s, a.other[next[e.b]++] = e.a;
  }
  return a;
}

/// Breadth-first order from `start`, each node's neighbours by (degree, number); appended to `order`.
void sweep(const Adjacency& a, int start, std::vector<int>& mark, int stamp, std::vector<int>& order) {
  const std::size_t first = order.size();
  order.push_back(start);
  mark[start] = stamp;
  for (std::size_t head = first; head < order.size(); ++head) {
    const int i = order[head];
    const std::size_t begin = order.size();
    for (int h = a.begin[i]; h < a.begin[i + 1]; ++h) {
      if (mark[a.other[h]] == stamp) continue;
      mark[a.other[h]] = stamp;
      order.push_back(a.other[h]);
    }
    std::sort(order.begin() + std::ptrdiff_t(begin), order.end(),
              [&](int p, int q) { return a.degree(p) != a.degree(q) ? a.degree(p) < a.degree(q) : p < q; });
  }
}

/// Reverse Cuthill-McKee order: node of each row. The last node of a sweep is far out, a good start for the next.
std::vector<int> cuthill_mckee(const Adjacency& a, int n) {
  std::vector<int> order, trial, mark(n, -1);
  std::vector<bool> done(n, false);
  int stamp = 0;
  for (int seed = 0; seed < n; ++seed) {
    if (done[seed]) continue;
    int start = seed;
    for (int pass = 0; pass < 3; ++pass) {
      trial.clear();
      sweep(a, start, mark, stamp++, trial);
      start = trial.back();
    }
    const std::size_t first = order.size();
    sweep(a, start, mark, stamp++, order);
    for (std::size_t i = first; i < order.size(); ++i) done[order[i]] = true;
  }
  std::reverse(order.begin(), order.end());
  return order;
}

/// Layer by layer along one axis, within a layer along the next.
std::vector<int> layers(const NetworkDescription& d, int axis) {
  std::vector<int> order(d.positions.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int p, int q) {
    const Vec3d a = d.positions[p], b = d.positions[q];
    for (int i = 0; i < 3; ++i) {
      const int k = (axis + i) % 3;
      if (a[k] != b[k]) return a[k] < b[k];
    }
    return false;
  });
  return order;
}

/// The farthest that a spring's ends are apart in an order.
int bandwidth(const NetworkDescription& d, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (int r = 0; r < int(order.size()); ++r) place[order[r]] = r;
  int widest = 0;
  for (const auto& e : d.springs) widest = std::max(widest, std::abs(place[e.a] - place[e.b]));
  return widest;
}

/// Which end evaluates each spring, so that every node has half of its springs, give or take one: springs are walked
/// until none is left, each node being left as often as it is come to, but for where a walk begins and ends. Walks that
/// must end elsewhere than they began go first.
struct Sources {
  std::vector<int> source;   // (springs) node
  std::vector<int> out, in;  // (nodes) springs evaluated here, and there
};
Sources sources_of(const NetworkDescription& d, const Adjacency& a) {
  const int n = int(d.positions.size());
  Sources s{std::vector<int>(d.springs.size(), -1), std::vector<int>(n), std::vector<int>(n)};
  std::vector<int> next(a.begin.begin(), a.begin.end() - 1);
  const auto walk_from = [&](int node) {
    for (;;) {
      while (next[node] < a.begin[node + 1] && s.source[a.spring[next[node]]] >= 0) ++next[node];
      if (next[node] == a.begin[node + 1]) return;
      s.source[a.spring[next[node]]] = node;
      ++s.out[node];
      node = a.other[next[node]];
      ++s.in[node];
    }
  };
  for (int i = 0; i < n; ++i)
    if ((a.degree(i) - s.out[i] - s.in[i]) % 2 != 0) walk_from(i);
  for (int i = 0; i < n; ++i) walk_from(i);
  return s;
}

/// Within windows, so that slices pad little: nodes with many springs first.
std::vector<int> sorted_in_windows(std::vector<int> order, const Sources& s) {
  for (std::size_t w = 0; w < order.size(); w += kWindow) {
    std::stable_sort(order.begin() + std::ptrdiff_t(w),
                     order.begin() + std::ptrdiff_t(std::min(w + kWindow, order.size())),
                     [&](int p, int q) { return s.out[p] != s.out[q] ? s.out[p] > s.out[q] : s.in[p] > s.in[q]; });
  }
  return order;
}

/// Nodes in the order in which springs reach least far: what a slice needs is then still in the cache. Blocks whose
/// cells have diagonals have wider fronts than layers, most bodies the other way round.
std::vector<int> near_order(const NetworkDescription& d, const Adjacency& a, const Sources& s) {
  std::vector<int> best = sorted_in_windows(cuthill_mckee(a, int(d.positions.size())), s);
  int least = bandwidth(d, best);
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<int> order = sorted_in_windows(layers(d, axis), s);
    const int reach = bandwidth(d, order);
    if (reach < least) least = reach, best = std::move(order);
  }
  return best;
}

void order_rows(NetworkModel& m, const NetworkDescription& d, const Adjacency& a, const Sources& s) {
  m.rows = (m.nodes + kSlice - 1) / kSlice * kSlice;
  m.node_of_row = near_order(d, a, s);
  m.node_of_row.resize(m.rows, -1);
  m.row_of_node.resize(m.nodes);
  for (int r = 0; r < m.nodes; ++r) m.row_of_node[m.node_of_row[r]] = r;
}

bool one_law(const NetworkDescription& d) {
  return std::all_of(d.springs.begin(), d.springs.end(), [&](const SpringDescription& e) {
    const auto& f = d.springs.front();
    return e.p1 == f.p1 && e.p2 == f.p2 && e.cap == f.cap;
  });
}

void fill_place(NetworkModel& m, const SpringDescription& e, int other, int place) {
  const int lane = place % kSlice;
  HalfEdgePack& p = m.packs[place / kSlice];
  p.offset[lane] = std::uint32_t(m.row_of_node[other]) * std::uint32_t(sizeof(NodeState));
  p.inv_rest[lane] = float(1 / e.rest_length);
  p.stiffness[lane] = float(e.k * e.rest_length);
  p.damping[lane] = float(e.damping);
  if (m.law_packs.empty()) return;
  LawPack& l = m.law_packs[place / kSlice];
  l.p1[lane] = float(e.p1), l.p2[lane] = float(e.p2), l.cap[lane] = float(e.cap);
  l.cap_slope[lane] = float(SpringLaw{e.p1, e.p2, e.cap}.cap_slope());
}

/// Columns of a slice's rows that hold no spring.
void pad(NetworkModel& m, int slice, int first, bool one_law) {
  for (int c = first; c < int(m.packs.size()); ++c) {
    m.packs[c] = {};
    for (int lane = 0; lane < kSlice; ++lane)
      m.packs[c].offset[lane] = std::uint32_t(slice * kSlice + lane) * std::uint32_t(sizeof(NodeState));
  }
  for (int c = first; c < int(m.packs.size()) && !one_law; ++c)
    for (int lane = 0; lane < kSlice; ++lane) m.law_packs[c].cap[lane] = m.law_packs[c].cap_slope[lane] = 1;
}

/// The springs at a node of which it is the source, or is not, as (row of the other end, spring), ascending.
std::vector<std::pair<int, int>> springs_at(const NetworkModel& m, const Adjacency& a, const Sources& s, int node,
                                            bool source) {
  std::vector<std::pair<int, int>> near;
  if (node < 0) return near;  // a row that pads its slice
  for (int h = a.begin[node]; h < a.begin[node + 1]; ++h)
    if ((s.source[a.spring[h]] == node) == source) near.emplace_back(m.row_of_node[a.other[h]], a.spring[h]);
  std::sort(near.begin(), near.end());
  return near;
}

void fill_packs(NetworkModel& m, const NetworkDescription& d, const Adjacency& a, const Sources& sources) {
  const bool single = one_law(d);
  if (!d.springs.empty()) {
    const auto& e = d.springs.front();
    m.p1 = float(e.p1), m.p2 = float(e.p2), m.cap = float(e.cap);
    m.cap_slope = float(SpringLaw{e.p1, e.p2, e.cap}.cap_slope());
  }
  m.place.assign(d.springs.size(), -1);
  m.slice_begin.assign(1, 0);
  for (int s = 0; s < m.rows / kSlice; ++s) {
    int width = 0;
    for (int lane = 0; lane < kSlice; ++lane) {
      const int node = m.node_of_row[s * kSlice + lane];
      if (node >= 0) width = std::max(width, sources.out[node]);
    }
    const int first = int(m.packs.size());
    m.packs.resize(first + width);
    if (!single) m.law_packs.resize(first + width);
    pad(m, s, first, single);
    for (int lane = 0; lane < kSlice; ++lane) {
      int place = first * kSlice + lane;
      for (const auto& [row, spring] : springs_at(m, a, sources, m.node_of_row[s * kSlice + lane], true)) {
        fill_place(m, d.springs[spring], m.node_of_row[row], place);
        m.place[spring] = place;
        place += kSlice;
      }
    }
    m.slice_begin.push_back(int(m.packs.size()));
  }
}

/// How far apart the slices of a spring's ends are at most, and how many columns may be under way then.
void find_lag(NetworkModel& m, const NetworkDescription& d) {
  const int slices = m.rows / kSlice;
  for (const auto& e : d.springs)
    m.lag = std::max(m.lag, std::abs(m.row_of_node[e.a] / kSlice - m.row_of_node[e.b] / kSlice));
  for (int s = 0; s < slices; ++s) {
    const int oldest = m.slice_begin[std::max(s - m.lag, 0)], newest = m.slice_begin[std::min(s + m.lag + 1, slices)];
    m.ring = std::max(m.ring, newest - oldest);
  }
}

void fill_arrivals(NetworkModel& m, const Adjacency& a, const Sources& sources) {
  m.arrival_begin.assign(1, 0);
  for (int s = 0; s < m.rows / kSlice; ++s) {
    const std::size_t first = m.arrivals.size();
    for (int lane = 0; lane < kSlice; ++lane) {
      std::size_t pack = first;
      for (const auto& [row, spring] : springs_at(m, a, sources, m.node_of_row[s * kSlice + lane], false)) {
        if (pack == m.arrivals.size()) m.arrivals.push_back({});
        const int column = m.place[spring] / kSlice, slot = kSlotOfLane[m.place[spring] % kSlice];
        m.arrivals[pack++].offset[lane] =
            std::uint32_t((1 + column % m.ring) * kSlice + slot) * std::uint32_t(sizeof(ForcePack) / kSlice);
      }
    }
    m.arrival_begin.push_back(int(m.arrivals.size()));
  }
}

/// Sufficient limit from every node's own stiffness and damping block, springs at the slope of their strain cap.
double stability_limit(const NetworkDescription& d) {
  struct Block {
    double k[6] = {}, c[6] = {};
  };
  std::vector<Block> blocks(d.positions.size());
  for (const auto& e : d.springs) {
    const Vec3d n = normalised(d.positions[e.b] - d.positions[e.a]);
    const double k = e.k * SpringLaw{e.p1, e.p2, e.cap}.max_slope() * d.max_stiffness_scale;
    const double c = e.damping * d.max_stiffness_scale;
    const double nn[6] = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
    for (int end : {e.a, e.b})
      for (int i = 0; i < 6; ++i) blocks[end].k[i] += k * nn[i], blocks[end].c[i] += c * nn[i];
  }
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    if (!d.fixed.empty() && d.fixed[i] == kHeld) continue;
    const double* k = blocks[i].k;
    const double* c = blocks[i].c;
    const double k_max = largest_eigenvalue(k[0], k[1], k[2], k[3], k[4], k[5]);
    const double c_max = largest_eigenvalue(c[0], c[1], c[2], c[3], c[4], c[5]);
    limit = std::min(limit, dt_limit_node(d.mass[i], k_max, c_max));
  }
  return limit;
}

void fill_rows(NetworkModel& m) {
  m.row_packs.resize(m.rows / kSlice);
  for (int r = 0; r < m.rows; ++r) {
    RowPack& p = m.row_packs[r / kSlice];
    const int lane = r % kSlice, node = m.node_of_row[r];
    const double w = node < 0 ? 0 : m.dt / (m.mass[node] * (1 + m.dt * m.gamma));
    const int held = node < 0 ? int(kHeld) : m.fixed[node];
    p.wx[lane] = held & kHeldX ? 0.0f : float(w);
    p.wy[lane] = held & kHeldY ? 0.0f : float(w);
    p.wz[lane] = held & kHeldZ ? 0.0f : float(w);
  }
}

void fill_tets(NetworkModel& m, const NetworkDescription& d) {
  const int n = int(d.tets.size());
  m.tet_packs.assign((n + kSlice - 1) / kSlice, empty_pack());
  m.tet_begin.assign(m.nodes + 1, 0);
  for (int t = 0; t < n; ++t) {
    const auto& c = d.tets[t];
    const double six = geometry::volume6(d.positions[c[0]], d.positions[c[1]], d.positions[c[2]], d.positions[c[3]]);
    TetRest rest{};
    rest.rest6 = float(six);
    for (int i = 0; i < 4; ++i) {
      rest.row[i] = m.row_of_node[c[i]];
      ++m.tet_begin[c[i] + 1];
    }
    put_cell(rest, kCollapsed * six, t % kSlice, m.tet_packs[t / kSlice]);
    m.tets.push_back(rest);
  }
  std::partial_sum(m.tet_begin.begin(), m.tet_begin.end(), m.tet_begin.begin());
  m.tet_of_node.resize(4 * d.tets.size());
  std::vector<int> next(m.tet_begin.begin(), m.tet_begin.end() - 1);
  for (int t = 0; t < n; ++t)
    for (int node : d.tets[t]) m.tet_of_node[next[node]++] = t;
}

/// Whole sub-steps between two impulses.
void add_volume_force(NetworkModel& m, double kappa) {
  std::vector<double> mass(m.rows, 0.0);
  for (int i = 0; i < m.nodes; ++i) mass[m.row_of_node[i]] = m.mass[i];
  m.bulk = bulk_of(m.tets, rest_state(m).nodes, mass, kappa, m.tick);
  const int n = m.bulk.impulses;
  if (n > 0) m.substeps = (m.substeps + n - 1) / n * n;
}

}  // namespace

NetworkModel build(const NetworkDescription& d, double tick) {
  check(d, tick);
  NetworkModel m;
  m.nodes = int(d.positions.size());
  m.springs = int(d.springs.size());
  m.rest = d.positions;
  m.mass = d.mass;
  m.fixed = d.fixed.empty() ? std::vector<std::uint8_t>(m.nodes, kFree) : d.fixed;
  Vec3d low = d.positions[0], high = low;
  for (const Vec3d& p : d.positions)
    for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  m.origin = (low + high) * 0.5;

  const Adjacency a = adjacency_of(d);
  const Sources sources = sources_of(d, a);
  order_rows(m, d, a, sources);
  fill_packs(m, d, a, sources);
  find_lag(m, d);
  fill_arrivals(m, a, sources);
  for (const auto& e : d.springs) {
    m.spring_nodes.push_back(e.a);
    m.spring_nodes.push_back(e.b);
    m.spring_rest.push_back(float(e.rest_length));
  }

  m.tick = tick;
  m.dt_limit = stability_limit(d);
  m.substeps = substeps_for(tick, m.dt_limit);
  fill_tets(m, d);
  add_volume_force(m, d.kappa);
  m.dt = tick / m.substeps;
  m.gamma = d.global_damping;
  m.gravity = d.gravity;
  m.max_scale = float(d.max_stiffness_scale);
  m.opening = std::max(kOpeningTime, float(d.opening_time));
  const double decay = 1 / (1 + m.dt * m.gamma);
  m.decay = float(decay);
  for (int i = 0; i < 3; ++i) m.gravity_step[i] = float(m.dt * d.gravity[i] * decay);
  fill_rows(m);
  if (m.bulk.impulses > 0) {
    m.volume_cells.resize(m.tets.size(), std::size_t(m.rows), columns_of(m.tets, std::size_t(m.rows)).all);
    note_volumes(m.tets, m.bulk, m.row_packs, m.dt, m.volume_cells);
  }
  return m;
}

NetworkState rest_state(const NetworkModel& m) {
  NetworkState s;
  s.nodes.resize(m.rows);
  for (int i = 0; i < m.nodes; ++i) {
    const Vec3f p = vec_cast<float>(m.rest[i] - m.origin);
    NodeState& n = s.nodes[m.row_of_node[i]];
    n.x = p.x, n.y = p.y, n.z = p.z;
  }
  s.scale.assign(m.packs.size() * kSlice, 1.0f);
  s.tet_phase.assign(m.tets.size(), 0);
  return s;
}

NetworkWork make_work(const NetworkModel& m, int threads) {
  simd_name();  // chosen now, so that the first tick need not read the environment
  NetworkWork w;
  w.forces.resize(std::size_t(std::max(threads, 1)));
  for (ForceWork& f : w.forces) {
    f.forces.resize(std::size_t(1 + m.ring));
    f.sums.resize(std::size_t(1 + m.lag));
  }
  w.other.resize(m.rows);
  w.loaded.resize(m.nodes);
  w.open_tets.resize(m.tets.size());
  w.folded.resize(m.rows);
  w.below.resize(m.tet_packs.size());
  w.scars.inertia.resize(std::size_t(m.nodes));
  w.scars.nodes.resize(std::size_t(m.nodes));
  if (m.bulk.impulses > 0) w.volume.resize(m.tets.size(), std::size_t(m.rows));
  return w;
}

}  // namespace trocar::tissue
