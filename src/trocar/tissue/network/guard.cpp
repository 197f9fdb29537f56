#include <algorithm>
#include <cmath>
#include <limits>

#include <trocar/numerics/quat.hpp>
#include <trocar/tissue/network/guard.hpp>
#include <trocar/tissue/network/network_kernels.hpp>
#include <trocar/tissue/network/network_loads.hpp>

namespace trocar::tissue {
namespace {

constexpr float kReleased = 0.2f;     // share of the rest volume at which a cell is let go
constexpr float kBlend = 0.3f;        // share of its nodes' velocities that one sub-step replaces
constexpr float kStill = 0.02f;       // nodes slower than this are at rest [m/s]
constexpr float kTrembling = 2;       // nodes faster than this do not tremble: they are on their way, or fall [m/s]
constexpr int kLong = 100;            // ticks after which a fold is one that springs hold
constexpr float kUnfolding = 0.005f;  // the opening time, and kReleased, for such a fold
constexpr float kUnfolded = 0.7f;
constexpr float kLeap = 20;   // faster than anything that hands do to tissue [m/s]
constexpr float kWild = 100;  // faster than anything that is merely thrown [m/s]
constexpr float kCaught = 2;  // [m/s]
constexpr float kCalm = 2;    // [m/s]

bool slower(const NodeState& n, float limit) noexcept { return dot(speed(n), speed(n)) < limit * limit; }

/// Was it held to kCaught in the last sub-step? Its speed itself says so; let go for a tick, it would leap again.
bool is_caught(float square) noexcept { return std::fabs(square - kCaught * kCaught) < 1e-4f * kCaught * kCaught; }

/// Seldom, so that hands that squeeze an organ hardly notice: in one in eight of the quarters in which folds unfold.
bool calms_now(std::uint32_t tick) noexcept { return (tick & 2047u) >= 1984; }

}  // namespace

TetPack empty_pack() noexcept {
  TetPack p{};
  for (float& limit : p.limit6) limit = -std::numeric_limits<float>::infinity();
  return p;
}

std::span<const std::uint8_t> mark_folded(std::span<const TetRest> cells, std::span<const std::uint8_t> phase,
                                          std::span<std::uint8_t> folded) noexcept {
  const auto is_folded = [](std::uint8_t p) { return p >= kLong && p != kGone; };
  if (std::none_of(phase.begin(), phase.end(), is_folded)) return {};
  std::fill(folded.begin(), folded.end(), std::uint8_t{0});
  for (std::size_t t = 0; t < cells.size(); ++t)
    if (is_folded(phase[t]))
      for (const int row : cells[t].row) folded[std::size_t(row)] = 1;
  return folded;
}

Guard::Guard(const GuardedBody& body, const GuardState& state, const GuardScratch& scratch,
             std::span<const NodeState> nodes, Hands hands) noexcept
    : b(body), m_state(state), m_scratch(scratch), m_hands(hands) {
  find_collapsed(nodes);
  list_open();
  if (at_work()) take_turns(nodes);
  list_fast(nodes);
  m_calms = calms_now(m_state.tick) && at_work();
  if (m_calms) m_drift = drift(nodes);
}

void Guard::mend(const NodeState* in, NodeState* out) const noexcept {
  if (m_calms) calm(in, out);
  push_open(in, out);
}

Vec3f Guard::row_weight(int row) const noexcept {
  const RowPack& p = b.row_packs[std::size_t(row / kSlice)];
  return {p.wx[row % kSlice], p.wy[row % kSlice], p.wz[row % kSlice]};
}

Vec3d Guard::place_of(int node, std::span<const NodeState> nodes) const noexcept {
  const NodeState& n = nodes[std::size_t(b.row_of_node[std::size_t(node)])];
  return b.origin + Vec3d{double(n.x), double(n.y), double(n.z)};
}

/// A quarter of the cells is looked at each tick; those that collapsed stay on the list until they are open again.
void Guard::find_collapsed(std::span<const NodeState> nodes) noexcept {
  const int packs = int(b.packs.size());
  const int quarter = int(m_state.tick & 3u);
  const int first = int(std::int64_t(packs) * quarter / 4), last = int(std::int64_t(packs) * (quarter + 1) / 4);
  kernels().find_collapsed(nodes.data(), b.packs.data(), first, last, m_scratch.below.data());
  for (int p = first; p < last; ++p) {
    for (unsigned bits = m_scratch.below[std::size_t(p - first)]; bits; bits &= bits - 1) {
      std::uint8_t& phase = m_state.phase[std::size_t(p * kSlice + __builtin_ctz(bits))];
      if (phase == 0) phase = 1, ++m_state.open;
    }
  }
}

void Guard::list_open() noexcept {
  std::size_t n = 0;
  const std::size_t count = m_state.open == 0 ? 0 : m_state.phase.size();
  for (std::size_t t = 0; t < count; ++t)
    if (m_state.phase[t] != 0 && m_state.phase[t] != kGone) m_scratch.open[n++] = int(t);
  m_open = m_scratch.open.first(n);
}

std::int32_t Guard::part_of(int cell) const noexcept {
  if (b.part.empty()) return 0;
  return b.part[std::size_t(b.node_of_row[std::size_t(b.cells[std::size_t(cell)].row[0])])];
}

void Guard::take_turns(std::span<const NodeState> nodes) noexcept {
  std::array<bool, kMostParts> taken{};
  for (const int t : m_open) {
    const std::int32_t part = part_of(t);
    if (part >= kMostParts || taken[std::size_t(part)]) continue;
    taken[std::size_t(part)] = true;
    m_turn[std::size_t(part)] = turn_of(part, nodes);
  }
}

/// How a piece as a whole has turned since it was drawn: the rotation that fits all its nodes best, by mass. Found by
/// turning the frame against what is left, as in [Muller et al. 2016]; steps normalised instead of exact, which only
/// changes how soon it converges.
Mat3d Guard::turn_of(std::int32_t part, std::span<const NodeState> nodes) const noexcept {
  constexpr int kRounds = 20;
  const auto belongs = [&](int i) { return b.part.empty() || b.part[std::size_t(i)] == part; };
  Vec3d now{}, drawn{};
  double mass = 0;
  for (int i = 0; i < b.nodes; ++i) {
    if (!belongs(i)) continue;
    const double m = b.mass[std::size_t(i)];
    mass += m;
    now += m * place_of(i, nodes);
    drawn += m * b.rest[std::size_t(i)];
  }
  now = now / mass, drawn = drawn / mass;
  Vec3d moment[3] = {};  // columns of sum m (x - c) (X - C)^T
  for (int i = 0; i < b.nodes; ++i) {
    if (!belongs(i)) continue;
    const Vec3d x = place_of(i, nodes) - now, at = b.rest[std::size_t(i)] - drawn;
    for (int k = 0; k < 3; ++k) moment[k] += (b.mass[std::size_t(i)] * at[k]) * x;
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

/// Each listed cell goes back to its drawn shape, turned as its piece is: in cell after cell the velocities come nearer
/// to those of a cell that takes its shape within the opening time. As all cells agree on the turn, neighbours do not
/// undo each other's work. A velocity that is partly replaced cannot be pumped up without end, as impulses along the
/// volume's gradient were where cells are nearly flat. Momentum is conserved.
///
/// Springs can withstand that: a corner that was pushed through its cell to the far side of it lies in a minimum of
/// their energy. So a cell that has been folded for kLong is driven slowly, and with its velocities replaced
/// altogether, if it was at rest or, in a body that is whole, nothing touched it: it may tremble for ever, pushed to
/// and fro by this very remedy. A flap that hangs on threads must have come to rest, as it is not turned as its piece
/// is: springs then only move it as a whole. A fold's cells must unfold together, or one pulls the other back: all do
/// so in the last quarter of 256 ticks. Where the way home begins is read before the sub-step; the place that springs
/// have just predicted overshoots where they are stiff, and driving from there goes astray.
void Guard::push_open(const NodeState* in, NodeState* out) const noexcept {
  const float dt = float(b.dt);
  const bool unfolding = unfolds_now();
  for (const int t : m_open) {
    const std::int32_t part = part_of(t);
    if (part >= kMostParts) continue;
    const Mat3d& turn = m_turn[std::size_t(part)];
    const int* r = b.cells[std::size_t(t)].row;
    const bool stuck = unfolding && m_state.phase[std::size_t(t)] >= kLong;
    const float blend = stuck ? 1 : kBlend, opening = stuck && kUnfolding > b.opening ? kUnfolding : b.opening;
    Vec3f centre{}, drifts{};
    Vec3d drawn{};
    float mass = 0;
    for (int i = 0; i < 4; ++i) {
      const std::size_t node = std::size_t(b.node_of_row[std::size_t(r[i])]);
      const float w = float(b.mass[node]);
      centre += w * place(in[r[i]]);
      drifts += w * speed(out[r[i]]);
      drawn += b.mass[node] * b.rest[node];
      mass += w;
    }
    centre = centre / mass, drifts = drifts / mass, drawn = drawn / double(mass);
    for (int i = 0; i < 4; ++i) {
      const Vec3d home = b.rest[std::size_t(b.node_of_row[std::size_t(r[i])])] - drawn;
      const Vec3f goal = centre + vec_cast<float>(turn * home);
      const Vec3f wanted = drifts + (goal - place(in[r[i]])) / opening, w = row_weight(r[i]);
      Vec3f v = speed(out[r[i]]);
      for (int k = 0; k < 3; ++k)
        if (w[k] > 0) v[k] += blend * (wanted[k] - v[k]);
      move_to(out[r[i]], in[r[i]], v, dt);
    }
  }
}

void Guard::release(std::span<const NodeState> nodes) noexcept {
  const bool unfolding = unfolds_now();
  for (const int t : m_open) {
    std::uint8_t& phase = m_state.phase[std::size_t(t)];
    const TetRest& cell = b.cells[std::size_t(t)];
    const auto corner = [&](int i) -> const NodeState& { return nodes[std::size_t(cell.row[i])]; };
    const Vec3f o = place(corner(0)), x = place(corner(1)) - o, y = place(corner(2)) - o, z = place(corner(3)) - o;
    const float enough = unfolding && phase >= kLong ? kUnfolded : kReleased;
    if (dot(x, cross(y, z)) > enough * cell.rest6) {
      phase = 0, --m_state.open;
    } else if (!late()) {
      const float limit = b.uncut && m_hands == Hands::off ? kTrembling : kStill;
      const bool stays =
          slower(corner(0), limit) && slower(corner(1), limit) && slower(corner(2), limit) && slower(corner(3), limit);
      phase = !stays ? 1 : (phase < kOldestFold ? std::uint8_t(phase + 1) : phase);
    }
  }
}

/// In the same ticks as folds are unfolded: a node that was merely thrown has come to rest by then. One that is wilder
/// is caught at once: between them one of an ovary that three instruments squeezed grew to 36 km/s.
void Guard::list_fast(std::span<const NodeState> nodes) noexcept {
  if (!late() && !at_work()) return;
  const float limit = late() ? kLeap : kWild;
  for (int r = 0; r < b.rows && m_fast_count < kMostLeaps; ++r) {
    const float square = dot(speed(nodes[std::size_t(r)]), speed(nodes[std::size_t(r)]));
    if (square > limit * limit || (late() && is_caught(square))) m_fast[std::size_t(m_fast_count++)] = r;
  }
}

/// The time step is stable where springs point in the drawn shape. A light node that was thrown out of its place has
/// all of them on one side, together stiffer than the step bears: it can leap to and fro for ever, through its
/// neighbours and back. One that is so fast and turns round within a sub-step is held to steps within which it finds
/// its place again. That only takes energy away; the node's own momentum goes with it, as giving that to its neighbours
/// fed other leaps. Loads come first: one that knows the node's speed at the beginning of the tick would carry on a
/// node that no longer feels its springs.
void Guard::catch_leaps(const NodeState* in, NodeState* out) const noexcept {
  for (int k = 0; k < m_fast_count; ++k) {
    const int r = m_fast[std::size_t(k)];
    const Vec3f v = speed(out[r]), before = speed(in[r]);
    const float fast = std::sqrt(dot(v, v));
    if (fast > 2 * kCaught && (is_caught(dot(before, before)) || dot(v, before) < 0))
      move_to(out[r], in[r], (kCaught / fast) * v, float(b.dt));
  }
  if (!at_work()) return;
  for (int r = 0; r < b.rows; ++r) {  // what grows within a tick was not listed when it began
    const Vec3f v = speed(out[r]);
    const float square = dot(v, v);
    if (square > kWild * kWild) move_to(out[r], in[r], (kWild / std::sqrt(square)) * v, float(b.dt));
  }
}

Vec3f Guard::drift(std::span<const NodeState> nodes) const noexcept {
  Vec3d momentum{};
  double mass = 0;
  for (int i = 0; i < b.nodes; ++i) {
    const NodeState& n = nodes[std::size_t(b.row_of_node[std::size_t(i)])];
    momentum += b.mass[std::size_t(i)] * Vec3d{double(n.vx), double(n.vy), double(n.vz)};
    mass += b.mass[std::size_t(i)];
  }
  return vec_cast<float>(momentum / mass);
}

/// A thin end whose cells collapse at every swing, and are driven open again, can flap for ever: one did at 10 to
/// 17 m/s. So while cells are open in these ticks, no node is faster than kCalm beside the body as a whole.
void Guard::calm(const NodeState* in, NodeState* out) const noexcept {
  for (int r = 0; r < b.rows; ++r) {
    const Vec3f beside = speed(out[r]) - m_drift;
    const float square = dot(beside, beside);
    if (square > kCalm * kCalm && b.node_of_row[std::size_t(r)] >= 0)
      move_to(out[r], in[r], m_drift + (kCalm / std::sqrt(square)) * beside, float(b.dt));
  }
}

}  // namespace trocar::tissue
