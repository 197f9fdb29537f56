// The pool's loops, for one instruction set: TROCAR_POOL_KERNELS names the table, TROCAR_POOL_NAME what it is.
// Everything here has internal linkage and nothing comes from a header but types, so that no file shares wide code with
// another. Both sides of a choice are computed before it is made, which is what lets compilers turn the loops into
// SIMD.
#include <trocar/fluids/pool_kernels.hpp>

namespace trocar::fluids {
namespace {

constexpr float kDry = 1e-5f;               ///< less fluid than this at a face does not flow [m]
constexpr float kFastestColumn = 0.7f;      ///< share of sqrt(g h) beyond which a column's rise is held back
constexpr float kAlmostAll = 1 - 0x1p-20f;  ///< so that rounding never takes more than there is

/// The bed under a row. @return other than 0 where the floor is nonsense, which counts as 0
std::int32_t lay_bed(int n, const float* floor, float* __restrict bed) {
  std::int32_t bad = 0;
  for (int i = 0; i < n; ++i) {
    const float z = floor[i];
    const bool fine = (z > -10) & (z < 10);
    bed[i] = fine ? z : 0.0f;
    bad |= fine ? 0 : 1;
  }
  return bad;
}

void describe(int n, float height_per_pl, const PoolRow& row, std::int32_t* any) {
  const std::int32_t *blood = row.blood, *saline = row.saline, *bile = row.bile;
  float* __restrict volume = row.volume;
  float* __restrict depth = row.depth;
  float* __restrict eta = row.eta;
  const float* bed = row.bed;
  std::int32_t any_blood = 0, any_saline = 0, any_bile = 0;
  for (int i = 0; i < n; ++i) {
    any_blood |= blood[i], any_saline |= saline[i], any_bile |= bile[i];
    volume[i] = float((blood[i] + saline[i]) + bile[i]);
    depth[i] = volume[i] * height_per_pl;
    eta[i] = bed[i] + depth[i];
  }
  any[0] |= any_blood, any[1] |= any_saline, any[2] |= any_bile;
}

/// Raises the highest of each column so far to those of this row that are below `bound`.
void raise_tops(int n, const float* z, float bound, float* __restrict tops) {
  for (int i = 0; i < n; ++i) {
    const float below = z[i] < bound ? z[i] : tops[i];
    tops[i] = below > tops[i] ? below : tops[i];
  }
}

void raise_sizes(int n, const float* z, float* __restrict tops) {
  for (int i = 0; i < n; ++i) {
    const float size = z[i] > 0 ? z[i] : -z[i];
    tops[i] = size > tops[i] ? size : tops[i];
  }
}

/// How deep it is at a face, and what flows through it now, per width.
void look_at_faces(const PoolFaces& a, int k0, int k1, float* __restrict under, float* __restrict flux) {
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

/// Vertical inertia: h^3 / 3 dx^2, and N without the part that is linear in the acceleration. Where a column rises
/// faster than a share of sqrt(g h), it is held back as by a viscosity, implicitly (our choice): such columns are
/// narrower than the equations are made for, and would shoot up.
void look_at_columns(const PoolFaces& a, int k0, int k1, const PoolConstants& c, float* __restrict inertia,
                     float* __restrict extra) {
  const float *depth = a.depth, *u = a.speed;
  const std::ptrdiff_t step = a.step;
  const float scale = c.third * c.per_dx * c.per_dx, half_g = 0.5f * c.g;
  const float per_extra = 1 / (c.dt * c.per_dx), per_bound = 1 / (kFastestColumn * kFastestColumn * c.g);
  for (int k = k0; k < k1; ++k) {
    const float h = depth[k], before = u[k] - u[k - step], own = u[k + step] - u[k];
    const float after = u[k + 2 * step] - u[k + step], mean = 0.5f * (u[k] + u[k + step]);
    const float turn = mean > 0 ? own - before : after - own;
    const float tall = h < c.inertia_depth ? h : c.inertia_depth;
    const float mass = scale * ((tall * tall) * h), most = half_g * (h * h);
    const float wanted = mass * (own * own - mean * turn);
    const float bounded = wanted < most ? wanted : most;
    const float rate = own * c.per_dx;                           // -dh/dt / h
    const float too_fast = (h * rate) * (rate * per_bound) - 1;  // square of speed over its bound, less 1
    const float rising = rate < 0 ? too_fast : 0.0f;
    const float held = rising > 0 ? rising : 0.0f;
    inertia[k] = mass * (1 + held);
    extra[k] = (bounded > -most ? bounded : -most) - per_extra * (mass * held) * own;
  }
}

/// Speeds after advection, and the right side of the system for what slope and N add.
void push_faces(const PoolFaces& a, int k0, int k1, const PoolConstants& c, const float* under, const float* flux,
                const float* extra, float* __restrict rhs, float* __restrict carried) {
  const float *depth = a.depth, *eta = a.eta, *u = a.speed, *v = a.across, *beside = a.beside;
  const std::ptrdiff_t step = a.step, side = a.side;
  const float slope_gain = -c.g * c.dt * c.per_dx, extra_gain = -c.dt * c.per_dx;
  for (int k = k0; k < k1; ++k) {
    const float own = u[k], before = u[k - step], after = u[k + step], left = beside[k - side], right = u[k + side];
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

// Rows are turned in squares of four, which compilers do not find by themselves.
using Four = float __attribute__((vector_size(16)));

struct Square {
  Four row[4];
};
Square turned(const Square& q) {
  const Four a = __builtin_shufflevector(q.row[0], q.row[1], 0, 4, 1, 5);
  const Four b = __builtin_shufflevector(q.row[2], q.row[3], 0, 4, 1, 5);
  const Four c = __builtin_shufflevector(q.row[0], q.row[1], 2, 6, 3, 7);
  const Four d = __builtin_shufflevector(q.row[2], q.row[3], 2, 6, 3, 7);
  return {{__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
           __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)}};
}

/// Sixteen rows of nx to nx rows of sixteen.
void turn_in(int nx, const float* const* from, float* to) {
  for (int l = 0; l < kPoolLanes; l += 4) {
    Square q;
    int i = 0;
    for (; i + 4 <= nx; i += 4) {
      for (int r = 0; r < 4; ++r) __builtin_memcpy(&q.row[r], from[l + r] + i, sizeof(Four));
      q = turned(q);
      for (int r = 0; r < 4; ++r) __builtin_memcpy(to + (i + r) * kPoolLanes + l, &q.row[r], sizeof(Four));
    }
    for (; i < nx; ++i)
      for (int r = l; r < l + 4; ++r) to[i * kPoolLanes + r] = from[r][i];
  }
}
/// And back.
void turn_out(int nx, const float* from, float* const* to) {
  for (int l = 0; l < kPoolLanes; l += 4) {
    Square q;
    int i = 0;
    for (; i + 4 <= nx; i += 4) {
      for (int r = 0; r < 4; ++r) __builtin_memcpy(&q.row[r], from + (i + r) * kPoolLanes + l, sizeof(Four));
      q = turned(q);
      for (int r = 0; r < 4; ++r) __builtin_memcpy(to[l + r] + i, &q.row[r], sizeof(Four));
    }
    for (; i < nx; ++i)
      for (int r = l; r < l + 4; ++r) to[r][i] = from[i * kPoolLanes + r];
  }
}

/// Sixteen rows of faces across u at once: turned, so that a lane is a row. The answer stands where the turned right
/// side stood; face 0 is the wall.
void solve_strip(int nx, const PoolStrip& s) {
  float* __restrict under = s.turned_under;
  float* __restrict mass = s.turned_mass;
  float* __restrict rhs = s.turned_rhs;
  turn_in(nx, s.under, under), turn_in(nx, s.mass, mass), turn_in(nx, s.rhs, rhs);
  for (int l = 0; l < kPoolLanes; ++l) rhs[l] = s.sweep[l] = 0;
  for (int i = 1; i < nx; ++i) {
    const int k = i * kPoolLanes, b = k - kPoolLanes;
    float own[kPoolLanes];
    for (int l = 0; l < kPoolLanes; ++l) own[l] = rhs[k + l];
    eliminate(kPoolLanes, under + k, mass + b, mass + k, own, s.sweep + b, rhs + b, s.sweep + k, rhs + k);
  }
  for (int i = nx - 2; i > 0; --i)
    substitute(kPoolLanes, s.sweep + i * kPoolLanes, rhs + (i + 1) * kPoolLanes, rhs + i * kPoolLanes);
  turn_out(nx, rhs, s.answer);
}

void slow_faces(int k0, int k1, const PoolConstants& c, const float* under, const float* carried, const float* answer,
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

/// Picolitres that want to pass. Nothing climbs higher than its speed lets it, u^2 / 2 g, and half a cell [Bernoulli;
/// the half cell is our choice, for waves]: what would is stopped. Without it splashes that run together shoot up.
void volumes_through(const PoolFaces& a, int k0, int k1, const PoolConstants& c, float pl_per_flux,
                     float* __restrict speed, float* __restrict flux) {
  const float *bed = a.bed, *eta = a.eta;
  const std::ptrdiff_t step = a.step;
  const float per_2g = 0.5f / c.g, slack = 0.5f / c.per_dx;
  for (int k = k0; k < k1; ++k) {
    const float bed_low = bed[k - step], bed_high = bed[k], low = eta[k - step], high = eta[k], u = speed[k];
    const float from = u > 0 ? low : high, to = u > 0 ? high : low;
    const float deep = from - (bed_low > bed_high ? bed_low : bed_high);
    const float climbs = to - from - slack - u * u * per_2g;
    const float let = climbs > 0 ? 0.0f : u;
    speed[k] = 0.5f * (u + let);
    flux[k] = (deep > 0 ? deep : 0.0f) * let * pl_per_flux;
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

/// Whole picolitres of one species through faces. The receiver takes no more than a quarter of its room from a side,
/// all species together.
void find_moved(int k0, int k1, std::ptrdiff_t step, float most_in_a_cell, const float* flux, const float* volume,
                const float* keep, std::int32_t* __restrict moved) {
  for (int k = k0; k < k1; ++k) {
    const float q = flux[k], keep_low = keep[k - step], keep_high = keep[k];
    const float room_low = 0.25f * (most_in_a_cell - volume[k - step]),
                room_high = 0.25f * (most_in_a_cell - volume[k]);
    const float room = q > 0 ? room_high : room_low, kept = q > 0 ? keep_low : keep_high;
    const float size = q > 0 ? q : -q, fits = size < room ? size : room;
    const float in = fits > 0 ? fits * kept : 0.0f;
    const float signed_in = q > 0 ? in : -in;
    moved[k] = std::int32_t(signed_in);
  }
}

void book(int k0, int k1, int stride, const std::int32_t* moved_u, const std::int32_t* moved_v,
          std::int32_t* __restrict species) {
  for (int k = k0; k < k1; ++k) species[k] += (moved_u[k] - moved_u[k + 1]) + (moved_v[k] - moved_v[k + stride]);
}

constexpr PoolKernels kTable{.name = TROCAR_POOL_NAME,
                             .lay_bed = lay_bed,
                             .describe = describe,
                             .raise_tops = raise_tops,
                             .raise_sizes = raise_sizes,
                             .look_at_faces = look_at_faces,
                             .look_at_columns = look_at_columns,
                             .push_faces = push_faces,
                             .eliminate = eliminate,
                             .substitute = substitute,
                             .solve_strip = solve_strip,
                             .slow_faces = slow_faces,
                             .volumes_through = volumes_through,
                             .find_shares = find_shares,
                             .find_moved = find_moved,
                             .book = book};

}  // namespace

const PoolKernels* TROCAR_POOL_KERNELS() noexcept { return &kTable; }

}  // namespace trocar::fluids
