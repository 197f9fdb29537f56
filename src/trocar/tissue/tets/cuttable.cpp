// A tick and a cut of a body that can be cut.
#include <algorithm>
#include <cmath>
#include <utility>

#include <trocar/core/field_hash.hpp>
#include <trocar/geometry/tets/tet_volume.hpp>
#include <trocar/tissue/network/network_kernels.hpp>
#include <trocar/tissue/network/network_loads.hpp>
#include <trocar/tissue/network/network_scars.hpp>
#include <trocar/tissue/network/stability.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {
namespace {

using geometry::CuttableTets;
using geometry::Tet;

constexpr int kMostSprings = 192;  // of a node; build() refuses bodies that come near
constexpr double kSafety = 0.9;    // of what the time step bears

double volume(const CuttableTets& b, const Tet& c) noexcept {
  const auto x = [&](int i) { return b.rest[std::size_t(c[std::size_t(i)])]; };
  return geometry::volume6(x(0), x(1), x(2), x(3)) / 6;
}

int index_in(const Tet& c, int value) noexcept {
  for (int i = 0; i < 4; ++i)
    if (c[std::size_t(i)] == value) return i;
  return 0;
}

constexpr int edge_between(int a, int b) noexcept {
  constexpr int number[4][4] = {{-1, 0, 1, 2}, {0, -1, 3, 4}, {1, 3, -1, 5}, {2, 4, 5, -1}};
  return number[a][b];
}

/// The springs of one node, each summed over the cells that bring to it.
struct Bundle {
  struct Spring {
    int other;
    float share, ratio;
  };
  Spring spring[kMostSprings];
  int count = 0;

  void add(int other, float share, float ratio) noexcept {
    if (!(share > 0)) return;
    for (int i = 0; i < count; ++i)
      if (spring[i].other == other) {
        spring[i].share += share;
        return;
      }
    if (count < kMostSprings) spring[count++] = {other, share, ratio};
  }
};

/// Makes the kernel's arrays for the State's cells.
class Assembler {
 public:
  Assembler(const CuttableModel& model, const CuttableState& state, CuttableWork& work) noexcept
      : m(model), b(state.tets), w(work) {}

  /// Everything.
  void make() noexcept {
    geometry::gather_cells(b.cells, w.begin, w.around);
    std::fill(w.node_of_row.begin(), w.node_of_row.end(), -1);
    w.slices = 0;
    w.slice_begin[0] = 0;
    for (int i = 0; i < b.nodes; ++i) place(i), weigh(i), bear(i);
    add_slices();
    guard();
  }

  /// What the last cut changed; true if that was possible. A row that has become too long for its slice asks for
  /// make().
  bool update() noexcept {
    geometry::gather_cells(b.cells, w.begin, w.around);
    mark_changed();
    for (int i = m.own_nodes; i < b.nodes; ++i) place(i);
    for (int i = 0; i < b.nodes; ++i) {
      if (w.changed[std::size_t(i)] != kChanged) continue;
      weigh(i);
      const float before = w.bearable[std::size_t(i)];
      bear(i);
      if (w.bearable[std::size_t(i)] != before) mark_neighbours(i);
    }
    const int there = w.slices;
    for (int i = 0; i < b.nodes; ++i) {
      const int row = m.row_of_node[std::size_t(i)];
      if (w.changed[std::size_t(i)] != kSame && row < there * kSlice && !write_row(row)) return false;
    }
    add_slices();
    guard();
    return true;
  }

 private:
  /// Cells as the guard wants them, and which piece each node belongs to.
  void guard() noexcept {
    if (!w.guarded_packs.empty()) w.guarded_packs.back() = empty_pack();
    for (std::size_t t = 0; t < b.cells.size(); ++t) {
      TetRest& cell = w.guarded[t];
      const double six = 6 * volume(b, b.cells[t]);
      cell.rest6 = float(six);
      for (std::size_t i = 0; i < 4; ++i) cell.row[i] = m.row_of_node[std::size_t(b.cells[t][i])];
      put_cell(cell, kCollapsed * six, int(t) % kSlice, w.guarded_packs[t / kSlice]);
    }
    if (m.bulk.impulses > 0)
      note_volumes(w.guarded, m.bulk, {w.row_packs.data(), std::size_t(w.slices)}, m.dt, w.volume_cells);
    for (int i = 0; i < b.nodes; ++i) w.part[std::size_t(i)] = i;
    for (const Tet& c : b.cells)
      for (std::size_t i = 1; i < 4; ++i) join(c[0], c[i]);
    for (int i = 0; i < b.nodes; ++i) w.part[std::size_t(i)] = root(i);
    std::int32_t parts = 0;  // pieces in the order of their lowest nodes, which are their roots
    for (int i = 0; i < b.nodes; ++i) {
      std::int32_t& part = w.part[std::size_t(i)];
      part = part == i ? parts++ : w.part[std::size_t(part)];
    }
    w.parts = parts;
    const std::span<std::int32_t> nodes_in(w.cut.fan.data(), std::size_t(parts));  // no more than cells
    std::fill(nodes_in.begin(), nodes_in.end(), 0);
    for (int i = 0; i < b.nodes; ++i) ++nodes_in[std::size_t(w.part[std::size_t(i)])];
    w.largest_part = std::int32_t(std::max_element(nodes_in.begin(), nodes_in.end()) - nodes_in.begin());
  }
  std::int32_t root(std::int32_t node) noexcept {
    while (w.part[std::size_t(node)] != node) {
      std::int32_t& up = w.part[std::size_t(node)];
      up = w.part[std::size_t(up)];
      node = up;
    }
    return node;
  }
  void join(std::int32_t i, std::int32_t j) noexcept {
    const std::int32_t a = root(i), z = root(j);
    w.part[std::size_t(std::max(a, z))] = std::min(a, z);
  }

  std::span<const int> cells_at(int node) const noexcept {
    const std::size_t first = std::size_t(w.begin[std::size_t(node)]);
    return {w.around.data() + first, std::size_t(w.begin[std::size_t(node) + 1]) - first};
  }
  void place(int node) noexcept { w.node_of_row[std::size_t(m.row_of_node[std::size_t(node)])] = node; }
  void weigh(int node) noexcept {
    double mass = 0;
    for (const int t : cells_at(node)) mass += m.density * volume(b, b.cells[std::size_t(t)]) / 4;
    w.mass[std::size_t(node)] = mass;
    w.fixed[std::size_t(node)] = m.fixed[std::size_t(original(node))];
  }

  enum Change : std::uint8_t { kSame, kNeighbour, kChanged };
  /// Corners of cells that the cut touched, and of those beyond their faces: springs go that far.
  void mark_changed() noexcept {
    std::fill(w.changed.begin(), w.changed.end(), std::uint8_t(kSame));
    for (std::int32_t k = 0; k < w.cut.touched_count; ++k) {
      const std::size_t t = std::size_t(w.cut.touched[std::size_t(k)]);
      for (const std::int32_t node : b.cells[t]) w.changed[std::size_t(node)] = kChanged;
      for (const std::int32_t u : b.across[t])
        for (int i = 0; u >= 0 && i < 4; ++i)
          w.changed[std::size_t(b.cells[std::size_t(u)][std::size_t(i)])] = kChanged;
    }
  }
  void mark_neighbours(int node) noexcept {
    const Bundle springs = springs_of(node);
    for (int i = 0; i < springs.count; ++i) {
      std::uint8_t& mark = w.changed[std::size_t(springs.spring[i].other)];
      mark = std::max(mark, std::uint8_t(kNeighbour));
    }
  }

  /// Cells in ascending order, so that both ends of a spring sum the same numbers in the same order.
  Bundle springs_of(int node) const noexcept {
    Bundle out;
    for (const int t : cells_at(node)) {
      const Tet& c = b.cells[std::size_t(t)];
      const CellSprings& brings = m.brings[std::size_t(t)];
      const int own = index_in(c, node);
      for (int j = 0; j < 4; ++j) {
        if (j == own) continue;
        const int e = edge_between(own, j);
        out.add(c[std::size_t(j)], brings.edge[e], brings.edge_ratio[e]);
      }
      const std::int32_t u = b.across[std::size_t(t)][std::size_t(own)];
      if (u < 0) continue;
      const int far = index_in(b.across[std::size_t(u)], t);
      out.add(b.cells[std::size_t(u)][std::size_t(far)], brings.cross[own] + m.brings[std::size_t(u)].cross[far],
              brings.cross_ratio[own]);
    }
    return out;
  }

  struct Drawn {
    Vec3d n;
    double length, k;
  };
  Drawn drawn(int node, const Bundle::Spring& s) const noexcept {
    const int a = std::min(node, s.other), z = std::max(node, s.other);  // the same bits from either end
    const Vec3d along = b.rest[std::size_t(z)] - b.rest[std::size_t(a)];
    const double l = std::max(length(along), 1e-6);
    return {along / l, l, double(s.share) / (l * l)};
  }

  /// How much of its springs' stiffness the node's mass bears in a sub-step.
  void bear(int node) noexcept {
    const Bundle springs = springs_of(node);
    double block[6] = {};
    for (int i = 0; i < springs.count; ++i) {
      const Drawn d = drawn(node, springs.spring[i]);
      const Vec3d n = d.n;
      const double nn[6] = {n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.x * n.z, n.y * n.z};
      for (int c = 0; c < 6; ++c) block[c] += d.k * nn[c];
    }
    const double k = largest_eigenvalue(block[0], block[1], block[2], block[3], block[4], block[5]);
    const double asks = m.dt * m.damping_time * k + 0.5 * m.dt * m.dt * k * std::max(1.0, double(m.cap_slope));
    const double has = kSafety * w.mass[std::size_t(node)];
    w.bearable[std::size_t(node)] = asks > has ? float(has / asks) : 1.0f;
  }

  /// Slices for rows that have none yet. Between the last spring and the slice's end a few columns stay free for cuts.
  void add_slices() noexcept {
    const int rows = m.own_rows + b.nodes - m.own_nodes, all = (rows + kSlice - 1) / kSlice;
    for (; w.slices < all; ++w.slices) {
      const int first = w.slice_begin[std::size_t(w.slices)];
      int width = 0;
      for (int lane = 0; lane < kSlice; ++lane) {
        const int node = w.node_of_row[std::size_t(w.slices * kSlice + lane)];
        if (node >= 0) width = std::max(width, springs_of(node).count);
      }
      // The last slice will take more doubles.
      if (w.slices == all - 1 && w.slices >= m.own_rows / kSlice) width = std::max(width, m.widest);
      w.slice_begin[std::size_t(w.slices) + 1] = std::min(first + width + kFreeColumns, m.packs);
      w.slice_end[std::size_t(w.slices)] = first;
      for (int lane = 0; lane < kSlice; ++lane)
        if (!write_row(w.slices * kSlice + lane)) hold_row(w.slices * kSlice + lane);
    }
  }

  /// False where it does not fit into its slice.
  bool write_row(int row) noexcept {
    const int s = row / kSlice, lane = row % kSlice, node = w.node_of_row[std::size_t(row)];
    const int first = w.slice_begin[std::size_t(s)], width = w.slice_begin[std::size_t(s) + 1] - first;
    RowPack& r = w.row_packs[std::size_t(s)];
    r.wx[lane] = r.wy[lane] = r.wz[lane] = 0;
    int used = 0;
    if (node >= 0) {
      const float weight = float(m.dt / (w.mass[std::size_t(node)] * (1 + m.dt * m.gamma)));
      const int held = w.fixed[std::size_t(node)];
      r.wx[lane] = held & kHeldX ? 0.0f : weight;
      r.wy[lane] = held & kHeldY ? 0.0f : weight;
      r.wz[lane] = held & kHeldZ ? 0.0f : weight;
      const Bundle springs = springs_of(node);
      if (springs.count > width) return false;
      for (; used < springs.count; ++used) put(w.packs[std::size_t(first + used)], lane, node, springs.spring[used]);
    }
    for (int c = used; c < width; ++c) pad(w.packs[std::size_t(first + c)], row);
    int& end = w.slice_end[std::size_t(s)];
    end = std::max(end, first + used);
    return true;
  }
  /// There is no room for its springs, which takes more cuts than there are spare nodes for: it stays where it is.
  void hold_row(int row) noexcept {
    RowPack& r = w.row_packs[std::size_t(row / kSlice)];
    r.wx[row % kSlice] = r.wy[row % kSlice] = r.wz[row % kSlice] = 0;
    for (int c = w.slice_begin[std::size_t(row / kSlice)]; c < w.slice_begin[std::size_t(row / kSlice) + 1]; ++c)
      pad(w.packs[std::size_t(c)], row);
  }
  int original(int node) const noexcept {
    while (b.source[std::size_t(node)] != node) node = b.source[std::size_t(node)];
    return node;
  }
  static void pad(HalfEdgePack& p, int row) noexcept {
    const int lane = row % kSlice;
    p.offset[lane] = std::uint32_t(row) * std::uint32_t(sizeof(NodeState));
    p.inv_rest[lane] = p.stiffness[lane] = p.damping[lane] = 0;
  }
  void put(HalfEdgePack& p, int lane, int node, const Bundle::Spring& s) const noexcept {
    const Drawn d = drawn(node, s);
    const double soft = std::min(w.bearable[std::size_t(node)], w.bearable[std::size_t(s.other)]);
    const double rest = d.length * double(s.ratio);
    p.offset[lane] = std::uint32_t(m.row_of_node[std::size_t(s.other)]) * std::uint32_t(sizeof(NodeState));
    p.inv_rest[lane] = float(1 / rest);
    p.stiffness[lane] = float(soft * d.k * rest);
    p.damping[lane] = float(soft * d.k * m.damping_time);
  }

  const CuttableModel& m;
  const CuttableTets& b;
  CuttableWork& w;
};

KernelArgs kernel_args(const CuttableModel& m, const CuttableWork& w) noexcept {
  KernelArgs a;
  a.packs = w.packs.data();
  a.rows = w.row_packs.data();
  a.slice_begin = w.slice_begin.data();
  a.slice_end = w.slice_end.data();
  a.p1 = m.p1, a.p2 = m.p2, a.cap = m.cap, a.cap_slope = m.cap_slope;
  const double decay = 1 / (1 + m.dt * m.gamma);
  a.decay = float(decay);
  for (int i = 0; i < 3; ++i) a.gravity_step[i] = float(m.dt * m.gravity[i] * decay);
  a.dt = float(m.dt);
  return a;
}

GuardedBody guarded_of(const CuttableModel& m, const CuttableState& s, const CuttableWork& w) noexcept {
  return {.cells = w.guarded,
          .packs = w.guarded_packs,
          .row_of_node = m.row_of_node,
          .node_of_row = w.node_of_row,
          .mass = w.mass,
          .rest = s.tets.rest,
          .row_packs = w.row_packs,
          .part = w.part,
          .nodes = s.tets.nodes,
          .rows = w.slices * kSlice,
          .origin = m.origin,
          .dt = m.dt,
          .uncut = s.version == 0,
          .opening = m.opening};
}

int first_non_finite(const CuttableModel& m, const CuttableState& s) noexcept {
  for (int i = 0; i < s.tets.nodes; ++i) {
    const NodeState& n = s.nodes[std::size_t(m.row_of_node[std::size_t(i)])];
    const float size =
        ((std::fabs(n.x) + std::fabs(n.y)) + std::fabs(n.z)) + ((std::fabs(n.vx) + std::fabs(n.vy)) + std::fabs(n.vz));
    if (!(size < 1e6f)) return i;
  }
  return -1;
}

}  // namespace

std::uint64_t version_of(const CuttableModel& m, const CuttableTets& b) noexcept {
  // Of all of it: two bodies of one Model that were cut differently never share scratch.
  if (b.nodes == m.own_nodes && b.across == m.drawn.across && b.rest == m.drawn.rest) return 0;
  core::Hasher h;
  core::add_fields(h, b);
  const std::uint64_t hash = h.value();
  return hash == 0 || hash == ~0ull ? 1 : hash;
}

void make_current(const CuttableModel& m, const CuttableState& s, CuttableWork& w) noexcept {
  if (w.made_for == s.version) return;
  Assembler(m, s, w).make();
  w.made_for = s.version;
}

StepReport advance(const CuttableModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions,
                   CuttableState& s, CuttableWork& w, Hands hands, std::span<const ScarredSpring> springs) noexcept {
  make_current(m, s, w);
  LoadedBody body{s.tets.nodes, m.dt, m.gamma, m.substeps, m.origin, w.mass, w.fixed, m.row_of_node};
  StepReport report = check_loads(body, loads);
  ScarredSprings scars(body, springs, w.scars);
  ImplicitLoads pull(body, loads, w.loaded);
  const GuardedBody guarded = guarded_of(m, s, w);
  Guard guard(guarded, {s.tet_phase, s.open_tets, s.tick}, {w.open_tets, w.below}, s.nodes, hands);
  if (guard.at_work()) report.flags |= StepReport::kInverted;
  KernelArgs args = kernel_args(m, w);
  bool fine = true;
  for (int i = 0; i < m.substeps; ++i) {
    if (m.bulk.impulses > 0 && i % (m.substeps / m.bulk.impulses) == 0) {
      scars.mark(s.nodes);
      push_volumes(w.volume_cells, {}, m.bulk, m.tick / m.bulk.impulses, m.dt, s.nodes, w.volume);
      scars.ease(s.nodes);
    }
    args.in = s.nodes.data();
    args.out = w.other.data();
    fine = kernels().substep(args, 0, w.slices) && fine;
    scars.apply(args.in, args.out);
    guard.mend(args.in, args.out);
    fine = pull.apply(args.in, args.out) && fine;
    guard.catch_leaps(args.in, args.out);
    std::swap(s.nodes, w.other);
  }
  pull.report(reactions);
  guard.release(s.nodes);
  ++s.tick;
  std::fill(s.nodes.begin() + std::ptrdiff_t(w.slices) * kSlice, s.nodes.end(), NodeState{});  // not used yet
  if (!fine) report = StepReport{StepReport::kNonFinite, first_non_finite(m, s)} | report;
  return report;
}

std::span<const std::uint8_t> folded_rows(const CuttableModel& m, const CuttableState& s, CuttableWork& w) noexcept {
  if (s.open_tets == 0) return {};
  make_current(m, s, w);
  return mark_folded(w.guarded, s.tet_phase, w.folded);
}

geometry::CutResult cut(const CuttableModel& m, const geometry::Blade& blade, CuttableState& s,
                        CuttableWork& w) noexcept {
  make_current(m, s, w);
  for (int i = 0; i < s.tets.nodes; ++i) w.now[std::size_t(i)] = position(m, s, i);
  const geometry::CutResult book = geometry::cut(s.tets, blade, w.now, w.cut);
  if (book.snapped + book.parted == 0) return book;
  for (int i = 0; i < book.first_new; ++i)
    if (w.cut.at_blade[std::size_t(i)]) set_position(m, s, i, w.now[std::size_t(i)]);
  for (int i = book.first_new; i < s.tets.nodes; ++i)
    s.nodes[std::size_t(m.row_of_node[std::size_t(i)])] =
        s.nodes[std::size_t(m.row_of_node[std::size_t(s.tets.source[std::size_t(i)])])];
  s.volume += book.volume;
  s.version = version_of(m, s.tets);
  if (Assembler(m, s, w).update()) w.made_for = s.version;
  return book;
}

Vec3d position(const CuttableModel& m, const CuttableState& s, int node) noexcept {
  const NodeState& n = s.nodes[std::size_t(m.row_of_node[std::size_t(node)])];
  return m.origin + Vec3d{double(n.x), double(n.y), double(n.z)};
}
Vec3d velocity(const CuttableModel& m, const CuttableState& s, int node) noexcept {
  const NodeState& n = s.nodes[std::size_t(m.row_of_node[std::size_t(node)])];
  return {double(n.vx), double(n.vy), double(n.vz)};
}
void set_position(const CuttableModel& m, CuttableState& s, int node, Vec3d x) noexcept {
  const Vec3f p = vec_cast<float>(x - m.origin);
  NodeState& n = s.nodes[std::size_t(m.row_of_node[std::size_t(node)])];
  n.x = p.x, n.y = p.y, n.z = p.z;
}
void set_velocity(const CuttableModel& m, CuttableState& s, int node, Vec3d v) noexcept {
  NodeState& n = s.nodes[std::size_t(m.row_of_node[std::size_t(node)])];
  n.vx = float(v.x), n.vy = float(v.y), n.vz = float(v.z);
}

double mass_of(const CuttableModel& m, const CuttableState& s, int node) noexcept {
  double mass = 0;
  for (const Tet& c : s.tets.cells)
    for (const std::int32_t corner : c)
      if (corner == node) mass += m.density * volume(s.tets, c) / 4;
  return mass;
}

void add_to_hash(core::Hasher& h, const CuttableState& s) noexcept { core::add_fields(h, s); }

void add_to_hash(core::Hasher& h, const CuttableModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::tissue
