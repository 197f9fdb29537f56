// The pool between its steps: where things are, pouring in, drawing off. The step itself is in pool_step.cpp.
#include <algorithm>
#include <cmath>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/require.hpp>
#include <trocar/fluids/pool.hpp>

namespace trocar::fluids {
namespace {

using core::require;
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
  require(d.inertia_depth > 0, "pool: inertia depth");
  require(d.friction >= 0 && d.viscosity >= 0 && d.damping >= 0, "pool: friction, viscosity, damping");
  require(d.period >= 1 && d.period <= 16 && tick > 0 && tick <= 0.01, "pool: period and tick");
  require(d.first >= 0 && d.first < d.period, "pool: the first step");
  PoolModel m;
  static_cast<PoolDescription&>(m) = d;
  m.up = cross(d.u, d.v);
  m.tick = tick;
  m.stride = d.nx + 1;
  m.height_per_pl = float(kM3PerPicolitre / (d.cell * d.cell));
  m.fastest = float(0.5 * d.cell / m.dt());
  return m;
}

PoolState empty_pool(const PoolModel& m) {
  PoolState s;
  for (auto* cells : {&s.blood, &s.saline, &s.bile}) cells->assign(m.size(), 0);
  for (auto* faces : {&s.u, &s.v}) faces->assign(m.size(), 0.0f);
  s.tick = std::uint64_t(m.first > 0 ? m.period - m.first : 0);
  s.next = m.first > 0 ? std::uint64_t(m.period) : 0;
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

namespace {

/// The cells around one that something falls on.
struct Footprint {
  int i0, i1, j0, j1, i, j;
  float square;  ///< of the radius in cells

  Footprint(const PoolModel& m, int at_i, int at_j, float radius) : i(at_i), j(at_j) {
    const float cells = std::clamp(radius / float(m.cell), 0.5f, 4.0f);
    const int reach = int(cells);
    square = cells * cells;
    i0 = std::max(i - reach, 0), i1 = std::min(i + reach, m.nx - 1);
    j0 = std::max(j - reach, 0), j1 = std::min(j + reach, m.ny - 1);
  }
  bool holds(int ii, int jj) const { return float((ii - i) * (ii - i) + (jj - j) * (jj - j)) <= square; }
  template <class Visit>
  void each(const Visit& visit) const {
    for (int jj = j0; jj <= j1; ++jj)
      for (int ii = i0; ii <= i1; ++ii)
        if (holds(ii, jj)) visit(ii, jj);
  }
};

/// Momentum of `volume` with velocity v over a footprint. Along the surface it is shared with the fluid there.
/// Downwards it is that of columns that sink, M w / 2 with w = -h div u: an outward speed of x w / 2 h at the distance
/// x.
void push_down(const PoolModel& m, const Footprint& f, std::int64_t volume, Vec3f v, PoolState& s) {
  float there = 0, cells = 0;
  f.each([&](int i, int j) { there += float(held_by(s, m.at(i, j))), cells += 1; });
  const float own = float(volume), all = own + there;
  if (!(own > 0) || !(there > 0)) return;
  const float taken = own / all, deep = std::max(all / cells * m.height_per_pl, float(m.cell));
  const float sinks = 2 * taken * std::clamp(-v.z, 0.0f, 5.0f), aside = sinks / (2 * deep) * float(m.cell);
  const float along_u = std::clamp(v.x, -5.0f, 5.0f), along_v = std::clamp(v.y, -5.0f, 5.0f);
  const auto pushed = [&](float& face, float along, float cells_away) {
    face = std::clamp(face + taken * (along - face) + aside * cells_away, -m.fastest, m.fastest);
  };
  f.each([&](int i, int j) {
    const int k = m.at(i, j);
    if (i > 0) pushed(s.u[k], along_u, float(i - f.i) - 0.5f);
    if (i + 1 < m.nx && !(i < f.i1 && f.holds(i + 1, j))) pushed(s.u[k + 1], along_u, float(i - f.i) + 0.5f);
    if (j > 0) pushed(s.v[k], along_v, float(j - f.j) - 0.5f);
    if (j + 1 < m.ny && !(j < f.j1 && f.holds(i, j + 1))) pushed(s.v[k + m.stride], along_v, float(j - f.j) + 0.5f);
  });
  s.first_row = s.first_row <= s.last_row ? std::min(s.first_row, f.j0) : f.j0;
  s.last_row = std::max(s.last_row, f.j1);
}

}  // namespace

void fall_into(const PoolModel& m, std::span<const float> floor, int i, int j, float radius, const Mix& mix, Vec3f v,
               PoolState& s) noexcept {
  const Footprint f(m, i, j, radius);
  push_down(m, f, mix.total(), v, s);
  const auto surface = [&](int ii, int jj) { return floor_at(m, floor, ii, jj) + depth_at(m, s, ii, jj); };
  float sum = 0, cells = 0;
  f.each([&](int ii, int jj) { sum += surface(ii, jj), cells += 1; });
  const float mean = sum / cells + 1e-6f;
  int low = 0, last_i = i, last_j = j;
  f.each([&](int ii, int jj) {
    if (surface(ii, jj) <= mean) ++low, last_i = ii, last_j = jj;
  });
  Mix rest = mix;
  const std::int64_t each = low > 1 ? mix.total() / low : 0;
  if (each > 0)
    f.each([&](int ii, int jj) {
      if ((ii == last_i && jj == last_j) || surface(ii, jj) > mean) return;
      const Mix part = share(rest, each);
      pour(m, ii, jj, part, s);
      rest -= part;
    });
  pour(m, last_i, last_j, rest, s);
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

void add_to_hash(core::Hasher& h, const PoolState& s) noexcept { core::add_fields(h, s); }

}  // namespace trocar::fluids
