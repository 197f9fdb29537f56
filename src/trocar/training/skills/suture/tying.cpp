#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/suture/thread/chain.hpp>
#include <trocar/training/skills/suture/tying.hpp>

namespace trocar::training::tying {

Vec3d held_thread(const Surgeon& op, int hand) {
  const interactions::SutureModel& m = suture_of(op.model());
  const interactions::SutureState& s = suture_of(op.state());
  if (held_of_suture(op.model(), op.state(), std::size_t(hand)) == 1)
    return suture::needle_point(m.needle, s.needle, m.needle.length);
  const std::size_t slot = std::size_t(interactions::kFirstHandSlot + hand);
  if (slot < s.thread.holds.size() && s.thread.holds[slot].active)
    return suture::point_at(m.thread, s.thread, s.thread.holds[slot].s);
  return op.arm(hand).tip;
}

double pull_of(const Surgeon& op, int hand) {
  const double(&held)[3] = op.tool_state(hand).pull;
  return length(Vec3d{held[0], held[1], held[2]});
}

double felt_by(const Surgeon& op, int hand, Vec3d against) {
  const double(&held)[3] = op.tool_state(hand).pull;
  const double(&touched)[3] = op.tool_state(hand).contact_force;
  return std::max(0.0, -dot(Vec3d{held[0] + touched[0], held[1] + touched[1], held[2] + touched[2]}, against));
}

Vec3d upwards(const Surgeon& op) { return -normalised(op.model().gravity, {0, 0, -1}); }

bool find_stitch(const Surgeon& op, Vec3d& middle) {
  const interactions::SutureState& s = suture_of(op.state());
  const Vec3d up = upwards(op);
  Vec3d sum{};
  double high = -1e9, count = 0;
  for (int i = 0; i < s.hole_count; ++i) {
    if (s.holes[std::size_t(i)].slot < 0) continue;
    const Vec3d at = suture::point_at(suture_of(op.model()).thread, s.thread, double(s.holes[std::size_t(i)].arc));
    sum += at, count += 1, high = std::max(high, dot(up, at));
  }
  if (count == 0) return false;
  middle = (1 / count) * sum;
  middle += (high - dot(up, middle)) * up;
  return true;
}

double held_at(const Surgeon& op, int hand) {
  const suture::ThreadState& thread = suture_of(op.state()).thread;
  const std::size_t slot = std::size_t(interactions::kFirstHandSlot + hand);
  return slot < thread.holds.size() && thread.holds[slot].active ? thread.holds[slot].s : 0;
}

double free_thread(const Surgeon& op, int hand) {
  constexpr double kAtStitch = 0.006;  // [m]: a knot lies there
  const interactions::SutureState& s = suture_of(op.state());
  const suture::ThreadModel& m = suture_of(op.model()).thread;
  const double from = held_at(op, hand);
  double first = m.length, last = 0;
  for (int i = 0; i < s.hole_count; ++i)
    if (const auto& hole = s.holes[std::size_t(i)]; hole.slot >= 0)
      first = std::min(first, double(hole.arc)), last = std::max(last, double(hole.arc));
  if (first > last) return m.length - from;
  // outwards from the stitch, past what is tied: slack that hangs over the stitch is free
  const Vec3d in = suture::point_at(m, s.thread, first), out = suture::point_at(m, s.thread, last);
  const double way = from < first ? -m.spacing : m.spacing;
  double arc = from < first ? first : last;
  for (; (from - arc) * way > 0; arc += way) {
    const Vec3d at = suture::point_at(m, s.thread, arc);
    if (length(in + geometry::closest_on_segment(at, in, out) * (out - in) - at) > kAtStitch) break;
  }
  return std::fabs(arc - from);
}

bool ties(Surgeon& op) { return op.known_knot().update(knot_of(op.model(), op.state())).count > 0; }

void watch(Surgeon& op) {
  constexpr std::uint64_t kEvery = 500;  // ticks: reading a knot takes some milliseconds
  if (op.state().tick % kEvery == 0) ties(op);
}

double tension_from(const Surgeon& op, int hand, double much) {
  const suture::ThreadModel& m = suture_of(op.model()).thread;
  const double at = held_at(op, hand);
  const double other = at < arc_to_stitch(op.model(), op.state()) ? at + much : at - much;
  const int last = std::min(m.nodes - 1, int(std::max(at, other) / m.spacing));
  double most = 0;
  for (int e = std::max(0, int(std::min(at, other) / m.spacing)); e < last; ++e)
    most = std::max(most, suture::tension(m, suture_of(op.state()).thread, e));
  return most;
}

namespace {

/// How far jaws and a needle in them reach below where its thread leaves it [m].
double hangs_below(const Surgeon& op, int hand) {
  if (held_of_suture(op.model(), op.state(), std::size_t(hand)) != 1) return 0;
  constexpr int kPlaces = 12;
  const suture::NeedleModel& m = suture_of(op.model()).needle;
  const suture::NeedleState& s = suture_of(op.state()).needle;
  const Vec3d up = upwards(op), leaves = suture::needle_point(m, s, m.length);
  double deepest = std::max(0.0, dot(up, leaves - op.arm(hand).tip));
  for (int i = 0; i < kPlaces; ++i)
    deepest = std::max(deepest, dot(up, leaves - suture::needle_point(m, s, m.length * i / kPlaces)));
  return deepest;
}

}  // namespace

Vec3d above_tissue(const Surgeon& op, int hand, Vec3d at) {
  constexpr double kLow = 0.010, kClear = 0.004;  // [m] of thread, of steel
  Vec3d stitch;
  if (!find_stitch(op, stitch)) return at;
  const Vec3d up = upwards(op);
  const double lowest = std::max(kLow, hangs_below(op, hand) + kClear);
  return at + std::max(0.0, lowest + dot(up, stitch - at)) * up;
}

bool lead(Surgeon& op, int hand, Vec3d to, double speed) {
  return op.arms().move(hand, op.arm(hand).tip + (to - held_thread(op, hand)), speed);
}

std::string lacks_thread(const sim::Model& model, const SkillArgs& args) {
  if (!needs_thread(model).empty()) return std::string(needs_thread(model));
  return lacks_tool(model, args.hand(), &interactions::Abilities::grip);
}

}  // namespace trocar::training::tying
