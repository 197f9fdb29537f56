#include <algorithm>
#include <cmath>

#include <trocar/tissue/base/float4.hpp>
#include <trocar/tissue/network/network_kernels.hpp>
#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::tissue {
namespace {

constexpr float kStiffer = 0.5f;  // of the stiffest node as built: one that answers more is pressed less
constexpr float kWhole = 0.75f;   // of its volume as built must a node have to press

std::size_t packs_of(std::size_t cells) noexcept { return (cells + kSlice - 1) / kSlice; }

int lowest_row(const TetRest& t) noexcept { return *std::min_element(t.row, t.row + 4); }
int highest_row(const TetRest& t) noexcept { return *std::max_element(t.row, t.row + 4); }

/// In the order of their lowest rows, so that what a slice of rows and a pack of cells have of each other is near.
void order_cells(std::span<const TetRest> cells, VolumeCells& v) noexcept {
  std::fill(v.count.begin(), v.count.end(), 0);
  for (const TetRest& t : cells) ++v.count[std::size_t(lowest_row(t))];
  int before = 0;
  for (int& n : v.count) {
    const int here = n;
    n = before;
    before += here;
  }
  std::fill(v.cell.begin(), v.cell.end(), -1);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    v.place[t] = v.count[std::size_t(lowest_row(cells[t]))]++;
    v.cell[std::size_t(v.place[t])] = int(t);
  }
}

void put_corners(std::span<const TetRest> cells, VolumeCells& v) noexcept {
  if (!cells.empty()) v.corners.back() = {};
  std::fill(v.rest6.begin(), v.rest6.end(), 1.0f);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const std::size_t at = std::size_t(v.place[t]);
    for (int i = 0; i < 4; ++i)
      v.corners[at / kSlice].offset[i][at % kSlice] = std::uint32_t(cells[t].row[i]) * std::uint32_t(sizeof(Quad));
    v.rest6[at] = cells[t].rest6;
  }
}

/// What needs what, for taking it in turns.
void find_last(std::span<const TetRest> cells, VolumeCells& v) noexcept {
  std::fill(v.last_pack.begin(), v.last_pack.end(), 0);
  std::fill(v.last_slice.begin(), v.last_slice.end(), 0);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const int pack = v.place[t] / kSlice;
    for (const int row : cells[t].row) {
      int& last = v.last_pack[std::size_t(row / kSlice)];
      last = std::max(last, pack);
    }
    int& last = v.last_slice[std::size_t(pack)];
    last = std::max(last, highest_row(cells[t]) / kSlice);
  }
}

void sum_drawn(std::span<const TetRest> cells, VolumeCells& v) noexcept {
  std::fill(v.drawn.begin(), v.drawn.end(), 0.0f);
  for (const TetRest& t : cells)
    for (const int row : t.row) v.drawn[std::size_t(row)] += t.rest6 / 24;
}

/// At wounds and in shreds cells share their pressure with few others: they would answer it faster than impulses allow.
void choose_pressing(const Bulk& bulk, VolumeCells& v) noexcept {
  for (std::size_t row = 0; row < v.kappa.size(); ++row) {
    const bool whole = row < bulk.built.size() && v.drawn[row] > kWhole * bulk.built[row];
    v.kappa[row] = whole ? float(bulk.kappa) : 0.0f;
  }
}

void count_cells(std::span<const TetRest> cells, std::span<int> count) noexcept {
  std::fill(count.begin(), count.end(), 0);
  for (const TetRest& t : cells)
    for (const int row : t.row) ++count[std::size_t(row)];
}

int widest_of(std::span<const int> count, std::size_t slice) noexcept {
  const auto first = count.begin() + std::ptrdiff_t(slice * kSlice);
  return *std::max_element(first, first + kSlice);
}

/// Every row's cells, in ascending order: their order is that of the sums.
void list_around(std::span<const TetRest> cells, VolumeCells& v) noexcept {
  count_cells(cells, v.count);
  v.begin[0] = 0;
  for (std::size_t s = 0; s + 1 < v.begin.size(); ++s)
    v.begin[s + 1] = std::min(v.begin[s] + widest_of(v.count, s), int(v.around.size()));
  std::fill(v.around.begin(), v.around.begin() + v.begin.back(), CellPack{});
  std::fill(v.count.begin(), v.count.end(), 0);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const std::size_t at = std::size_t(v.place[t]), pack = at / kSlice, slot = std::size_t(kSlotOfLane[at % kSlice]);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t row = std::size_t(cells[t].row[i]), lane = row % kSlice;
      CellPack& column = v.around[std::size_t(v.begin[row / kSlice] + v.count[row]++)];
      column.answer[lane] = std::uint32_t(((1 + pack) * kSlice + slot) * sizeof(Quad));
      column.force[lane] = std::uint32_t(((1 + 4 * pack + i) * kSlice + slot) * sizeof(Quad));
    }
  }
}

void note_cells(std::span<const TetRest> cells, const Bulk& bulk, VolumeCells& v) noexcept {
  order_cells(cells, v);
  put_corners(cells, v);
  find_last(cells, v);
  sum_drawn(cells, v);
  choose_pressing(bulk, v);
  list_around(cells, v);
}

VolumeArgs volume_args(const VolumeCells& v, const Bulk& bulk, std::span<NodeState> nodes, VolumeWork& w) noexcept {
  VolumeArgs a;
  a.corners = v.corners.data();
  a.rest6 = v.rest6.data();
  a.around = v.around.data();
  a.around_begin = v.begin.data();
  a.weight = v.weight.data();
  a.drawn = v.drawn.data();
  a.kappa = v.kappa.data();
  a.most_answer = kStiffer * bulk.most_answer;
  a.last_pack = v.last_pack.data();
  a.last_slice = v.last_slice.data();
  a.cell = v.cell.data();
  a.packs = int(v.corners.size());
  a.slices = v.slices;
  a.nodes = nodes.data();
  a.node_answer = w.node_answer.data();
  a.places = w.places.data();
  a.answers = w.answers.data();
  a.forces = w.forces.data();
  a.bounds = w.bounds.data();
  return a;
}

}  // namespace

void VolumeCells::resize(std::size_t of_cells, std::size_t rows, std::size_t columns) {
  corners.resize(packs_of(of_cells));
  rest6.resize(packs_of(of_cells) * kSlice);
  around.resize(columns);
  begin.resize(rows / kSlice + 1);
  last_pack.resize(rows / kSlice);
  last_slice.resize(packs_of(of_cells));
  cell.resize(packs_of(of_cells) * kSlice);
  place.resize(of_cells);
  count.resize(rows);
  drawn.resize(rows);
  kappa.resize(rows);
  weight.resize(rows);
}

void VolumeWork::resize(std::size_t cells, std::size_t rows) {
  const std::size_t packs = packs_of(cells);
  places.resize(rows);
  answers.resize(1 + packs);
  forces.resize(1 + 4 * packs);
  bounds.resize(packs);
  node_answer.resize(rows);
}

ColumnCount columns_of(std::span<const TetRest> cells, std::size_t rows) {
  std::vector<int> count(rows);
  count_cells(cells, count);
  ColumnCount columns;
  for (std::size_t s = 0; s < rows / kSlice; ++s) {
    const std::size_t width = std::size_t(widest_of(count, s));
    columns.all += width;
    columns.widest = std::max(columns.widest, width);
  }
  return columns;
}

void note_volumes(std::span<const TetRest> cells, const Bulk& bulk, std::span<const RowPack> weight, double weight_dt,
                  VolumeCells& v) noexcept {
  v.slices = int(weight.size());
  note_cells(cells, bulk, v);
  for (std::size_t row = 0; row < weight.size() * kSlice; ++row) {
    const RowPack& p = weight[row / kSlice];
    const std::size_t lane = row % kSlice;
    const float lightness = std::max({p.wx[lane], p.wy[lane], p.wz[lane]}) / float(weight_dt);
    v.weight[row] = {p.wx[lane], p.wy[lane], p.wz[lane], lightness};
  }
}

void push_volumes(const VolumeCells& noted, std::span<const std::uint8_t> phase, const Bulk& bulk, double dt,
                  double weight_dt, std::span<NodeState> nodes, VolumeWork& w) noexcept {
  VolumeArgs args = volume_args(noted, bulk, nodes, w);
  args.phase = phase.empty() ? nullptr : phase.data();
  args.dt = float(dt);
  args.times = float(dt / weight_dt);
  kernels().press(args);
}

namespace {

/// A body as built whose nodes get their forces as velocities.
class ForceField {
 public:
  ForceField(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass, Bulk& bulk)
      : m_bulk(bulk), m_nodes(rest.begin(), rest.end()) {
    m_cells.resize(cells.size(), rest.size(), columns_of(cells, rest.size()).all);
    m_work.resize(cells.size(), rest.size());
    m_cells.slices = int(rest.size() / kSlice);
    sum_drawn(cells, m_cells);
    bulk.built = m_cells.drawn;
    note_cells(cells, bulk, m_cells);
    for (std::size_t row = 0; row < mass.size(); ++row)
      m_cells.weight[row] = {1, 1, 1, mass[row] > 0 ? float(1 / mass[row]) : 0};
  }
  std::vector<NodeState>& nodes() noexcept { return m_nodes; }
  std::span<const float> answers() const noexcept { return m_work.node_answer; }
  void evaluate() noexcept {
    for (NodeState& n : m_nodes) n.vx = n.vy = n.vz = 0;
    VolumeArgs args = volume_args(m_cells, m_bulk, m_nodes, m_work);
    args.times = 1;
    kernels().press(args);
  }
  Vec3d force(std::size_t row) const noexcept {
    const NodeState& n = m_nodes[row];
    return {double(n.vx), double(n.vy), double(n.vz)};
  }

 private:
  const Bulk& m_bulk;
  std::vector<NodeState> m_nodes;
  VolumeCells m_cells;
  VolumeWork m_work;
};

double shortest_edge(std::span<const TetRest> cells, std::span<const NodeState> rest) noexcept {
  double edge = 1;
  for (const TetRest& t : cells)
    for (int i = 1; i < 4; ++i) {
      const auto corner = [&](int k) { return load4(&rest[std::size_t(t.row[k])].x); };
      const Float4 e = corner(i) - corner(0), square = e * e;
      edge = std::min(edge, std::sqrt(double((square[0] + square[1]) + square[2])));
    }
  return edge;
}

}  // namespace

Bulk bulk_of(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
             double kappa, double tick) {
  Bulk bulk{kappa, 0, 0, {}};
  if (!(kappa > 0)) return bulk;
  ForceField field(cells, rest, mass, bulk);
  field.evaluate();
  for (const float a : field.answers()) bulk.most_answer = std::max(bulk.most_answer, a);

  const double edge = shortest_edge(cells, rest);  // about
  // Power iteration on the mass-weighted stiffness, by small displacements of a rough start.
  std::vector<Vec3d> mode(rest.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = {i % 2 ? 1.0 : -1.0, i % 3 ? 1.0 : -1.0, i % 5 ? 1.0 : -1.0};
  double lambda = 0;
  std::vector<NodeState>& moved = field.nodes();
  for (int round = 0; round < 60; ++round) {
    double most = 0;
    for (const Vec3d& d : mode) most = std::max({most, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    if (!(most > 0)) break;
    const double scale = 0.02 * edge / most;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Vec3d d = scale * mode[i];
      moved[i].x = rest[i].x + float(d.x), moved[i].y = rest[i].y + float(d.y), moved[i].z = rest[i].z + float(d.z);
    }
    field.evaluate();
    double along = 0, size = 0;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Vec3d d = scale * mode[i];
      along -= dot(d, field.force(i));
      size += mass[i] * dot(d, d);
      mode[i] = mass[i] > 0 ? (-1 / mass[i]) * field.force(i) : Vec3d{};
    }
    if (size > 0) lambda = std::max(lambda, along / size);
  }
  // dt^2 lambda < 4 is the limit of this force alone; it may grow with deformation, and the rest is for the springs.
  bulk.impulses = std::max(1, int(std::ceil(tick * std::sqrt(0.8 * lambda))));
  return bulk;
}

}  // namespace trocar::tissue
