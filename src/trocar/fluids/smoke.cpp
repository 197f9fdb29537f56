#include <algorithm>
#include <cmath>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/require.hpp>
#include <trocar/fluids/smoke.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::fluids {
namespace {

using core::require;

/// Whole cell and share towards the next, both within the grid, of a coordinate in cells (0 = centre of the first).
struct Place1 {
  int cell;
  double share;
};
Place1 place(double in_cells, int n) {
  const double q = in_cells > 0 ? std::min(in_cells, double(n - 1)) : 0.0;
  const int i = std::min(int(q), n - 2);
  return {i, q - i};
}

/// Speed at which smoke of density d rises [m/s].
float rise_speed(const SmokeModel& m, float d) {
  return float(m.rise_thin) + float(m.rise_thick - m.rise_thin) * (d / (d + float(m.thick)));
}

/// What passes upwards from each cell into the one above it in dt, per volume.
void find_rise(const SmokeModel& m, const SmokeState& s, double dt, std::vector<float>& rise) {
  const float per_cell = float(dt / m.cell);
  const int layer = m.nx * m.ny, below_top = layer * (m.nz - 1);
  for (int i = 0; i < below_top; ++i) {
    const float d = s.density[i];
    rise[i] = per_cell * rise_speed(m, d) * d;
  }
  for (int i = below_top; i < m.cells(); ++i) rise[i] = 0;
}

/// One row along x. Beyond a wall a cell finds its own value, so that nothing passes.
struct Row {
  const float *own, *south, *north, *below, *above, *rise, *rise_below;
  float* next;
};
void advance_row(const Row& r, int nx, float spread, float keep) {
  for (int i = 0; i < nx; ++i) {
    const float d = r.own[i], west = r.own[i > 0 ? i - 1 : i], east = r.own[i + 1 < nx ? i + 1 : i];
    const float around = ((west + east) + (r.south[i] + r.north[i])) + (r.below[i] + r.above[i]);
    const float rises = r.rise_below ? r.rise_below[i] - r.rise[i] : -r.rise[i];
    r.next[i] = keep * ((d + spread * (around - 6 * d)) + rises);
  }
}

void advance_density(const SmokeModel& m, const SmokeInput& input, double dt, SmokeState& s, SmokeWork& w) {
  find_rise(m, s, dt, w.rise);
  const float spread = float(m.spread * dt / (m.cell * m.cell));
  const float keep = float(1 / (1 + dt / (input.sucked ? m.tau_sucked : m.tau_still)));
  const int layer = m.nx * m.ny;
  for (int k = 0; k < m.nz; ++k)
    for (int j = 0; j < m.ny; ++j) {
      const int own = k * layer + j * m.nx;
      const float* d = s.density.data() + own;
      advance_row({.own = d,
                   .south = j > 0 ? d - m.nx : d,
                   .north = j + 1 < m.ny ? d + m.nx : d,
                   .below = k > 0 ? d - layer : d,
                   .above = k + 1 < m.nz ? d + layer : d,
                   .rise = w.rise.data() + own,
                   .rise_below = k > 0 ? w.rise.data() + own - layer : nullptr,
                   .next = w.next.data() + own},
                  m.nx, spread, keep);
    }
  s.density.swap(w.next);
}

void advance_fog(const SmokeModel& m, const SmokeInput& in, double dt, SmokeState& s) {
  s.on_time = in.coagulating ? s.on_time + dt : s.on_time / (1 + dt / m.on_memory);
  if (s.wipe_left > 0) {  // in a straight line to nothing
    s.fog = s.fog * (1 - std::min(dt / s.wipe_left, 1.0));
    s.wipe_left -= dt;
    return;
  }
  const double lens = std::isfinite(in.lens_temperature) ? in.lens_temperature : m.cold_lens;
  const double cold = std::clamp((m.warm_lens - lens) / (m.warm_lens - m.cold_lens), 0.0, 1.0);
  const double gathers = m.fog_gain * density_at(m, s, in.lens) * s.on_time * cold;
  const double tau = m.fog_tau * (cold > 0 ? 1.0 : 0.5);
  s.fog = std::min((s.fog + dt * gathers) / (1 + dt / tau), 1.0);
}

}  // namespace

SmokeModel build(const SmokeDescription& d, double tick) {
  require(d.nx >= 2 && d.ny >= 2 && d.nz >= 2 && d.nx <= 128 && d.ny <= 128 && d.nz <= 128, "smoke: 2 to 128 cells");
  require(finite(d.origin) && d.cell > 0 && d.cell < 1, "smoke: cell size and origin");
  require(d.tau_still > 0 && d.tau_sucked > 0 && d.fog_tau > 0 && d.wipe_time > 0 && d.on_memory > 0, "smoke: times");
  require(d.kappa >= 0 && d.fog_gain >= 0 && d.thick > 0 && d.warm_lens > d.cold_lens, "smoke: gains and temperatures");
  require(d.period >= 1 && d.period <= 64 && tick > 0 && tick <= 0.1, "smoke: period and tick");
  const double dt = tick * d.period, fastest = std::max(d.rise_thin, d.rise_thick);
  require(d.rise_thin >= 0 && d.rise_thick >= 0 && d.spread >= 0, "smoke: rise and spread");
  require(fastest * dt / d.cell + 6 * d.spread * dt / (d.cell * d.cell) <= 0.9,
          "smoke: it rises or spreads more than a cell in a step; larger cells or a shorter period");
  SmokeModel m;
  static_cast<SmokeDescription&>(m) = d;
  m.tick = tick;
  return m;
}

SmokeState clear_air(const SmokeModel& m) { return {.density = std::vector<float>(std::size_t(m.cells()), 0.0f)}; }
SmokeWork make_work(const SmokeModel& m) {
  return {std::vector<float>(std::size_t(m.cells())), std::vector<float>(std::size_t(m.cells()))};
}

bool boil(const SmokeModel& m, Vec3d at, double kilograms, SmokeState& s) noexcept {
  if (!finite(at) || !(kilograms >= 0) || !(kilograms < 1)) return false;
  const Vec3d q = (at - m.origin) / m.cell;
  const auto cell = [](double c, int n) { return c > 0 ? int(std::min(c, double(n - 1))) : 0; };
  const int i = (cell(q.z, m.nz) * m.ny + cell(q.y, m.ny)) * m.nx + cell(q.x, m.nx);
  s.density[i] += float(kilograms * 1000 / (m.cell * m.cell * m.cell));
  return true;
}

void advance(const SmokeModel& m, const SmokeInput& input, SmokeState& s, SmokeWork& w) noexcept {
  if (input.wipe) s.wipe_left = m.wipe_time;
  if (s.tick++ % std::uint64_t(m.period) != 0) return;
  const double dt = m.tick * m.period;
  advance_density(m, input, dt, s, w);
  advance_fog(m, input, dt, s);
}

double density_at(const SmokeModel& m, const SmokeState& s, Vec3d at) noexcept {
  if (!finite(at)) return 0;
  const Vec3d q = (at - m.origin) / m.cell;
  const Place1 x = place(q.x - 0.5, m.nx), y = place(q.y - 0.5, m.ny), z = place(q.z - 0.5, m.nz);
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int i = x.cell + (c & 1), j = y.cell + ((c >> 1) & 1), k = z.cell + (c >> 2);
    const double weight =
        ((c & 1) ? x.share : 1 - x.share) * ((c & 2) ? y.share : 1 - y.share) * ((c & 4) ? z.share : 1 - z.share);
    sum += weight * double(s.density[(k * m.ny + j) * m.nx + i]);
  }
  return sum;
}

double content(const SmokeModel& m, const SmokeState& s) noexcept {
  double sum = 0;
  for (float d : s.density) sum += double(d);
  return sum * m.cell * m.cell * m.cell / 1000;
}

double visibility(const SmokeModel& m, const SmokeState& s, Vec3d from, Vec3d to) noexcept {
  if (!finite(from) || !finite(to)) return 1;
  const double far = length(to - from);
  const int samples = int(std::min(far / (0.5 * m.cell), 255.0)) + 1;
  double depth = 0;
  for (int i = 0; i < samples; ++i) depth += density_at(m, s, from + ((i + 0.5) / samples) * (to - from));
  return portable::exp(-m.kappa * depth * (far / samples));
}

void add_to_hash(core::Hasher& h, const SmokeState& s) noexcept { core::add_fields(h, s); }

}  // namespace trocar::fluids
