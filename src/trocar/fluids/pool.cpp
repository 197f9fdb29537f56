// The pool between its steps: where things are, pouring in, drawing off. The step itself is in pool_step.cpp.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/fluids/pool.hpp>

namespace trocar::fluids {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}
bool finite(Vec3d p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }
bool unit(Vec3d a) { return finite(a) && std::fabs(dot(a, a) - 1) < 1e-9; }

std::int64_t held_by(const PoolState& s, int k) {
  return std::int64_t(s.blood[k]) + std::int64_t(s.saline[k]) + std::int64_t(s.bile[k]);
}
void add(PoolState& s, int k, const Mix& m) {
  s.blood[k] += std::int32_t(m.blood);
  s.saline[k] += std::int32_t(m.saline);
  s.bile[k] += std::int32_t(m.bile);
}

/// Cells whose middles are within a radius of p, along the surface: a square of cells that holds them, and the test.
struct Disc {
  int i0, i1, j0, j1;
  double x, y, square;  ///< in cells

  Disc(const PoolModel& m, Vec3d p, double radius) {
    const Vec3d d = p - m.origin;
    x = dot(d, m.u) / m.cell;
    y = dot(d, m.v) / m.cell;
    const double r = std::min(radius / m.cell, 64.0);
    square = r * r;
    const auto low = [](double q, int n) { return q > 0 ? int(std::min(q, double(n))) : 0; };
    i0 = low(x - r, m.nx), i1 = low(x + r + 1, m.nx), j0 = low(y - r, m.ny), j1 = low(y + r + 1, m.ny);
  }
  bool holds(int i, int j) const {
    const double dx = i + 0.5 - x, dy = j + 0.5 - y;
    return dx * dx + dy * dy <= square;
  }
};

}  // namespace

PoolModel build(const PoolDescription& d, double tick) {
  require(d.nx >= 2 && d.ny >= 2 && d.nx <= 1024 && d.ny <= 1024, "pool: 2 to 1024 cells a side");
  require(d.cell >= 1e-4 && d.cell <= 0.02, "pool: cells of 0.1 to 20 mm");
  require(finite(d.origin) && unit(d.u) && unit(d.v) && std::fabs(dot(d.u, d.v)) < 1e-9, "pool: origin and axes");
  require(d.gravity > 0 && d.gravity < 100, "pool: gravity");
  require(d.vertical_inertia >= 0 && d.vertical_inertia <= 2, "pool: vertical inertia from 0 to 2");
  require(d.friction >= 0 && d.viscosity >= 0 && d.damping >= 0, "pool: friction, viscosity, damping");
  require(d.period >= 1 && d.period <= 16 && tick > 0 && tick <= 0.01, "pool: period and tick");
  PoolModel m;
  static_cast<PoolDescription&>(m) = d;
  m.up = cross(d.u, d.v);
  m.tick = tick;
  m.stride = d.nx + 1;
  m.height_per_pl = float(kM3PerPicolitre / (d.cell * d.cell));
  m.fastest = float(0.9 * d.cell / m.dt());
  return m;
}

PoolState empty_pool(const PoolModel& m) {
  PoolState s;
  for (auto* cells : {&s.blood, &s.saline, &s.bile}) cells->assign(m.size(), 0);
  for (auto* faces : {&s.u, &s.v}) faces->assign(m.size(), 0.0f);
  return s;
}

PoolPoint locate(const PoolModel& m, Vec3d p) noexcept {
  const Vec3d d = p - m.origin;
  const double x = dot(d, m.u) / m.cell, y = dot(d, m.v) / m.cell, z = dot(d, m.up);
  if (!(std::fabs(x) < 1e9 && std::fabs(y) < 1e9 && std::fabs(z) < 1e6)) return {m.nx / 2, m.ny / 2, false, 0};
  PoolPoint at;
  at.i = x > 0 ? std::min(int(x), m.nx - 1) : 0;
  at.j = y > 0 ? std::min(int(y), m.ny - 1) : 0;
  at.inside = x >= 0 && y >= 0 && x < m.nx && y < m.ny;
  at.height = float(z);
  return at;
}

Vec3d world(const PoolModel& m, double along_u, double along_v, double height) noexcept {
  return m.origin + along_u * m.u + along_v * m.v + height * m.up;
}

float floor_at(const PoolModel& m, std::span<const float> floor, int i, int j) noexcept {
  const std::size_t k = std::size_t(j) * m.nx + i;
  const float z = k < floor.size() ? floor[k] : 0.0f;
  return z > -10 && z < 10 ? z : 0.0f;
}

Mix mix_at(const PoolModel& m, const PoolState& s, int i, int j) noexcept {
  const int k = m.at(i, j);
  return {s.blood[k], s.saline[k], s.bile[k]};
}
float depth_at(const PoolModel& m, const PoolState& s, int i, int j) noexcept {
  return float(held_by(s, m.at(i, j))) * m.height_per_pl;
}

bool pour(const PoolModel& m, int i, int j, const Mix& mix, PoolState& s) noexcept {
  const int k = m.at(i, j);
  const Mix in = share(mix, std::int64_t(kMostInACell) - held_by(s, k));
  add(s, k, in);
  s.held += mix - in;
  return in == mix;
}

void pour_over(const PoolModel& m, std::span<const float> floor, int i, int j, float radius, float level,
               const Mix& mix, PoolState& s) noexcept {
  const int reach = std::min(int(radius / float(m.cell)), 4);
  const float square = (radius * radius) / float(m.cell * m.cell);
  const auto fits = [&](int ii, int jj) {
    const float d2 = float((ii - i) * (ii - i) + (jj - j) * (jj - j));
    return ii >= 0 && jj >= 0 && ii < m.nx && jj < m.ny && d2 <= square && floor_at(m, floor, ii, jj) <= level;
  };
  int cells = 0;
  for (int jj = j - reach; jj <= j + reach; ++jj)
    for (int ii = i - reach; ii <= i + reach; ++ii) cells += fits(ii, jj) ? 1 : 0;
  Mix rest = mix;
  const std::int64_t each = cells > 1 ? mix.total() / cells : 0;
  for (int jj = j - reach; jj <= j + reach && each > 0; ++jj)
    for (int ii = i - reach; ii <= i + reach; ++ii) {
      if (!fits(ii, jj) || (ii == i && jj == j)) continue;
      const Mix part = share(rest, each);
      pour(m, ii, jj, part, s);
      rest -= part;
    }
  pour(m, i, j, rest, s);
}

void strike(const PoolModel& m, int i, int j, std::int64_t volume, Vec3f velocity, PoolState& s) noexcept {
  const int k = m.at(i, j);
  const float own = float(volume), all = own + float(held_by(s, k));
  if (!(own > 0) || !(all > 0)) return;
  // Along the surface shared out over two faces a direction, each of which belongs to two cells. Momentum downwards is
  // that of a column that sinks, M w / 2 with w = -h div u: an outward push of each of its four faces by m v dx / 2 M
  // h.
  const float taken = own / (all + own);
  const float deep = std::max(all * m.height_per_pl, float(m.cell));
  const float aside = taken * float(m.cell) / (2 * deep) * std::clamp(-velocity.z, 0.0f, 5.0f);
  const auto pushed = [&](float& face, float along, float away) {
    face = std::clamp(face + taken * (along - face) + away, -m.fastest, m.fastest);
  };
  const float along_u = std::clamp(velocity.x, -5.0f, 5.0f), along_v = std::clamp(velocity.y, -5.0f, 5.0f);
  if (i > 0) pushed(s.u[k], along_u, -aside);
  if (i + 1 < m.nx) pushed(s.u[k + 1], along_u, aside);
  if (j > 0) pushed(s.v[k], along_v, -aside);
  if (j + 1 < m.ny) pushed(s.v[k + m.stride], along_v, aside);
  s.first_row = s.first_row <= s.last_row ? std::min(s.first_row, j) : j;
  s.last_row = std::max(s.last_row, j);
}

Mix draw_off(const PoolModel& m, std::span<const float> floor, Vec3d p, double radius, std::int64_t amount,
             PoolState& s) noexcept {
  if (!finite(p) || !(radius > 0) || amount <= 0) return {};
  const Disc disc(m, p, radius);
  const double lowest = dot(p - m.origin, m.up) - radius;
  const auto reached = [&](int i, int j) {
    return disc.holds(i, j) && double(floor_at(m, floor, i, j)) + double(depth_at(m, s, i, j)) >= lowest;
  };
  std::int64_t there = 0;
  for (int j = disc.j0; j < disc.j1; ++j)
    for (int i = disc.i0; i < disc.i1; ++i)
      if (reached(i, j)) there += held_by(s, m.at(i, j));
  if (there == 0) return {};
  const double part = std::min(double(amount) / double(there), 1.0);
  Mix out;
  for (int j = disc.j0; j < disc.j1; ++j)
    for (int i = disc.i0; i < disc.i1; ++i) {
      if (!reached(i, j)) continue;
      const Mix own = mix_at(m, s, i, j);
      // A picolitre more than the rounded share, so that the last of a puddle goes too.
      const std::int64_t most = amount - out.total();
      const Mix taken = share(own, std::min(std::int64_t(double(own.total()) * part) + 1, most));
      add(s, m.at(i, j), Mix{} - taken);
      out += taken;
    }
  return out;
}

Mix content(const PoolModel& m, const PoolState& s) noexcept {
  Mix sum = s.held;
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i) sum += mix_at(m, s, i, j);
  return sum;
}

void add_to_hash(core::Hasher& hasher, const PoolState& s) noexcept {
  hasher.add(s.blood);
  hasher.add(s.saline);
  hasher.add(s.bile);
  hasher.add(s.u);
  hasher.add(s.v);
  hasher.add(s.held);
  hasher.add(s.drain_carry);
  hasher.add(s.highest);
  hasher.add(s.first_row);
  hasher.add(s.last_row);
  hasher.add(s.tick);
}

}  // namespace trocar::fluids
