// One step of the pool: what the cells look like, how their faces' speeds change, what passes through the faces.
// The loops along rows are in pool_kernel.inl.
#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/fluids/jet.hpp>
#include <trocar/fluids/pool.hpp>
#include <trocar/fluids/pool_kernels.hpp>

namespace trocar::fluids {
namespace {

struct Rows {
  int first, last;
  bool empty() const { return first > last; }
};

using Present = std::array<std::int32_t, 3>;  ///< of each species other than 0 where there is some

bool has_floor(const PoolModel& m, const PoolInput& in) { return in.floor.size() >= std::size_t(m.nx) * m.ny; }

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

/// @return which species there are
Present describe_cells(const PoolKernels& x, const PoolModel& m, const PoolInput& in, Rows rows, const PoolState& s,
                       PoolWork& w, FluidReport& report) {
  const bool whole = has_floor(m, in);
  if (!whole && !in.floor.empty()) report.note(FluidReport::kBadFloor, std::int32_t(in.floor.size()));
  Present any{};
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    float* bed = w.bed.data() + k0;
    if (!whole)
      std::fill_n(bed, m.nx, 0.0f);
    else if (x.lay_bed(m.nx, in.floor.data() + std::size_t(j) * m.nx, bed) != 0)
      report.note(FluidReport::kBadFloor, j * m.nx);
    x.describe(m.nx, m.height_per_pl,
               {s.blood.data() + k0, s.saline.data() + k0, s.bile.data() + k0, bed, w.volume.data() + k0,
                w.depth.data() + k0, w.eta.data() + k0},
               any.data());
  }
  return any;
}

/// The highest bed anywhere and the highest surface where the pool is at work. Column by column, so that nothing waits
/// for what is beside it.
float highest(const PoolKernels& x, const PoolModel& m, const PoolInput& in, Rows rows, PoolWork& w) {
  float* tops = w.tops.data();
  std::fill_n(tops, m.nx, in.floor.empty() ? 0.0f : -10.0f);
  std::span<const float> floor = in.floor;
  for (; !floor.empty(); floor = floor.subspan(std::min(floor.size(), std::size_t(m.nx))))
    x.raise_tops(int(std::min(floor.size(), std::size_t(m.nx))), floor.data(), 10, tops);
  for (int j = rows.first; j <= rows.last; ++j) x.raise_tops(m.nx, w.eta.data() + m.at(0, j), 1e30f, tops);
  float top = 0;  // what is not finite counts as 0
  for (int i = 0; i < m.nx; ++i) top = std::max(top, tops[i]);
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

/// From where to where along u a capsule in the pool's frame is seen from above in a row, with more than rounding may
/// misplace.
Interval seen_in_row(const Capsule& c, float y, float cell) {
  const float margin = c.radius + 0.5f * cell, dy = c.b.y - c.a.y, dx = c.b.x - c.a.x;
  float t0 = 0, t1 = 1;  // of the axis: what is no further than the radius from the row
  if (std::fabs(dy) > 1e-6f) {
    const float from = (y - margin - c.a.y) / dy, to = (y + margin - c.a.y) / dy;
    t0 = std::max(std::min(from, to), 0.0f), t1 = std::min(std::max(from, to), 1.0f);
  } else if (!(std::fabs(y - c.a.y) < margin)) {
    return {};
  }
  if (!(t0 <= t1)) return {};
  const float x0 = c.a.x + t0 * dx, x1 = c.a.x + t1 * dx;
  return {std::min(x0, x1) - margin, std::max(x0, x1) + margin};
}

/// Columns that a capsule fills stand on a bed that is higher by as much.
void lift(const PoolModel& m, const Capsule& c, Rows rows, PoolWork& w) {
  const float cell = float(m.cell);
  const auto index = [&](float x, int n) { return int(std::clamp(x / cell, -1.0f, float(n))); };
  const int j0 = std::max(index(std::min(c.a.y, c.b.y) - c.radius, m.ny), rows.first);
  const int j1 = std::min(index(std::max(c.a.y, c.b.y) + c.radius, m.ny), rows.last);
  for (int j = j0; j <= j1; ++j) {
    const float y = (float(j) + 0.5f) * cell;
    const Interval seen = seen_in_row(c, y, cell);
    if (seen.empty()) continue;
    const int i0 = std::max(index(seen.low, m.nx), 0), i1 = std::min(index(seen.high, m.nx), m.nx - 1);
    for (int i = i0; i <= i1; ++i) {
      const Interval chord = upright_chord(c, (float(i) + 0.5f) * cell, y);
      const int k = m.at(i, j);
      const float wetted = std::min(chord.high, w.eta[k]) - std::max(chord.low, w.bed[k]);
      if (chord.empty() || !(wetted > 0)) continue;
      w.bed[k] += wetted;
      w.eta[k] += wetted;
    }
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

void begin_across_v(const PoolModel& m, Rows rows, PoolWork& w) {
  std::fill_n(w.sweep.data() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.answer.data() + m.at(0, rows.first), m.nx, 0.0f);
}
void eliminate_across_v(const PoolKernels& x, const PoolModel& m, int j, PoolWork& w) {
  const int k = m.at(0, j), before = k - m.stride;
  x.eliminate(m.nx, w.under.data() + k, w.inertia.data() + before, w.inertia.data() + k, w.rhs.data() + k,
              w.sweep.data() + before, w.answer.data() + before, w.sweep.data() + k, w.answer.data() + k);
}
void substitute_across_v(const PoolKernels& x, const PoolModel& m, Rows rows, int j, PoolWork& w) {
  const int k = m.at(0, j);
  if (j < rows.last) x.substitute(m.nx, w.sweep.data() + k, w.answer.data() + k + m.stride, w.answer.data() + k);
}

// [m] that may pass a face in a step, where a shorter one is possible: half of what changes how high a mound of 36 mm
// is thrown, a third of what throws it too high.  Our choice
constexpr float kMostChurn = 0.008f;

/// How many ticks the step that begins now takes.
int ticks_of_step(const PoolModel& m, const PoolState& s) {
  int ticks = m.period;
  while (ticks > 1 && (s.churn * float(m.tick * ticks) > kMostChurn || s.tick % std::uint64_t(ticks) != 0)) ticks /= 2;
  return ticks;
}

PoolConstants constants_of(const PoolModel& m, double dt) {
  return {.g = float(m.gravity),
          .dt = float(dt),
          .per_dx = float(1 / m.cell),
          .third = float(m.vertical_inertia / 3),
          .inertia_depth = float(m.inertia_depth),
          .friction = float(m.friction),
          .viscous = float(3 * m.viscosity),
          .damping = float(m.damping),
          .fastest = float(0.5 * m.cell / dt)};
}

/// What pushes the faces of a row, and where what they carry takes them.
void push_row_u(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, const PoolFaces& a, int j,
                PoolWork& w) {
  const int k0 = m.at(0, j);
  x.look_at_faces(a, k0 + 1, k0 + m.nx, w.under.data(), w.flux.data());
  w.under[k0] = w.flux[k0] = w.flux[k0 + m.nx] = w.rhs[k0] = 0;
  x.look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
  x.push_faces(a, k0 + 1, k0 + m.nx, c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(), w.sweep.data());
}

/// Sixteen rows at a time, so that they are still at hand when they are solved. The row before them has new speeds by
/// then: its old ones are kept.
void accelerate_u(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, PoolState& s,
                  PoolWork& w) {
  PoolFaces a{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride, s.u.data()};
  const auto keep_row = [&](int j) { std::copy_n(s.u.begin() + m.at(0, j), m.stride, w.keep.begin() + m.at(0, j)); };
  keep_row(rows.first - 1);
  for (int first = rows.first; first <= rows.last; first += kPoolLanes) {
    const int last = std::min(first + kPoolLanes - 1, rows.last);
    for (int j = first; j <= last; ++j) {
      a.beside = j == first ? w.keep.data() : s.u.data();
      push_row_u(x, m, c, a, j, w);
    }
    solve_across_u(x, m, first, last, w);
    keep_row(last);
    for (int j = first; j <= last; ++j)
      x.slow_faces(m.at(1, j), m.at(m.nx, j), c, w.under.data(), w.sweep.data(), w.answer.data(), s.u.data());
  }
}

void accelerate_v(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, PoolState& s,
                  PoolWork& w) {
  const PoolFaces a{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1, s.v.data()};
  float* carried = w.flux_v.data();
  std::fill_n(w.flux.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  const auto look = [&](int j) {
    const int k0 = m.at(0, j);
    if (j > rows.first) x.look_at_faces(a, k0, k0 + m.nx, w.under.data(), w.flux.data());
    x.look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
  };
  begin_across_v(m, rows, w);
  look(rows.first);
  for (int j = rows.first + 1; j <= rows.last + 1; ++j) {  // a face is pushed when those on either side are looked at
    if (j <= rows.last) look(j);
    if (j - 1 == rows.first) continue;
    x.push_faces(a, m.at(0, j - 1), m.at(m.nx, j - 1), c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(),
                 carried);
    eliminate_across_v(x, m, j - 1, w);
  }
  for (int j = rows.last; j > rows.first; --j) {
    substitute_across_v(x, m, rows, j, w);
    x.slow_faces(m.at(0, j), m.at(m.nx, j), c, w.under.data(), carried, w.answer.data(), s.v.data());
  }
  std::fill_n(s.v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(s.v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
}

// ---- what passes

/// One species: `volume` and `flux` are those before anything has moved, so the species do not see one another. A row
/// is booked when it is known what passes on either side of it.
void move_species(const PoolKernels& x, const PoolModel& m, Rows rows, std::vector<std::int32_t>& species,
                  PoolWork& w) {
  constexpr float kFull = float(kMostInACell);
  float* keep = w.keep.data();
  std::int32_t *moved_u = w.moved_u.data(), *moved_v = w.moved_v.data();
  std::fill_n(moved_v + m.at(0, rows.first), m.nx, 0);
  std::fill_n(moved_v + m.at(0, rows.last + 1), m.nx, 0);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    x.find_shares(k0, k0 + m.nx, m.stride, w.flux.data(), w.flux_v.data(), w.volume.data(), species.data(), keep);
    moved_u[k0] = moved_u[k0 + m.nx] = 0;
    x.find_moved(k0 + 1, k0 + m.nx, 1, kFull, w.flux.data(), w.volume.data(), keep, moved_u);
    if (j == rows.first) continue;
    x.find_moved(k0, k0 + m.nx, m.stride, kFull, w.flux_v.data(), w.volume.data(), keep, moved_v);
    x.book(k0 - m.stride, k0 - m.stride + m.nx, m.stride, moved_u, moved_v, species.data());
  }
  x.book(m.at(0, rows.last), m.at(m.nx, rows.last), m.stride, moved_u, moved_v, species.data());
}

/// The most that wants to pass a face [pL].
float most_through(const PoolKernels& x, const PoolModel& m, Rows rows, PoolWork& w) {
  float* tops = w.tops.data();
  std::fill_n(tops, m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    x.raise_sizes(m.nx, w.flux.data() + m.at(0, j), tops);
    x.raise_sizes(m.nx, w.flux_v.data() + m.at(0, j), tops);
  }
  float most = 0;
  for (int i = 0; i < m.nx; ++i) most = std::max(most, tops[i]);
  return most;
}

void exchange(const PoolKernels& x, const PoolModel& m, const PoolConstants& c, Rows rows, const Present& any,
              PoolState& s, PoolWork& w) {
  const PoolFaces across_u{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride, s.u.data()};
  const PoolFaces across_v{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1, s.v.data()};
  const float pl = float(m.cell * double(c.dt) * kPicolitresPerM3);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    w.flux[k0] = w.flux[k0 + m.nx] = 0;
    x.volumes_through(across_u, k0 + 1, k0 + m.nx, c, pl, s.u.data(), w.flux.data());
    if (j > rows.first) x.volumes_through(across_v, k0, k0 + m.nx, c, pl, s.v.data(), w.flux_v.data());
  }
  s.churn = most_through(x, m, rows, w) * m.height_per_pl / c.dt;
  if (any[0] != 0) move_species(x, m, rows, s.blood, w);
  if (any[1] != 0) move_species(x, m, rows, s.saline, w);
  if (any[2] != 0) move_species(x, m, rows, s.bile, w);
}

// ---- in and out

void empty_drains(const PoolModel& m, std::span<const Drain> drains, double dt, PoolState& s, Ledger& ledger,
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
      amount = whole_picolitres(flow, dt, s.drain_carry[d]);
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
  if (s.tick != s.next) {
    ++s.tick;
    return report;
  }
  const int ticks = ticks_of_step(m, s);
  const double dt = m.tick * ticks;
  s.next += std::uint64_t(ticks);
  ++s.tick;
  empty_drains(m, in.drains, dt, s, ledger, report);
  pour_held(m, s, report);
  const Rows rows = rows_at_work(m, s);
  still_rows_outside(m, rows, s);
  const PoolKernels& x = pool_kernels();
  if (rows.empty()) {
    s.churn = 0;
    s.highest = highest(x, m, in, rows, w);
    return report;
  }
  const PoolConstants c = constants_of(m, dt);
  const Present any = describe_cells(x, m, in, rows, s, w, report);
  for (std::size_t i = 0; i < in.capsules.size(); ++i) {
    if (sound(in.capsules[i]))
      lift(m, in_frame(m, in.capsules[i]), rows, w);
    else
      report.note(FluidReport::kBadContact, std::int32_t(i));
  }
  s.highest = highest(x, m, in, rows, w);
  accelerate_u(x, m, c, rows, s, w);
  accelerate_v(x, m, c, rows, s, w);
  exchange(x, m, c, rows, any, s, w);
  return report;
}

PoolWork make_work(const PoolModel& m) {
  PoolWork w;
  for (auto* a : {&w.bed, &w.depth, &w.eta, &w.volume, &w.inertia, &w.extra, &w.under, &w.rhs, &w.flux, &w.sweep,
                  &w.answer, &w.flux_v, &w.keep})
    a->assign(m.size(), 0.0f);
  w.tops.assign(std::size_t(m.nx), 0.0f);
  for (auto* a : {&w.moved_u, &w.moved_v}) a->assign(m.size(), 0);
  for (auto& a : w.strip) a.assign(std::size_t(kPoolLanes) * (m.nx + 1), 0.0f);
  return w;
}

}  // namespace trocar::fluids
