// One tick of the network: sub-steps of the chosen kernel, cells pushed open, loads taken implicitly.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <utility>

#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/law.hpp>
#include <trocar/tissue/network.hpp>

namespace trocar::tissue {
namespace {

// ---- which instruction set

bool can_run(const KernelSet* set) {
  if (!set) return false;
#if defined(__x86_64__)
  if (std::strcmp(set->name, "avx2") == 0) return __builtin_cpu_supports("avx2");
  if (std::strcmp(set->name, "avx512") == 0) {
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
           __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
  }
#endif
  return true;
}

/// The widest runnable set not above `wish` (null: no wish).
const KernelSet* choose(const char* wish) {
  const KernelSet* sets[] = {kernels_avx512(), kernels_avx2(), kernels_sse2(), kernels_generic()};
  const char* names[] = {"avx512", "avx2", "sse2", "generic"};
  int first = 0;
  for (int i = 0; wish && i < 4; ++i)
    if (std::strcmp(wish, names[i]) == 0) first = i;
  for (int i = first; i < 4; ++i)
    if (can_run(sets[i])) return sets[i];
  return kernels_generic();
}

const KernelSet*& kernels() {
  static const KernelSet* set = choose(std::getenv("TROCAR_SIMD"));
  return set;
}

// ---- cells pushed open

constexpr float kReleased = 0.2f;     // share of the rest volume at which a cell is let go
constexpr float kOpening = 0.001f;    // time constant with which it takes its shape again [s]
constexpr float kBlend = 0.3f;        // share of its nodes' velocities that one sub-step replaces
constexpr float kStill = 0.02f;       // nodes slower than this are at rest [m/s]
constexpr int kLong = 100;            // ticks at rest after which a fold is one that springs hold
constexpr float kUnfolding = 0.005f;  // as kOpening and kReleased, for such a fold
constexpr float kUnfolded = 0.7f;

Vec3f place(const NodeState& n) { return {n.x, n.y, n.z}; }
Vec3f speed(const NodeState& n) { return {n.vx, n.vy, n.vz}; }

Vec3f row_weight(const NetworkModel& m, int row) {
  const RowPack& p = m.row_packs[row / kSlice];
  return {p.wx[row % kSlice], p.wy[row % kSlice], p.wz[row % kSlice]};
}

/// x0 + dt v in the kernel's own arithmetic.
void move_to(NodeState& out, const NodeState& in, Vec3f v, float dt) {
  out.vx = v.x, out.vy = v.y, out.vz = v.z;
  out.x = in.x + dt * v.x, out.y = in.y + dt * v.y, out.z = in.z + dt * v.z;
}

/// A quarter of the cells is looked at each tick; those that collapsed stay on the list until they are open again.
void find_collapsed(const NetworkModel& m, NetworkState& s, NetworkWork& w) {
  const int packs = int(m.tet_packs.size());
  const int quarter = int(s.tick & 3u);
  const int first = int(std::int64_t(packs) * quarter / 4), last = int(std::int64_t(packs) * (quarter + 1) / 4);
  kernels()->find_collapsed(s.nodes.data(), m.tet_packs.data(), first, last, w.below.data());
  for (int p = first; p < last; ++p) {
    for (unsigned bits = w.below[p - first]; bits; bits &= bits - 1) {
      const int t = p * kSlice + __builtin_ctz(bits);
      if (s.tet_phase[t] == 0) s.tet_phase[t] = 1, ++s.open_tets;
    }
  }
}

int list_open(const NetworkState& s, NetworkWork& w) {
  int n = 0;
  if (s.open_tets == 0) return 0;
  const int count = int(s.tet_phase.size());
  for (int t = 0; t < count; ++t)
    if (s.tet_phase[t] != 0 && s.tet_phase[t] != kGone) w.open_tets[n++] = t;
  return n;
}

/// How the body as a whole has turned since it was drawn: the rotation that fits all nodes best, by mass. Found by
/// turning the frame against what is left, as in [Muller et al. 2016]; steps normalised instead of exact, which only
/// changes how soon it converges.
Mat3d turn_of_body(const NetworkModel& m, const NetworkState& s) {
  constexpr int kRounds = 20;
  Vec3d now{}, drawn{};
  double mass = 0;
  for (int i = 0; i < m.nodes; ++i) {
    mass += m.mass[i];
    now += m.mass[i] * position(m, s, i);
    drawn += m.mass[i] * m.rest[i];
  }
  now = now / mass, drawn = drawn / mass;
  Vec3d moment[3] = {};  // columns of sum m (x - c) (X - C)^T
  for (int i = 0; i < m.nodes; ++i) {
    const Vec3d x = position(m, s, i) - now, at = m.rest[i] - drawn;
    for (int k = 0; k < 3; ++k) moment[k] += (m.mass[i] * at[k]) * x;
  }
  Quatd turn;
  for (int round = 0; round < kRounds; ++round) {
    const Mat3d r = to_mat3(turn);
    Vec3d off{};
    double fit = 0;
    for (int k = 0; k < 3; ++k) {
      off += cross(r.column(k), moment[k]);
      fit += dot(r.column(k), moment[k]);
    }
    const double size = std::fabs(fit) + 1e-30;
    turn = normalised(Quatd{1, 0.5 * off.x / size, 0.5 * off.y / size, 0.5 * off.z / size} * turn);
  }
  return to_mat3(turn);
}

/// A fold's cells must unfold together, or one pulls the other back: all do so in the last quarter of 256 ticks.
bool unfolds_now(const NetworkState& s) { return (s.tick & 255u) >= 192; }

/// Each listed cell goes back to its drawn shape, turned as the body is: in cell after cell the velocities come nearer
/// to those of a cell that takes its shape within kOpening. As all cells agree on the turn, neighbours do not undo each
/// other's work. A velocity that is partly replaced cannot be pumped up without end, as impulses along the volume's
/// gradient were where cells are nearly flat. Momentum is conserved.
///
/// Springs can withstand that: a corner that was pushed through its cell to the far side of it lies in a minimum of
/// their energy. So a cell that has been folded and at rest for kLong is driven slowly, and with its velocities
/// replaced altogether: springs then only move it as a whole. Where the way home begins is read before the sub-step;
/// the place that springs have just predicted overshoots where they are stiff, and driving from there goes astray.
void push_open(const NetworkModel& m, const NetworkState& s, std::span<const int> open, const Mat3d& turn,
               const NodeState* in, NodeState* out) {
  const float dt = float(m.dt);
  const bool unfolding = unfolds_now(s);
  for (int t : open) {
    const int* r = m.tets[t].row;
    const bool stuck = unfolding && s.tet_phase[t] >= kLong;
    const float blend = stuck ? 1 : kBlend, opening = stuck ? kUnfolding : kOpening;
    Vec3f centre{}, drift{};
    Vec3d drawn{};
    float mass = 0;
    for (int i = 0; i < 4; ++i) {
      const int node = m.node_of_row[r[i]];
      const float w = float(m.mass[node]);
      centre += w * place(in[r[i]]);
      drift += w * speed(out[r[i]]);
      drawn += m.mass[node] * m.rest[node];
      mass += w;
    }
    centre = centre / mass, drift = drift / mass, drawn = drawn / double(mass);
    for (int i = 0; i < 4; ++i) {
      const Vec3f goal = centre + vec_cast<float>(turn * (m.rest[m.node_of_row[r[i]]] - drawn));
      const Vec3f wanted = drift + (goal - place(in[r[i]])) / opening, w = row_weight(m, r[i]);
      Vec3f v = speed(out[r[i]]);
      for (int k = 0; k < 3; ++k)
        if (w[k] > 0) v[k] += blend * (wanted[k] - v[k]);
      move_to(out[r[i]], in[r[i]], v, dt);
    }
  }
}

bool at_rest(const NodeState& n) { return dot(speed(n), speed(n)) < kStill * kStill; }

/// Lets go the cells that are open, and counts for how long the others have been at rest.
void release_open(const NetworkModel& m, std::span<const int> open, NetworkState& s) {
  const bool unfolding = unfolds_now(s);
  for (int t : open) {
    std::uint8_t& phase = s.tet_phase[t];
    const int* r = m.tets[t].row;
    const Vec3f o = place(s.nodes[r[0]]);
    const Vec3f a = place(s.nodes[r[1]]) - o, b = place(s.nodes[r[2]]) - o, c = place(s.nodes[r[3]]) - o;
    const float enough = unfolding && phase >= kLong ? kUnfolded : kReleased;
    if (dot(a, cross(b, c)) > enough * m.tets[t].rest6) {
      phase = 0, --s.open_tets;
    } else if (!unfolding) {
      const bool rests =
          at_rest(s.nodes[r[0]]) && at_rest(s.nodes[r[1]]) && at_rest(s.nodes[r[2]]) && at_rest(s.nodes[r[3]]);
      phase = !rests ? 1 : (phase < kOldestFold ? std::uint8_t(phase + 1) : phase);
    }
  }
}

// ---- nodes that leap

constexpr float kLeap = 20;     // faster than anything that hands do to tissue [m/s]
constexpr float kCaught = 2;    // [m/s]
constexpr int kMostLeaps = 64;  // caught in one tick, the lowest rows first

/// Was it held to kCaught in the last sub-step? Its speed itself says so; let go for a tick, it would leap again.
bool is_caught(float square) { return std::fabs(square - kCaught * kCaught) < 1e-4f * kCaught * kCaught; }

/// In the same ticks as folds are unfolded: a node that was merely thrown has come to rest by then.
int list_fast(const NetworkModel& m, const NetworkState& s, int* rows) {
  int n = 0;
  if (!unfolds_now(s)) return 0;
  for (int r = 0; r < m.rows && n < kMostLeaps; ++r) {
    const float square = dot(speed(s.nodes[r]), speed(s.nodes[r]));
    if (square > kLeap * kLeap || is_caught(square)) rows[n++] = r;
  }
  return n;
}

/// The time step is stable where springs point as drawn. A light node that was thrown out of its place has all of them
/// on one side, together stiffer than the step bears: it can leap to and fro for ever, through its neighbours and back.
/// One that is so fast and turns round within a sub-step is held to steps within which it finds its place again. That
/// only takes energy away; the node's own momentum goes with it, as giving that to its neighbours fed other leaps.
void catch_leaps(const NetworkModel& m, std::span<const int> rows, const NodeState* in, NodeState* out) {
  for (int r : rows) {
    const Vec3f v = speed(out[r]), before = speed(in[r]);
    const float fast = std::sqrt(dot(v, v));
    if (fast > 2 * kCaught && (is_caught(dot(before, before)) || dot(v, before) < 0))
      move_to(out[r], in[r], (kCaught / fast) * v, float(m.dt));
  }
}

// ---- loads

bool usable(const NetworkModel& m, const NodeLoad& l) {
  const float sum = ((std::fabs(l.f0.x) + std::fabs(l.f0.y)) + std::fabs(l.f0.z)) +
                    ((std::fabs(l.x0.x) + std::fabs(l.x0.y)) + std::fabs(l.x0.z)) +
                    ((std::fabs(l.dir.x) + std::fabs(l.dir.y)) + std::fabs(l.dir.z));
  return l.node >= 0 && l.node < m.nodes && l.k >= 0 && l.d >= 0 && l.k < 1e12f && l.d < 1e12f && sum < 1e12f;
}

/// a x = b for a symmetric positive definite 3x3 matrix given as xx, yy, zz, xy, xz, yz: LDL^T.
Vec3d solve3(const double a[6], Vec3d b) {
  const double l10 = a[3] / a[0], l20 = a[4] / a[0];
  const double d1 = a[1] - l10 * a[3];
  const double e21 = a[5] - l20 * a[3];
  const double l21 = e21 / d1;
  const double d2 = a[2] - l20 * a[4] - l21 * e21;
  const double y1 = b.y - l10 * b.x, y2 = b.z - l20 * b.x - l21 * y1;
  const double z = y2 / d2;
  const double y = y1 / d1 - l21 * z;
  return {b.x / a[0] - l10 * y - l20 * z, y, z};
}

bool is_zero(Vec3f a) { return a.x == 0 && a.y == 0 && a.z == 0; }

/// P u of a load.
Vec3d along(const NodeLoad& l, Vec3d u) {
  if (is_zero(l.dir)) return u;
  const Vec3d n = vec_cast<double>(l.dir);
  return dot(n, u) * n;
}

/// The loads of one node: (m (1 + dt gamma) + dt D + dt^2 K) v = m (1 + dt gamma) v_free + dt (f0 + K (x0 - x)),
/// held axes left out. Adds each load's mean force to `reactions`. False where the result is not finite.
bool apply_loads(const NetworkModel& m, std::span<const NodeLoad> loads, Vec3f* reactions, const NodeState& in,
                 NodeState& out) {
  const int node = loads[0].node;
  const double dt = m.dt, mass = m.mass[node] * (1 + dt * m.gamma);
  const Vec3d x = vec_cast<double>(place(in)), free_v = vec_cast<double>(speed(out));
  double a[6] = {mass, mass, mass, 0, 0, 0};
  Vec3d b = mass * free_v;
  for (const NodeLoad& l : loads) {
    const Vec3d reach = (vec_cast<double>(l.x0) - m.origin) - x;
    const double q = dt * (double(l.d) + dt * double(l.k));
    b += dt * (vec_cast<double>(l.f0) + double(l.k) * along(l, reach));
    const Vec3d n = vec_cast<double>(l.dir);
    if (is_zero(l.dir)) {
      a[0] += q, a[1] += q, a[2] += q;
    } else {
      a[0] += q * n.x * n.x, a[1] += q * n.y * n.y, a[2] += q * n.z * n.z;
      a[3] += q * n.x * n.y, a[4] += q * n.x * n.z, a[5] += q * n.y * n.z;
    }
  }
  const int held = m.fixed[node];
  if (held != kFree) {
    // A held axis keeps its velocity: move its column to the right side, put 1 on its diagonal.
    const int cross_of[3][2] = {{3, 4}, {3, 5}, {4, 5}}, other[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    for (int i = 0; i < 3; ++i) {
      if (!(held & (1 << i))) continue;
      for (int j = 0; j < 2; ++j) {
        b[other[i][j]] -= a[cross_of[i][j]] * free_v[i];
        a[cross_of[i][j]] = 0;
      }
      a[i] = 1;
      b[i] = free_v[i];
    }
    for (int i = 0; i < 3; ++i)
      if (held & (1 << i)) b[i] = free_v[i];
  }
  const bool isotropic = a[3] == 0 && a[4] == 0 && a[5] == 0;  // most are: spare the elimination
  const Vec3d v = isotropic ? Vec3d{b.x / a[0], b.y / a[1], b.z / a[2]} : solve3(a, b);
  move_to(out, in, vec_cast<float>(v), float(dt));
  const bool fine = std::fabs(v.x) + std::fabs(v.y) + std::fabs(v.z) < 1e6;
  if (!reactions) return fine;
  const double share = 1.0 / m.substeps;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const NodeLoad& l = loads[i];
    const Vec3d reach = (vec_cast<double>(l.x0) - m.origin) - (x + dt * v);
    const Vec3d force = vec_cast<double>(l.f0) + along(l, double(l.k) * reach - double(l.d) * v);
    reactions[i] += vec_cast<float>(share * force);
  }
  return fine;
}

bool apply_all_loads(const NetworkModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions,
                     const NodeState* in, NodeState* out) {
  bool fine = true;
  for (std::size_t i = 0; i < loads.size();) {
    std::size_t end = i + 1;
    if (!usable(m, loads[i])) {
      i = end;
      continue;
    }
    while (end < loads.size() && loads[end].node == loads[i].node && usable(m, loads[end])) ++end;
    const int row = m.row_of_node[loads[i].node];
    Vec3f* reaction = reactions.empty() ? nullptr : reactions.data() + i;
    fine = apply_loads(m, loads.subspan(i, end - i), reaction, in[row], out[row]) && fine;
    i = end;
  }
  return fine;
}

StepReport check_loads(const NetworkModel& m, std::span<const NodeLoad> loads) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (!usable(m, loads[i]) || (i > 0 && loads[i].node < loads[i - 1].node)) return {StepReport::kBadLoad, int(i)};
  }
  return {};
}

// ---- the tick

KernelArgs kernel_args(const NetworkModel& m, const NetworkState& s) {
  KernelArgs a;
  a.packs = m.packs.data();
  a.laws = m.law_packs.empty() ? nullptr : m.law_packs.data();
  a.scale = s.version == 0 ? nullptr : s.scale.data();
  a.rows = m.row_packs.data();
  a.slice_begin = m.slice_begin.data();
  a.p1 = m.p1, a.p2 = m.p2, a.cap = m.cap, a.cap_slope = m.cap_slope;
  a.decay = m.decay;
  for (int i = 0; i < 3; ++i) a.gravity_step[i] = m.gravity_step[i];
  a.dt = float(m.dt);
  return a;
}

constexpr int kSlicesPerThread = 24;  // below this a thread's wake-up costs more than it saves

bool run_substep(const KernelArgs& a, int slices, core::ThreadPool* pool) {
  const int parts = pool ? pool->threads() : 1;
  if (parts < 2 || slices < parts * kSlicesPerThread) return kernels()->substep(a, 0, slices);
  constexpr int kMost = 64;
  const int n = parts < kMost ? parts : kMost;
  bool fine[kMost];
  core::run(*pool, n, [&](int i) noexcept {
    fine[i] = kernels()->substep(a, int(std::int64_t(slices) * i / n), int(std::int64_t(slices) * (i + 1) / n));
  });
  bool all = true;
  for (int i = 0; i < n; ++i) all = all && fine[i];
  return all;
}

int first_non_finite(const NetworkModel& m, const NetworkState& s) {
  for (int i = 0; i < m.nodes; ++i) {
    const NodeState& n = s.nodes[m.row_of_node[i]];
    const float size =
        ((std::fabs(n.x) + std::fabs(n.y)) + std::fabs(n.z)) + ((std::fabs(n.vx) + std::fabs(n.vy)) + std::fabs(n.vz));
    if (!(size < 1e6f)) return i;
  }
  return -1;
}

}  // namespace

const char* simd_name() noexcept { return kernels()->name; }

bool set_simd(const std::string& name) noexcept {
  for (const KernelSet* set : {kernels_generic(), kernels_sse2(), kernels_avx2(), kernels_avx512()}) {
    if (set && name == set->name && can_run(set)) {
      kernels() = set;
      return true;
    }
  }
  return false;
}

StepReport advance(const NetworkModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, NetworkState& s,
                   NetworkWork& w, core::ThreadPool* pool) noexcept {
  StepReport report = check_loads(m, loads);
  for (Vec3f& r : reactions) r = {};
  find_collapsed(m, s, w);
  const std::span<const int> open(w.open_tets.data(), std::size_t(list_open(s, w)));
  Mat3d turn = Mat3d::identity();
  if (!open.empty()) {
    report.flags |= StepReport::kInverted;
    turn = turn_of_body(m, s);
  }

  int fast_rows[kMostLeaps];
  const std::span<const int> fast(fast_rows, std::size_t(list_fast(m, s, fast_rows)));
  KernelArgs args = kernel_args(m, s);
  bool fine = true;
  for (int i = 0; i < m.substeps; ++i) {
    args.in = s.nodes.data();
    args.out = w.other.data();
    fine = run_substep(args, m.rows / kSlice, pool) && fine;
    push_open(m, s, open, turn, args.in, args.out);
    catch_leaps(m, fast, args.in, args.out);
    fine = apply_all_loads(m, loads, reactions, args.in, args.out) && fine;
    std::swap(s.nodes, w.other);
  }
  release_open(m, open, s);
  ++s.tick;
  if (!fine) report = StepReport{StepReport::kNonFinite, first_non_finite(m, s)} | report;
  return report;
}

}  // namespace trocar::tissue
