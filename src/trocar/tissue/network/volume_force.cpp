#include <algorithm>
#include <cmath>

#include <trocar/tissue/base/float4.hpp>
#include <trocar/tissue/network/volume_force.hpp>

namespace trocar::tissue {
namespace {

Float4 corner(std::span<const NodeState> nodes, const TetRest& c, int i) noexcept {
  return load4(&nodes[std::size_t(c.row[i])].x);
}
Float4 cross(Float4 a, Float4 b) noexcept {
  const Float4 a1 = __builtin_shufflevector(a, a, 1, 2, 0, 3), b1 = __builtin_shufflevector(b, b, 1, 2, 0, 3);
  const Float4 c = a * b1 - a1 * b;
  return __builtin_shufflevector(c, c, 1, 2, 0, 3);
}
float dot(Float4 a, Float4 b) noexcept {
  const Float4 c = a * b;
  return (c[0] + c[1]) + c[2];
}

/// A cell as it is: edges from its first corner, and six times its volume and the volume's derivatives by its corners.
struct CellNow {
  float volume6;
  Float4 by[4];
  CellNow(std::span<const NodeState> nodes, const TetRest& t) noexcept {
    const Float4 o = corner(nodes, t, 0);
    const Float4 a = corner(nodes, t, 1) - o, b = corner(nodes, t, 2) - o, c = corner(nodes, t, 3) - o;
    by[1] = cross(b, c), by[2] = cross(c, a), by[3] = cross(a, b);
    by[0] = -(by[1] + by[2] + by[3]);
    volume6 = dot(a, by[1]);
  }
};

bool gone(std::span<const std::uint8_t> phase, std::size_t cell) noexcept {
  return !phase.empty() && phase[cell] == kGone;
}

/// Every node's volume, and how stiffly it answers its pressure: the sum of |dV/dx|^2 / m over its cells.
void sum_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, std::span<const NodeState> nodes,
                 VolumeWork& w) noexcept {
  std::fill(w.volume.begin(), w.volume.end(), 0.0f);
  std::fill(w.answer.begin(), w.answer.end(), 0.0f);
  for (std::size_t t = 0; t < cells.size(); ++t) {
    const int* row = cells[t].row;
    if (gone(phase, t)) {  // counts as it was drawn: it neither presses nor is pressed
      for (int i = 0; i < 4; ++i) w.volume[std::size_t(row[i])] += cells[t].rest6 / 24;
      continue;
    }
    const CellNow cell(nodes, cells[t]);
    float answer = 0;
    for (int i = 0; i < 4; ++i) answer += w.inverse_mass[std::size_t(row[i])] * dot(cell.by[i], cell.by[i]);
    for (int i = 0; i < 4; ++i) {
      w.volume[std::size_t(row[i])] += cell.volume6 / 24;
      w.answer[std::size_t(row[i])] += answer;
    }
  }
  for (std::size_t row = 0; row < w.answer.size(); ++row)
    if (w.drawn[row] > 0) w.answer[row] /= w.drawn[row];
}

constexpr float kLeast = 0.5f, kMost = 2;     // of J: beyond, cells are the guard's and the law's business
constexpr float kCrushed = 0.2f, kBurst = 4;  // of a cell's volume: beyond, nothing presses on it any more
constexpr float kStiffer = 0.5f;              // of the stiffest node as built: one that answers more is pressed less
constexpr float kQuickest = 0.5f;             // of what one cell gives a node in an impulse [m/s]
constexpr float kWhole = 0.75f;               // of its volume as built must a node have to press

/// What is drawn out far has large faces: pressure on them would drive it on.
float share_of(float ratio) noexcept {
  const float least = (ratio - kCrushed) / (kLeast - kCrushed), most = (kBurst - ratio) / (kBurst - kMost);
  return std::max(std::min({least, most, 1.0f}), 0.0f);
}

/// What a unit of pressure does to that of a cell's corners which gives way most.
float liveliest(const CellNow& cell, const int* row, const VolumeWork& w) noexcept {
  float most2 = 0;
  for (int i = 0; i < 4; ++i) {
    const float lightness = w.inverse_mass[std::size_t(row[i])];
    most2 = std::max(most2, lightness * lightness * dot(cell.by[i], cell.by[i]));
  }
  return std::sqrt(most2);
}

float bounded(float push, float answer) noexcept {
  const float speed = std::fabs(push) * answer;
  return speed > kQuickest ? push * (kQuickest / speed) : push;
}

/// At wounds and in shreds cells share their pressure with few others: they would answer it faster than impulses allow.
bool whole(const Bulk& bulk, const VolumeWork& w, std::size_t row) noexcept {
  return row < bulk.built.size() && w.drawn[row] > kWhole * bulk.built[row];
}

/// @param dt  for which the forces will act [s]
void sum_forces(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, const Bulk& bulk, double dt,
                std::span<const NodeState> nodes, VolumeWork& w) noexcept {
  sum_volumes(cells, phase, nodes, w);
  const float bound = kStiffer * bulk.most_answer;
  for (std::size_t row = 0; row < w.pressure.size(); ++row) {
    if (!whole(bulk, w, row)) {
      w.pressure[row] = 0;
      continue;
    }
    const float j = std::min(std::max(w.volume[row] / w.drawn[row], kLeast), kMost);
    const float soft = w.answer[row] > bound && bound > 0 ? bound / w.answer[row] : 1;
    w.pressure[row] = soft * float(bulk.kappa) * (j - 1);
  }
  std::fill(w.force.begin(), w.force.end(), VolumeForce{});
  for (std::size_t t = 0; t < cells.size(); ++t) {
    if (gone(phase, t)) continue;
    const int* row = cells[t].row;
    const auto p = [&](int i) { return w.pressure[std::size_t(row[i])]; };
    const CellNow cell(nodes, cells[t]);
    float push = -(share_of(cell.volume6 / cells[t].rest6) * ((p(0) + p(1)) + (p(2) + p(3)))) / 24;
    push = bounded(push, float(dt) * liveliest(cell, row, w));
    for (int i = 0; i < 4; ++i) {
      float* const at = &w.force[std::size_t(row[i])].x;
      const Float4 sum = load4(at) + push * cell.by[i];
      std::memcpy(at, &sum, sizeof sum);
    }
  }
}

}  // namespace

void VolumeWork::resize(std::size_t rows) {
  for (auto* values : {&drawn, &volume, &answer, &inverse_mass, &pressure}) values->resize(rows);
  force.resize(rows);
}

void note_volumes(std::span<const TetRest> cells, std::span<const RowPack> weight, double weight_dt,
                  VolumeWork& w) noexcept {
  std::fill(w.drawn.begin(), w.drawn.end(), 0.0f);
  for (const TetRest& t : cells)
    for (const int row : t.row) w.drawn[std::size_t(row)] += t.rest6 / 24;
  for (std::size_t row = 0; row < w.inverse_mass.size(); ++row) {
    const RowPack& p = weight[row / kSlice];
    const std::size_t lane = row % kSlice;
    w.inverse_mass[row] = std::max({p.wx[lane], p.wy[lane], p.wz[lane]}) / float(weight_dt);
  }
}

void push_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, const Bulk& bulk, double dt,
                  std::span<const RowPack> weight, double weight_dt, std::span<NodeState> nodes,
                  VolumeWork& w) noexcept {
  sum_forces(cells, phase, bulk, dt, nodes, w);
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

namespace {

Vec3d force_on(const VolumeWork& w, std::size_t row) noexcept {
  const VolumeForce& f = w.force[row];
  return {double(f.x), double(f.y), double(f.z)};
}

}  // namespace

Bulk bulk_of(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
             double kappa, double tick) {
  Bulk bulk{kappa, 0, 0, {}};
  if (!(kappa > 0)) return bulk;
  VolumeWork w;
  w.resize(rest.size());
  for (const TetRest& t : cells)
    for (const int row : t.row) w.drawn[std::size_t(row)] += t.rest6 / 24;
  bulk.built = w.drawn;
  for (std::size_t row = 0; row < mass.size(); ++row) w.inverse_mass[row] = mass[row] > 0 ? float(1 / mass[row]) : 0;
  sum_volumes(cells, {}, rest, w);
  for (const float a : w.answer) bulk.most_answer = std::max(bulk.most_answer, a);

  double edge = 1;  // about the shortest of the cells
  for (const TetRest& t : cells)
    for (int i = 1; i < 4; ++i) {
      const Float4 e = corner(rest, t, i) - corner(rest, t, 0);
      edge = std::min(edge, std::sqrt(double(dot(e, e))));
    }
  // Power iteration on the mass-weighted stiffness, by small displacements of a rough start.
  std::vector<Vec3d> mode(rest.size());
  for (std::size_t i = 0; i < mode.size(); ++i) mode[i] = {i % 2 ? 1.0 : -1.0, i % 3 ? 1.0 : -1.0, i % 5 ? 1.0 : -1.0};
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
    sum_forces(cells, {}, bulk, 0, moved, w);
    double along = 0, size = 0;
    for (std::size_t i = 0; i < mode.size(); ++i) {
      const Vec3d d = scale * mode[i];
      along -= dot(d, force_on(w, i));
      size += mass[i] * dot(d, d);
      mode[i] = mass[i] > 0 ? (-1 / mass[i]) * force_on(w, i) : Vec3d{};
    }
    if (size > 0) lambda = std::max(lambda, along / size);
  }
  // dt^2 lambda < 4 is the limit of this force alone; it may grow with deformation, and the rest is for the springs.
  bulk.impulses = std::max(1, int(std::ceil(tick * std::sqrt(0.8 * lambda))));
  return bulk;
}

}  // namespace trocar::tissue
