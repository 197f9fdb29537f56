#include <algorithm>
#include <cmath>

#include <trocar/tissue/volume_force.hpp>

namespace trocar::tissue {
namespace {

Vec3f corner(std::span<const NodeState> nodes, const TetRest& c, int i) noexcept {
  const NodeState& n = nodes[std::size_t(c.row[i])];
  return {n.x, n.y, n.z};
}

/// A cell as it is: edges from its first corner, and its six-fold volume.
struct Cell {
  Vec3f a, b, c;
  Cell(std::span<const NodeState> nodes, const TetRest& t) noexcept {
    const Vec3f o = corner(nodes, t, 0);
    a = corner(nodes, t, 1) - o, b = corner(nodes, t, 2) - o, c = corner(nodes, t, 3) - o;
  }
  float volume6() const noexcept { return dot(a, cross(b, c)); }
  /// Six-fold derivative of the volume by corners 1, 2, 3; by corner 0 it is minus their sum.
  Vec3f by_a() const noexcept { return cross(b, c); }
  Vec3f by_b() const noexcept { return cross(c, a); }
  Vec3f by_c() const noexcept { return cross(a, b); }
};

bool gone(std::span<const std::uint8_t> phase, std::size_t cell) noexcept {
  return !phase.empty() && phase[cell] == kGone;
}

/// Volume of every node into work.pressure.
void sum_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, std::span<const NodeState> nodes,
                 VolumeWork& w) noexcept {
  std::fill(w.pressure.begin(), w.pressure.end(), 0.0f);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    // A cell that is gone counts as it was drawn: it neither presses nor is pressed.
    const float quarter = (gone(phase, t) ? cells[t].rest6 : Cell(nodes, cells[t]).volume6()) / 24;
    for (const int row : cells[t].row) w.pressure[std::size_t(row)] += quarter;
  }
}

void sum_forces(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, float kappa,
                std::span<const NodeState> nodes, VolumeWork& w) noexcept {
  sum_volumes(cells, phase, nodes, w);
  for (std::size_t row = 0; row < w.pressure.size(); ++row)
    w.pressure[row] = w.drawn[row] > 0 ? kappa * (w.pressure[row] / w.drawn[row] - 1) : 0;
  std::fill(w.force.begin(), w.force.end(), Vec3f{});
  for (std::size_t t = 0; t < cells.size(); ++t) {
    if (gone(phase, t)) continue;
    const int* row = cells[t].row;
    const auto p = [&](int i) { return w.pressure[std::size_t(row[i])]; };
    const float push = -((p(0) + p(1)) + (p(2) + p(3))) / 24;
    const Cell cell(nodes, cells[t]);
    const Vec3f fa = push * cell.by_a(), fb = push * cell.by_b(), fc = push * cell.by_c();
    w.force[std::size_t(row[1])] += fa;
    w.force[std::size_t(row[2])] += fb;
    w.force[std::size_t(row[3])] += fc;
    w.force[std::size_t(row[0])] -= fa + fb + fc;
  }
}

}  // namespace

void VolumeWork::resize(std::size_t rows) {
  drawn.resize(rows);
  pressure.resize(rows);
  force.resize(rows);
}

void note_volumes(std::span<const TetRest> cells, VolumeWork& w) noexcept {
  std::fill(w.drawn.begin(), w.drawn.end(), 0.0f);
  for (const TetRest& t : cells)
    for (const int row : t.row) w.drawn[std::size_t(row)] += t.rest6 / 24;
}

void push_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, double kappa, double dt,
                  std::span<const RowPack> weight, double weight_dt, std::span<NodeState> nodes,
                  VolumeWork& w) noexcept {
  sum_forces(cells, phase, float(kappa), nodes, w);
  const float times = float(dt / weight_dt);
  for (std::size_t row = 0; row < w.force.size(); ++row) {
    const RowPack& pack = weight[row / kSlice];
    const std::size_t lane = row % kSlice;
    NodeState& n = nodes[row];
    n.vx += times * pack.wx[lane] * w.force[row].x;
    n.vy += times * pack.wy[lane] * w.force[row].y;
    n.vz += times * pack.wz[lane] * w.force[row].z;
  }
}

int impulses_for(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
                 double kappa, double tick) {
  if (!(kappa > 0)) return 0;
  VolumeWork w;
  w.resize(rest.size());
  note_volumes(cells, w);
  // Power iteration on the mass-weighted stiffness, by small displacements of a rough start.
  std::vector<Vec3d> mode(rest.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = {i % 2 ? 1.0 : -1.0, i % 3 ? 1.0 : -1.0, i % 5 ? 1.0 : -1.0};
  double edge = 1;  // the shortest of the cells
  for (const TetRest& t : cells) {
    const Cell cell(rest, t);
    for (const Vec3f& e : {cell.a, cell.b, cell.c}) edge = std::min(edge, double(length(e)));
  }
  double lambda = 0;
  std::vector<NodeState> moved(rest.begin(), rest.end());
  for (int round = 0; round < 60; ++round) {
    double most = 0;
    for (const Vec3d& d : mode) most = std::max({most, std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    if (!(most > 0)) break;
    const double scale = 0.02 * edge / most;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Vec3d d = scale * mode[i];
      moved[i].x = rest[i].x + float(d.x), moved[i].y = rest[i].y + float(d.y), moved[i].z = rest[i].z + float(d.z);
    }
    sum_forces(cells, {}, float(kappa), moved, w);
    double along = 0, size = 0;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Vec3d d = scale * mode[i];
      along -= dot(d, vec_cast<double>(w.force[i]));
      size += mass[i] * dot(d, d);
      mode[i] = mass[i] > 0 ? (-1 / mass[i]) * vec_cast<double>(w.force[i]) : Vec3d{};
    }
    if (size > 0) lambda = std::max(lambda, along / size);
  }
  // dt^2 lambda < 4 is the limit of one force alone; half of it in dt leaves room for the springs and for J beyond 1.
  const double count = tick * std::sqrt(1.2 * lambda);
  return std::max(1, int(std::ceil(count)));
}

}  // namespace trocar::tissue
