// One step of the pool: what the cells look like, how their faces' speeds change, what passes through the faces.
// The loops along rows are in pool_kernel.inl.
#include <algorithm>

#include <trocar/fluids/jet.hpp>
#include <trocar/fluids/pool.hpp>
#include <trocar/fluids/pool_kernels.hpp>

namespace trocar::fluids {
namespace {

struct Rows {
  int first, last;
  bool empty() const { return first > last; }
};

bool row_is_wet(const PoolModel& m, const PoolState& s, int j) {
  std::int32_t any = 0;
  const int k0 = m.at(0, j);
  for (int k = k0; k < k0 + m.nx; ++k) any |= s.blood[k] | s.saline[k] | s.bile[k];
  return any != 0;
}

/// Wet rows and two on either side, within the field.
Rows rows_at_work(const PoolModel& m, const PoolState& s) {
  int first = 0, last = m.ny - 1;
  while (first <= last && !row_is_wet(m, s, first)) ++first;
  while (last > first && !row_is_wet(m, s, last)) --last;
  if (first > last) return {0, -1};
  return {std::max(first - 2, 0), std::min(last + 2, m.ny - 1)};
}

/// Speeds that are left where nothing is at work any more go to 0.
void still_rows_outside(const PoolModel& m, Rows now, PoolState& s) {
  for (int j = std::max(s.first_row, 0); j <= std::min(s.last_row + 1, m.ny); ++j) {
    if (!now.empty() && j >= now.first && j <= now.last) continue;
    std::fill_n(s.u.begin() + m.at(0, j), m.stride, 0.0f);
    if (now.empty() || j != now.last + 1) std::fill_n(s.v.begin() + m.at(0, j), m.stride, 0.0f);
  }
  s.first_row = now.first, s.last_row = now.last;
}

// ---- the cells

void describe_cells(const PoolKernels& x, const PoolModel& m, const PoolInput& in, Rows rows, const PoolState& s,
                    PoolWork& w, FluidReport& report) {
  const bool whole = in.floor.size() >= std::size_t(m.nx) * m.ny;
  if (!whole && !in.floor.empty()) report.note(FluidReport::kBadFloor, std::int32_t(in.floor.size()));
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    int bad = 0;
    const float* floor = whole ? in.floor.data() + std::size_t(j) * m.nx : nullptr;
    float* bed = w.bed.data() + k0;
    for (int i = 0; i < m.nx; ++i) {
      const float z = floor ? floor[i] : 0.0f;
      const bool fine = (z > -10) & (z < 10);
      bed[i] = fine ? z : 0.0f;
      bad |= fine ? 0 : 1;
    }
    if (bad) report.note(FluidReport::kBadFloor, j * m.nx);
    x.describe(m.nx, m.height_per_pl,
               {s.blood.data() + k0, s.saline.data() + k0, s.bile.data() + k0, bed, w.volume.data() + k0,
                w.depth.data() + k0, w.eta.data() + k0});
  }
}

/// The highest of these below `bound`, or `top`. Sixteen at a time, so that none waits for the one before it.
float highest_of(std::span<const float> z, float bound, float top) {
  constexpr std::size_t kLanes = 16;
  float lane[kLanes];
  for (float& l : lane) l = top;
  std::size_t i = 0;
  for (; i + kLanes <= z.size(); i += kLanes)
    for (std::size_t k = 0; k < kLanes; ++k) {
      const float below = z[i + k] < bound ? z[i + k] : top;
      lane[k] = below > lane[k] ? below : lane[k];
    }
  for (; i < z.size(); ++i) top = z[i] > top && z[i] < bound ? z[i] : top;
  for (const float l : lane) top = l > top ? l : top;
  return top;
}

/// The highest bed anywhere and the highest surface where the pool is at work.
float highest(const PoolModel& m, const PoolInput& in, Rows rows, const PoolWork& w) {
  float top = highest_of(in.floor, 10, in.floor.empty() ? 0.0f : -10.0f);
  if (top < 0) top = 0;  // what is not finite counts as 0
  for (int j = rows.first; j <= rows.last; ++j)
    top = highest_of({w.eta.data() + m.at(0, j), std::size_t(m.nx)}, 1e30f, top);
  return top;
}

/// The capsule in the pool's frame.
Capsule in_frame(const PoolModel& m, const Capsule& c) {
  const auto turned = [&](Vec3f p) {
    const Vec3d d = vec_cast<double>(p) - m.origin;
    return Vec3f{float(dot(d, m.u)), float(dot(d, m.v)), float(dot(d, m.up))};
  };
  Capsule own = c;
  own.a = turned(c.a), own.b = turned(c.b);
  return own;
}

/// Columns that a capsule fills stand on a bed that is higher by as much.
void lift(const PoolModel& m, const Capsule& c, Rows rows, PoolWork& w) {
  const float cell = float(m.cell);
  const auto index = [&](float x, int n) { return int(std::clamp(x / cell, -1.0f, float(n))); };
  const int i0 = std::max(index(std::min(c.a.x, c.b.x) - c.radius, m.nx), 0);
  const int i1 = std::min(index(std::max(c.a.x, c.b.x) + c.radius, m.nx), m.nx - 1);
  const int j0 = std::max(index(std::min(c.a.y, c.b.y) - c.radius, m.ny), rows.first);
  const int j1 = std::min(index(std::max(c.a.y, c.b.y) + c.radius, m.ny), rows.last);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i) {
      const Interval chord = upright_chord(c, (float(i) + 0.5f) * cell, (float(j) + 0.5f) * cell);
      const int k = m.at(i, j);
      const float wetted = std::min(chord.high, w.eta[k]) - std::max(chord.low, w.bed[k]);
      if (chord.empty() || !(wetted > 0)) continue;
      w.bed[k] += wetted;
      w.eta[k] += wetted;
    }
}

// ---- the speeds

void solve_across_u(const PoolKernels& x, const PoolModel& m, int j0, int last, PoolWork& w) {
  PoolStrip s;
  for (int l = 0; l < kPoolLanes; ++l) {
    const int k = m.at(0, std::min(j0 + l, last));
    s.under[l] = w.under.data() + k, s.mass[l] = w.inertia.data() + k, s.rhs[l] = w.rhs.data() + k;
    s.answer[l] = w.answer.data() + k;
  }
  s.turned_under = w.strip[0].data(), s.turned_mass = w.strip[1].data(), s.turned_rhs = w.strip[2].data();
  s.sweep = w.strip[3].data();
  x.solve_strip(m.nx, s);
}

void solve_across_v(const PoolKernels& x, const PoolModel& m, Rows rows, PoolWork& w) {
  const int s = m.stride;
  const auto row = [&](std::vector<float>& a, int j) { return a.data() + m.at(0, j); };
  std::fill_n(row(w.sweep, rows.first), m.nx, 0.0f);
  std::fill_n(row(w.answer, rows.first), m.nx, 0.0f);
  for (int j = rows.first + 1; j <= rows.last; ++j) {
    float* answer = row(w.answer, j);
    x.eliminate(m.nx, row(w.under, j), row(w.inertia, j - 1), row(w.inertia, j), row(w.rhs, j), row(w.sweep, j - 1),
                answer - s, row(w.sweep, j), answer);
  }
  for (int j = rows.last - 1; j > rows.first; --j)
    x.substitute(m.nx, row(w.sweep, j), row(w.answer, j + 1), row(w.answer, j));
}

PoolConstants constants_of(const PoolModel& m) {
  return {.g = float(m.gravity),
          .dt = float(m.dt()),
          .per_dx = float(1 / m.cell),
          .third = float(m.vertical_inertia / 3),
          .inertia_depth = float(m.inertia_depth),
          .friction = float(m.friction),
          .viscous = float(3 * m.viscosity),
          .damping = float(m.damping),
          .fastest = m.fastest};
}

void accelerate_u(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, PoolState& s,
                  PoolWork& w) {
  const PoolFaces a{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride};
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    x.look_at_faces(a, k0 + 1, k0 + m.nx, w.under.data(), w.flux.data());
    w.under[k0] = w.flux[k0] = w.flux[k0 + m.nx] = w.rhs[k0] = 0;
    x.look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
    x.push_faces(a, k0 + 1, k0 + m.nx, c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(), w.sweep.data());
  }
  for (int j = rows.first; j <= rows.last; j += kPoolLanes) solve_across_u(x, m, j, rows.last, w);
  for (int j = rows.first; j <= rows.last; ++j)
    x.slow_faces(m.at(1, j), m.at(m.nx, j), c, w.under.data(), w.sweep.data(), w.answer.data(), s.u.data());
}

void accelerate_v(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, PoolState& s,
                  PoolWork& w) {
  const PoolFaces a{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1};
  float* carried = w.flux_v.data();
  std::fill_n(w.flux.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    if (j > rows.first) x.look_at_faces(a, k0, k0 + m.nx, w.under.data(), w.flux.data());
    x.look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
  }
  for (int j = rows.first + 1; j <= rows.last; ++j)
    x.push_faces(a, m.at(0, j), m.at(m.nx, j), c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(), carried);
  solve_across_v(x, m, rows, w);
  for (int j = rows.first + 1; j <= rows.last; ++j)
    x.slow_faces(m.at(0, j), m.at(m.nx, j), c, w.under.data(), carried, w.answer.data(), s.v.data());
  std::fill_n(s.v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(s.v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
}

// ---- what passes

bool any_of(const PoolModel& m, Rows rows, const std::vector<std::int32_t>& species) {
  std::int32_t any = 0;
  for (int k = m.at(0, rows.first); k < m.at(m.nx, rows.last); ++k) any |= species[k];
  return any != 0;
}

/// One species: `volume` and `flux` are those before anything has moved, so the species do not see one another.
void move_species(const PoolKernels& x, const PoolModel& m, Rows rows, std::vector<std::int32_t>& species,
                  PoolWork& w) {
  if (!any_of(m, rows, species)) return;
  constexpr float kFull = float(kMostInACell);
  float* keep = w.keep.data();
  std::int32_t *moved_u = w.moved_u.data(), *moved_v = w.moved_v.data();
  for (int j = rows.first; j <= rows.last; ++j)
    x.find_shares(m.at(0, j), m.at(m.nx, j), m.stride, w.flux.data(), w.flux_v.data(), w.volume.data(), species.data(),
                  keep);
  std::fill_n(moved_v + m.at(0, rows.first), m.nx, 0);
  std::fill_n(moved_v + m.at(0, rows.last + 1), m.nx, 0);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    moved_u[k0] = moved_u[k0 + m.nx] = 0;
    x.find_moved(k0 + 1, k0 + m.nx, 1, kFull, w.flux.data(), w.volume.data(), keep, moved_u);
    if (j > rows.first) x.find_moved(k0, k0 + m.nx, m.stride, kFull, w.flux_v.data(), w.volume.data(), keep, moved_v);
  }
  for (int j = rows.first; j <= rows.last; ++j)
    x.book(m.at(0, j), m.at(m.nx, j), m.stride, moved_u, moved_v, species.data());
}

void exchange(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, PoolState& s, PoolWork& w) {
  const PoolFaces across_u{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride};
  const PoolFaces across_v{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1};
  const float pl = float(m.cell * m.dt() * kPicolitresPerM3);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    w.flux[k0] = w.flux[k0 + m.nx] = 0;
    x.volumes_through(across_u, k0 + 1, k0 + m.nx, c, pl, s.u.data(), w.flux.data());
    if (j > rows.first) x.volumes_through(across_v, k0, k0 + m.nx, c, pl, s.v.data(), w.flux_v.data());
  }
  for (std::vector<std::int32_t>* species : {&s.blood, &s.saline, &s.bile}) move_species(x, m, rows, *species, w);
}

// ---- in and out

void empty_drains(const PoolModel& m, std::span<const Drain> drains, PoolState& s, Ledger& ledger,
                  FluidReport& report) {
  const std::size_t n = std::min(drains.size(), std::size_t(kMostDrains));
  for (std::size_t d = 0; d < n; ++d) {
    const Drain& drain = drains[d];
    const bool known = drain.i >= 0 && drain.i < m.nx && drain.j >= 0 && drain.j < m.ny;
    if (!known || !(drain.area >= 0 && drain.area < 1) || !(drain.cd >= 0 && drain.cd <= 1)) {
      report.note(FluidReport::kBadDrain, std::int32_t(d));
      continue;
    }
    const Mix own = mix_at(m, s, drain.i, drain.j);
    std::int64_t amount = own.total();
    if (drain.area > 0) {
      const double flow = orifice_flow(drain.area, depth_at(m, s, drain.i, drain.j), m.gravity, drain.cd);
      amount = whole_picolitres(flow, m.dt(), s.drain_carry[d]);
    }
    const Mix out = share(own, amount);
    const int k = m.at(drain.i, drain.j);
    s.blood[k] -= std::int32_t(out.blood), s.saline[k] -= std::int32_t(out.saline);
    s.bile[k] -= std::int32_t(out.bile);
    move(ledger, Place::kPool, Place::kDrained, out);
  }
}

/// What waits for room is offered to every cell alike.
void pour_held(const PoolModel& m, PoolState& s, FluidReport& report) {
  if (s.held.empty()) return;
  report.note(FluidReport::kPoolHeldBack, 0);
  const std::int64_t each = s.held.total() / (std::int64_t(m.nx) * m.ny) + 1;
  for (int j = 0; j < m.ny && !s.held.empty(); ++j)
    for (int i = 0; i < m.nx; ++i) {
      const Mix part = share(s.held, each);
      s.held -= part;
      pour(m, i, j, part, s);
    }
}

}  // namespace

FluidReport advance(const PoolModel& m, const PoolInput& in, PoolState& s, PoolWork& w, Ledger& ledger) noexcept {
  FluidReport report;
  if (s.tick++ % std::uint64_t(m.period) != 0) return report;
  empty_drains(m, in.drains, s, ledger, report);
  pour_held(m, s, report);
  const Rows rows = rows_at_work(m, s);
  still_rows_outside(m, rows, s);
  if (rows.empty()) {
    s.highest = highest(m, in, rows, w);
    return report;
  }
  const PoolKernels& x = pool_kernels();
  const PoolConstants c = constants_of(m);
  describe_cells(x, m, in, rows, s, w, report);
  for (std::size_t i = 0; i < in.capsules.size(); ++i) {
    if (sound(in.capsules[i]))
      lift(m, in_frame(m, in.capsules[i]), rows, w);
    else
      report.note(FluidReport::kBadContact, std::int32_t(i));
  }
  s.highest = highest(m, in, rows, w);
  accelerate_u(x, m, c, rows, s, w);
  accelerate_v(x, m, c, rows, s, w);
  exchange(x, m, c, rows, s, w);
  return report;
}

PoolWork make_work(const PoolModel& m) {
  PoolWork w;
  for (auto* a : {&w.bed, &w.depth, &w.eta, &w.volume, &w.inertia, &w.extra, &w.under, &w.rhs, &w.flux, &w.sweep,
                  &w.answer, &w.flux_v, &w.keep})
    a->assign(m.size(), 0.0f);
  for (auto* a : {&w.moved_u, &w.moved_v}) a->assign(m.size(), 0);
  for (auto& a : w.strip) a.assign(std::size_t(kPoolLanes) * (m.nx + 1), 0.0f);
  return w;
}

}  // namespace trocar::fluids
