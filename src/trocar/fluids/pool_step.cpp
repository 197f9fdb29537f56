// One step of the pool: what the cells look like, how their faces' speeds change, what passes through the faces.
// Every loop below goes along a row of cells or faces, each lane on its own, so that any SIMD width gives the same
// bits.
//
// In the arrays, face k lies between the cells k - step and k, step being 1 for faces across u and the stride for faces
// across v; walls are faces (and the spare cell at the end of each row) that stay 0.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <trocar/fluids/jet.hpp>
#include <trocar/fluids/pool.hpp>

namespace trocar::fluids {
namespace {

constexpr float kDry = 1e-5f;               ///< less fluid than this at a face does not flow [m]
constexpr float kAlmostAll = 1 - 0x1p-20f;  ///< so that rounding never takes more than there is
constexpr int kLanes = 16;

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

void describe_row(int k0, int n, float height_per_pl, const PoolState& s, PoolWork& w) {
  const std::int32_t *blood = s.blood.data() + k0, *saline = s.saline.data() + k0, *bile = s.bile.data() + k0;
  float* __restrict volume = w.volume.data() + k0, * __restrict depth = w.depth.data() + k0;
  float* __restrict eta = w.eta.data() + k0;
  const float* bed = w.bed.data() + k0;
  for (int i = 0; i < n; ++i) {
    volume[i] = float((blood[i] + saline[i]) + bile[i]);
    depth[i] = volume[i] * height_per_pl;
    eta[i] = bed[i] + depth[i];
  }
}

void describe_cells(const PoolModel& m, const PoolInput& in, Rows rows, const PoolState& s, PoolWork& w,
                    FluidReport& report) {
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
    describe_row(k0, m.nx, m.height_per_pl, s, w);
  }
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

struct Constants {
  float g, dt, per_dx, third;
  float friction, viscous, damping, fastest;
};

struct FaceArrays {
  const float *bed, *depth, *eta, *speed, *across;
  std::ptrdiff_t step, side;
};

/// How deep it is at a face, and what flows through it now, per width.
void look_at_faces(const FaceArrays& a, int k0, int k1, float* __restrict under, float* __restrict flux) {
  const float *bed = a.bed, *eta = a.eta, *speed = a.speed;
  const std::ptrdiff_t step = a.step;
  for (int k = k0; k < k1; ++k) {
    const float low = eta[k - step], high = eta[k];
    const float bed_low = bed[k - step], bed_high = bed[k];
    const float sill = bed_low > bed_high ? bed_low : bed_high;
    const float top = (low > high ? low : high) - sill;
    under[k] = top > 0 ? top : 0.0f;
    const float from = (speed[k] > 0 ? low : high) - sill;
    flux[k] = (from > 0 ? from : 0.0f) * speed[k];
  }
}

/// Vertical inertia: h^3 / 3 dx^2, and N without the part that is linear in the acceleration.
void look_at_columns(const FaceArrays& a, int k0, int k1, const Constants& c, float* __restrict inertia,
                     float* __restrict extra) {
  const float *depth = a.depth, *u = a.speed;
  const std::ptrdiff_t step = a.step;
  const float scale = c.third * c.per_dx * c.per_dx, half_g = 0.5f * c.g;
  for (int k = k0; k < k1; ++k) {
    const float h = depth[k], before = u[k] - u[k - step], own = u[k + step] - u[k];
    const float after = u[k + 2 * step] - u[k + step], mean = 0.5f * (u[k] + u[k + step]);
    const float turn = mean > 0 ? own - before : after - own;
    const float mass = scale * ((h * h) * h), most = half_g * (h * h);
    const float wanted = mass * (own * own - mean * turn);
    const float bounded = wanted < most ? wanted : most;
    inertia[k] = mass;
    extra[k] = bounded > -most ? bounded : -most;
  }
}

/// Speeds after advection, and the right side of the system for what slope and N add.
void push_faces(const FaceArrays& a, int k0, int k1, const Constants& c, const float* under, const float* flux,
                const float* extra, float* __restrict rhs, float* __restrict carried) {
  const float *depth = a.depth, *eta = a.eta, *u = a.speed, *v = a.across;
  const std::ptrdiff_t step = a.step, side = a.side;
  const float slope_gain = -c.g * c.dt * c.per_dx, extra_gain = -c.dt * c.per_dx;
  for (int k = k0; k < k1; ++k) {
    const float own = u[k], before = u[k - step], after = u[k + step], left = u[k - side], right = u[k + side];
    const float out = 0.5f * (flux[k] + flux[k + step]), in = 0.5f * (flux[k - step] + flux[k]);
    const float u_out = out > 0 ? own : after, u_in = in > 0 ? before : own;
    const float mean = 0.5f * (depth[k - step] + depth[k]);
    const float deep = mean > kDry ? mean : kDry;
    const float along = ((out * u_out - in * u_in) - own * (out - in)) / deep;
    const float cross_speed = 0.25f * ((v[k] + v[k - step]) + (v[k + side] + v[k + side - step]));
    const float from_left = own - left, from_right = right - own;
    const float turn = cross_speed > 0 ? from_left : from_right;
    const float moved = own - c.dt * c.per_dx * (along + cross_speed * turn);
    const float pushed = under[k] * (slope_gain * (eta[k] - eta[k - step])) + extra_gain * (extra[k] - extra[k - step]);
    const float wet = under[k] > kDry ? 1.0f : 0.0f;
    rhs[k] = wet * pushed;
    carried[k] = wet * moved;
  }
}

/// Elimination of one row of faces, the row before it being done: for each lane
///   (under + mass + mass_before) d - mass_before d_before - mass d_after = rhs
void eliminate(int n, const float* under, const float* mass_before, const float* mass, const float* rhs,
               const float* sweep_before, const float* answer_before, float* __restrict sweep,
               float* __restrict answer) {
  for (int k = 0; k < n; ++k) {
    const bool wet = under[k] > kDry;
    const float pivot = ((under[k] + mass[k]) + mass_before[k]) - mass_before[k] * sweep_before[k];
    const float per_pivot = wet ? 1 / pivot : 0.0f;
    sweep[k] = mass[k] * per_pivot;
    answer[k] = (rhs[k] + mass_before[k] * answer_before[k]) * per_pivot;
  }
}
void substitute(int n, const float* sweep, const float* answer_after, float* __restrict answer) {
  for (int k = 0; k < n; ++k) answer[k] = answer[k] + sweep[k] * answer_after[k];
}

/// Sixteen rows of faces across u at once: turned, so that a lane is a row.
void solve_strip(const PoolModel& m, int j0, int last, PoolWork& w) {
  float *under = w.strip[0].data(), *mass = w.strip[1].data(), *rhs = w.strip[2].data(), *sweep = w.strip[3].data();
  int from[kLanes];
  for (int l = 0; l < kLanes; ++l) from[l] = m.at(0, std::min(j0 + l, last));
  for (int l = 0; l < kLanes; ++l)
    for (int i = 0; i < m.nx; ++i) {
      under[i * kLanes + l] = w.under[from[l] + i];
      mass[i * kLanes + l] = w.inertia[from[l] + i];
      rhs[i * kLanes + l] = w.rhs[from[l] + i];
    }
  std::fill_n(rhs, kLanes, 0.0f);  // the wall; the answer stands where the right side stood
  std::fill_n(sweep, kLanes, 0.0f);
  for (int i = 1; i < m.nx; ++i) {
    const int k = i * kLanes, b = k - kLanes;
    alignas(64) float r[kLanes];
    for (int l = 0; l < kLanes; ++l) r[l] = rhs[k + l];
    eliminate(kLanes, under + k, mass + b, mass + k, r, sweep + b, rhs + b, sweep + k, rhs + k);
  }
  for (int i = m.nx - 2; i > 0; --i) substitute(kLanes, sweep + i * kLanes, rhs + (i + 1) * kLanes, rhs + i * kLanes);
  for (int l = 0; l < kLanes; ++l)
    for (int i = 1; i < m.nx; ++i) w.answer[from[l] + i] = rhs[i * kLanes + l];
}

void solve_across_v(const PoolModel& m, Rows rows, PoolWork& w) {
  const int s = m.stride;
  const auto row = [&](std::vector<float>& a, int j) { return a.data() + m.at(0, j); };
  std::fill_n(row(w.sweep, rows.first), m.nx, 0.0f);
  std::fill_n(row(w.answer, rows.first), m.nx, 0.0f);
  for (int j = rows.first + 1; j <= rows.last; ++j) {
    float* answer = row(w.answer, j);
    eliminate(m.nx, row(w.under, j), row(w.inertia, j - 1), row(w.inertia, j), row(w.rhs, j), row(w.sweep, j - 1),
              answer - s, row(w.sweep, j), answer);
  }
  for (int j = rows.last - 1; j > rows.first; --j)
    substitute(m.nx, row(w.sweep, j), row(w.answer, j + 1), row(w.answer, j));
}

void slow_faces(int k0, int k1, const Constants& c, const float* under, const float* carried, const float* answer,
                float* __restrict speed) {
  for (int k = k0; k < k1; ++k) {
    const bool wet = under[k] > kDry;
    const float deep = wet ? under[k] : 1.0f, u = carried[k] + answer[k];
    const float size = u > 0 ? u : -u;
    const float slowed = u / (1 + c.dt * ((c.friction * size / deep + c.viscous / (deep * deep)) + c.damping));
    const float below = slowed < c.fastest ? slowed : c.fastest;
    const float bounded = below > -c.fastest ? below : -c.fastest;
    speed[k] = wet ? bounded : 0.0f;
  }
}

Constants constants_of(const PoolModel& m) {
  return {.g = float(m.gravity),
          .dt = float(m.dt()),
          .per_dx = float(1 / m.cell),
          .third = float(m.vertical_inertia / 3),
          .friction = float(m.friction),
          .viscous = float(3 * m.viscosity),
          .damping = float(m.damping),
          .fastest = m.fastest};
}

void accelerate_u(const PoolModel& m, const Constants& c, Rows rows, PoolState& s, PoolWork& w) {
  const FaceArrays a{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride};
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    look_at_faces(a, k0 + 1, k0 + m.nx, w.under.data(), w.flux.data());
    w.under[k0] = w.flux[k0] = w.flux[k0 + m.nx] = w.rhs[k0] = 0;
    look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
    push_faces(a, k0 + 1, k0 + m.nx, c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(), w.sweep.data());
  }
  for (int j = rows.first; j <= rows.last; j += kLanes) solve_strip(m, j, rows.last, w);
  for (int j = rows.first; j <= rows.last; ++j)
    slow_faces(m.at(1, j), m.at(m.nx, j), c, w.under.data(), w.sweep.data(), w.answer.data(), s.u.data());
}

void accelerate_v(const PoolModel& m, const Constants& c, Rows rows, PoolState& s, PoolWork& w) {
  const FaceArrays a{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1};
  float* carried = w.flux_v.data();
  std::fill_n(w.flux.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    if (j > rows.first) look_at_faces(a, k0, k0 + m.nx, w.under.data(), w.flux.data());
    look_at_columns(a, k0, k0 + m.nx, c, w.inertia.data(), w.extra.data());
  }
  for (int j = rows.first + 1; j <= rows.last; ++j)
    push_faces(a, m.at(0, j), m.at(m.nx, j), c, w.under.data(), w.flux.data(), w.extra.data(), w.rhs.data(), carried);
  solve_across_v(m, rows, w);
  for (int j = rows.first + 1; j <= rows.last; ++j)
    slow_faces(m.at(0, j), m.at(m.nx, j), c, w.under.data(), carried, w.answer.data(), s.v.data());
  std::fill_n(s.v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(s.v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
}

// ---- what passes

void volumes_through(const FaceArrays& a, int k0, int k1, float pl_per_flux, float* __restrict flux) {
  const float *bed = a.bed, *eta = a.eta, *speed = a.speed;
  const std::ptrdiff_t step = a.step;
  for (int k = k0; k < k1; ++k) {
    const float bed_low = bed[k - step], bed_high = bed[k], low = eta[k - step], high = eta[k];
    const float from = (speed[k] > 0 ? low : high) - (bed_low > bed_high ? bed_low : bed_high);
    flux[k] = (from > 0 ? from : 0.0f) * speed[k] * pl_per_flux;
  }
}

/// What part of each picolitre that wants to leave a cell is of one species.
void find_shares(int k0, int k1, int stride, const float* flux_u, const float* flux_v, const float* volume,
                 const std::int32_t* species, float* __restrict keep) {
  const auto positive = [](float q) { return q > 0 ? q : 0.0f; };
  for (int k = k0; k < k1; ++k) {
    const float out =
        (positive(flux_u[k + 1]) + positive(-flux_u[k])) + (positive(flux_v[k + stride]) + positive(-flux_v[k]));
    const float own = volume[k] > 1 ? volume[k] : 1.0f;
    const float most = out > own ? out : own;
    keep[k] = kAlmostAll * (float(species[k]) / most);
  }
}

/// Whole picolitres of one species through faces. The receiver takes no more than a quarter of its room from a side.
void find_moved(int k0, int k1, std::ptrdiff_t step, const float* flux, const float* volume, const float* keep,
                std::int32_t* __restrict moved) {
  constexpr float kFull = float(kMostInACell);
  for (int k = k0; k < k1; ++k) {
    const float q = flux[k], keep_low = keep[k - step], keep_high = keep[k];
    const float room_low = 0.25f * (kFull - volume[k - step]), room_high = 0.25f * (kFull - volume[k]);
    const float room = q > 0 ? room_high : room_low, kept = q > 0 ? keep_low : keep_high;
    const float some = (q > 0 ? q : -q) * kept;
    const float fits = some < room ? some : room;
    const float in = fits > 0 ? fits : 0.0f;
    const float signed_in = q > 0 ? in : -in;
    moved[k] = std::int32_t(signed_in);
  }
}

void book_row(int k0, int n, int stride, const std::int32_t* moved_u, const std::int32_t* moved_v,
              std::int32_t* __restrict species) {
  for (int k = k0; k < k0 + n; ++k) species[k] += (moved_u[k] - moved_u[k + 1]) + (moved_v[k] - moved_v[k + stride]);
}

bool any_of(const PoolModel& m, Rows rows, const std::vector<std::int32_t>& species) {
  std::int32_t any = 0;
  for (int k = m.at(0, rows.first); k < m.at(m.nx, rows.last); ++k) any |= species[k];
  return any != 0;
}

/// One species: `volume` and `flux` are those before anything has moved, so the species do not see one another.
void move_species(const PoolModel& m, Rows rows, std::vector<std::int32_t>& species, PoolWork& w) {
  if (!any_of(m, rows, species)) return;
  float* keep = w.keep.data();
  std::int32_t *moved_u = w.moved_u.data(), *moved_v = w.moved_v.data();
  for (int j = rows.first; j <= rows.last; ++j)
    find_shares(m.at(0, j), m.at(m.nx, j), m.stride, w.flux.data(), w.flux_v.data(), w.volume.data(), species.data(),
                keep);
  std::fill_n(moved_v + m.at(0, rows.first), m.nx, 0);
  std::fill_n(moved_v + m.at(0, rows.last + 1), m.nx, 0);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    moved_u[k0] = moved_u[k0 + m.nx] = 0;
    find_moved(k0 + 1, k0 + m.nx, 1, w.flux.data(), w.volume.data(), keep, moved_u);
    if (j > rows.first) find_moved(k0, k0 + m.nx, m.stride, w.flux_v.data(), w.volume.data(), keep, moved_v);
  }
  for (int j = rows.first; j <= rows.last; ++j) book_row(m.at(0, j), m.nx, m.stride, moved_u, moved_v, species.data());
}

void exchange(const PoolModel& m, Rows rows, PoolState& s, PoolWork& w) {
  const FaceArrays across_u{w.bed.data(), w.depth.data(), w.eta.data(), s.u.data(), s.v.data(), 1, m.stride};
  const FaceArrays across_v{w.bed.data(), w.depth.data(), w.eta.data(), s.v.data(), s.u.data(), m.stride, 1};
  const float pl = float(m.cell * m.dt() * kPicolitresPerM3);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.first), m.nx, 0.0f);
  std::fill_n(w.flux_v.begin() + m.at(0, rows.last + 1), m.nx, 0.0f);
  for (int j = rows.first; j <= rows.last; ++j) {
    const int k0 = m.at(0, j);
    w.flux[k0] = w.flux[k0 + m.nx] = 0;
    volumes_through(across_u, k0 + 1, k0 + m.nx, pl, w.flux.data());
    if (j > rows.first) volumes_through(across_v, k0, k0 + m.nx, pl, w.flux_v.data());
  }
  for (std::vector<std::int32_t>* species : {&s.blood, &s.saline, &s.bile}) move_species(m, rows, *species, w);
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
  if (rows.empty()) return report;
  const Constants c = constants_of(m);
  describe_cells(m, in, rows, s, w, report);
  for (std::size_t i = 0; i < in.capsules.size(); ++i) {
    if (sound(in.capsules[i]))
      lift(m, in_frame(m, in.capsules[i]), rows, w);
    else
      report.note(FluidReport::kBadContact, std::int32_t(i));
  }
  accelerate_u(m, c, rows, s, w);
  accelerate_v(m, c, rows, s, w);
  exchange(m, rows, s, w);
  return report;
}

PoolWork make_work(const PoolModel& m) {
  PoolWork w;
  for (auto* a : {&w.bed, &w.depth, &w.eta, &w.volume, &w.inertia, &w.extra, &w.under, &w.rhs, &w.flux, &w.sweep,
                  &w.answer, &w.flux_v, &w.keep})
    a->assign(m.size(), 0.0f);
  for (auto* a : {&w.moved_u, &w.moved_v}) a->assign(m.size(), 0);
  for (auto& a : w.strip) a.assign(std::size_t(kLanes) * (m.nx + 1), 0.0f);
  return w;
}

}  // namespace trocar::fluids
