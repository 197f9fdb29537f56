// One tick of the network: sub-steps of the chosen kernel, cells pushed open, loads taken implicitly.
#include <cmath>
#include <utility>

#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/law.hpp>
#include <trocar/tissue/network.hpp>
#include <trocar/tissue/network_kernels.hpp>
#include <trocar/tissue/network_loads.hpp>

namespace trocar::tissue {
namespace {

// ---- cells pushed open

constexpr float kReleased = 0.2f;     // share of the rest volume at which a cell is let go
constexpr float kOpening = 0.001f;    // time constant with which it takes its shape again [s]
constexpr float kBlend = 0.3f;        // share of its nodes' velocities that one sub-step replaces
constexpr float kStill = 0.02f;       // nodes slower than this are at rest [m/s]
constexpr int kLong = 100;            // ticks at rest after which a fold is one that springs hold
constexpr float kUnfolding = 0.005f;  // as kOpening and kReleased, for such a fold
constexpr float kUnfolded = 0.7f;

Vec3f row_weight(const NetworkModel& m, int row) {
  const RowPack& p = m.row_packs[row / kSlice];
  return {p.wx[row % kSlice], p.wy[row % kSlice], p.wz[row % kSlice]};
}

/// A quarter of the cells is looked at each tick; those that collapsed stay on the list until they are open again.
void find_collapsed(const NetworkModel& m, NetworkState& s, NetworkWork& w) {
  const int packs = int(m.tet_packs.size());
  const int quarter = int(s.tick & 3u);
  const int first = int(std::int64_t(packs) * quarter / 4), last = int(std::int64_t(packs) * (quarter + 1) / 4);
  kernels().find_collapsed(s.nodes.data(), m.tet_packs.data(), first, last, w.below.data());
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

// ---- nodes that leap, and parts that flap

constexpr float kLeap = 20;     // faster than anything that hands do to tissue [m/s]
constexpr float kCaught = 2;    // [m/s]
constexpr int kMostLeaps = 64;  // caught in one tick, the lowest rows first
constexpr float kCalm = 2;      // [m/s]

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

Vec3f drift_of(const NetworkModel& m, const NetworkState& s) {
  Vec3d momentum{};
  double mass = 0;
  for (int i = 0; i < m.nodes; ++i) {
    momentum += m.mass[i] * velocity(m, s, i);
    mass += m.mass[i];
  }
  return vec_cast<float>(momentum / mass);
}

/// Seldom, so that hands that squeeze an organ hardly notice: in one in eight of the quarters in which folds unfold.
bool calms_now(const NetworkState& s) { return (s.tick & 2047u) >= 1984; }

/// A thin end whose cells collapse at every swing, and are driven open again, can flap for ever: one did at 10 to
/// 17 m/s. So while cells are open in these ticks, no node is faster than kCalm beside the body as a whole.
void calm(const NetworkModel& m, Vec3f drift, const NodeState* in, NodeState* out) {
  for (int r = 0; r < m.rows; ++r) {
    const Vec3f beside = speed(out[r]) - drift;
    const float square = dot(beside, beside);
    if (square > kCalm * kCalm && m.node_of_row[r] >= 0)
      move_to(out[r], in[r], drift + (kCalm / std::sqrt(square)) * beside, float(m.dt));
  }
}

// ---- the tick

LoadedBody loaded(const NetworkModel& m) {
  return {m.nodes, m.dt, m.gamma, m.substeps, m.origin, m.mass, m.fixed, m.row_of_node};
}

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
  if (parts < 2 || slices < parts * kSlicesPerThread) return kernels().substep(a, 0, slices);
  constexpr int kMost = 64;
  const int n = parts < kMost ? parts : kMost;
  bool fine[kMost];
  core::run(*pool, n, [&](int i) noexcept {
    fine[i] = kernels().substep(a, int(std::int64_t(slices) * i / n), int(std::int64_t(slices) * (i + 1) / n));
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

StepReport advance(const NetworkModel& m, std::span<const NodeLoad> loads, std::span<Vec3f> reactions, NetworkState& s,
                   NetworkWork& w, core::ThreadPool* pool) noexcept {
  const LoadedBody body = loaded(m);
  StepReport report = check_loads(body, loads);
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
  const bool calms = calms_now(s) && !open.empty();
  const Vec3f drift = calms ? drift_of(m, s) : Vec3f{};
  KernelArgs args = kernel_args(m, s);
  bool fine = true;
  for (int i = 0; i < m.substeps; ++i) {
    args.in = s.nodes.data();
    args.out = w.other.data();
    fine = run_substep(args, m.rows / kSlice, pool) && fine;
    if (calms) calm(m, drift, args.in, args.out);
    push_open(m, s, open, turn, args.in, args.out);
    catch_leaps(m, fast, args.in, args.out);
    fine = apply_loads(body, loads, reactions, args.in, args.out) && fine;
    std::swap(s.nodes, w.other);
  }
  release_open(m, open, s);
  ++s.tick;
  if (!fine) report = StepReport{StepReport::kNonFinite, first_non_finite(m, s)} | report;
  return report;
}

}  // namespace trocar::tissue
