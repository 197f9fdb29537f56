#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/pinch.hpp>

namespace trocar::view {

using interactions::Clip;

namespace {

// Shares of a tube's radius, our choice: how far it bulges and gathers beside a clip. What is pressed flat keeps its
// girth: it spreads between the legs, and a stump beyond them stays half flat.
constexpr double kPinchBulge = 0.2, kGathers = 0.1, kPinchSpreads = 0.42, kStumpFlat = 0.62;

bool holds(const interactions::ToolState& tool, BodyId body) {
  const int n = std::min(tool.holds, interactions::kMaxHolds);
  return std::any_of(tool.hold, tool.hold + std::max(0, n), [body](const auto& h) { return h.at.body == body; });
}

sim::ClipSeat seat_of(const Clip& clip, const sim::Model& model, const sim::State& state) {
  if (clip.strand >= 0) return sim::seat_on_strand(clip, model, state);
  const interactions::VesselPath& path = model.vessels.list[std::size_t(clip.vessel - 1)].path;
  std::vector<Vec3d> points(path.points.size());
  pose_vessel(path, sim::bodies_of(model, state), points);
  return sim::seat_on_vessel(clip, model, state, points);
}

ClipPress press_with(const sim::ClipLegs& legs, double radius, double s) {
  ClipPress press;
  press.centre = legs.centre, press.axis = legs.axis, press.open = legs.open;
  press.normal = cross(press.axis, press.open);
  press.radius = radius;
  press.low = legs.low, press.high = legs.high;
  press.s = s;
  return press;
}

void find_stumps(const Clip& clip, bool normal_along, const sim::State& state, ClipPress& press) {
  for (int i = 0; i < state.cut_count; ++i) {
    const interactions::Cut& cut = state.cuts[std::size_t(i)];
    if (cut.strand != clip.strand || cut.fraction < interactions::kThrough || !closes_end(clip, cut.s)) continue;
    const double way = std::fabs(cut.s - clip.s);
    double& end = press.stump[(cut.s > clip.s) == normal_along];
    end = end > 0 ? std::min(end, way) : way;
  }
}

}  // namespace

bool closes_end(const Clip& clip, double end) {
  constexpr double kWhole = 0.9;  // of the tube between its legs
  return clip.cover >= kWhole && std::fabs(clip.s - end) < kSealedWithin;
}

ClipPress press_of(const Clip& clip, const sim::Model& model, const sim::State& state) {
  const sim::ClipSeat seat = seat_of(clip, model, state);
  ClipPress press = press_with(sim::legs_on(clip, seat), seat.radius, clip.s);
  press.flat = kClipHalfGap / press.radius;
  if (clip.strand >= 0) find_stumps(clip, dot(press.normal, seat.frame.tangent) > 0, state, press);
  return press;
}

ClipPress press_on_thread(const Clip& clip, int number, const sim::State& state) {
  const suture::ThreadClip* sits = interactions::thread_clip(state.objects.sutures, clip, number);
  return sits ? press_with(sim::legs_on_thread(clip, *sits), kClipHalfGap, sits->s[0]) : ClipPress{};
}

std::vector<ClipPress> clips_on(int strand, const sim::Model& model, const sim::State& state) {
  std::vector<ClipPress> presses;
  for (int i = 0; i < state.clip_count; ++i)
    if (state.clips[std::size_t(i)].strand == strand)
      presses.push_back(press_of(state.clips[std::size_t(i)], model, state));
  return presses;
}

std::vector<LoopPress> loops_on(int strand, const sim::Model& model, const sim::State& state) {
  std::vector<LoopPress> presses;
  sim::visit_loops(model, state, [&](const sim::LoopClosure& loop) {
    if (loop.at.body != BodyId::strand(std::size_t(strand))) return;
    const interactions::StrandBody& body = model.strand_bodies[std::size_t(strand)];
    const interactions::StrandPlace place = place_on_rod(loop.at);
    LoopPress press;
    press.radius = body.model.radius[std::size_t(place.element)];
    if (!(loop.radius < press.radius)) return;
    press.centre = point_at(body, state.strands[std::size_t(strand)], place);
    press.along = tangent_at(body, state.strands[std::size_t(strand)], place);
    press.within = std::max(0.0, loop.radius);
    press.half = 0.5 * model.objects.sutures.list[std::size_t(loop.suture)].thread.stuff.diameter;
    press.s = loop.s;
    presses.push_back(press);
  });
  return presses;
}

std::vector<JawPress> jaws_on(BodyId body, const sim::Model& model, const sim::State& state) {
  std::vector<JawPress> presses;
  for (std::size_t t = 0; t < model.hands.size(); ++t) {
    const interactions::ToolState& tool = state.tools[t];
    if (!holds(tool, body)) continue;
    const interactions::ToolModel& m = model.tool(state, t);
    presses.push_back({sim::shape_of(model, state, t), m.jaw_length, 0.5 * m.jaw_width});
  }
  return presses;
}

Vec3d pressed(Vec3d p, const ClipPress& press) {
  const Vec3d d = p - press.centre;
  const double off = dot(d, press.normal), end = press.stump[off > 0];
  const double beside = std::fabs(off) - 0.5 * kClipLegWidth, fade = 1.35 * press.radius + 0.0003;
  const double stays = end > 0 ? kStumpFlat * smooth(kSealedWithin, 0.6 * kSealedWithin, end) : 0;
  if (beside > std::max(fade, stays > 0 ? end + 2 * press.radius : 0)) return p;
  const double x = dot(d, press.open), z = dot(d, press.axis);
  if (x * x + z * z > 9 * press.radius * press.radius) return p;
  const double rim = 0.0004;
  const double between = smooth(press.low - rim, press.low + rim, z) * smooth(press.high + rim, press.high - rim, z);
  // Steepest right at the legs, which lie half buried; and there it is gathered like a purse.
  const double near = 1 - std::clamp(beside / fade, 0.0, 1.0),
               amount = between * std::max(near * near * (1.5 - 0.5 * near), stays);
  const double angle = std::atan2(x, z) + (dot(d, press.normal) > 0 ? 0.7 : 0);
  const double gathers = std::sin(4 * angle + 1) + 0.6 * std::sin(3 * angle + 2.4);
  const double bulge = between * (4 * near * (1 - near) * kPinchBulge + kGathers * gathers * smooth(0.05, 0.7, near));
  const double flattened = x * ((1 + bulge) * (1 - amount) + amount * std::min(1.0, press.flat));
  double spread = z * (1 + bulge * (1 - amount) + kPinchSpreads * amount);
  if (z > press.low) spread = std::max(spread, press.low + 0.5 * rim);  // no further than the bend and the tips
  if (z < press.high) spread = std::min(spread, press.high - 0.5 * rim);
  return p + (flattened - x) * press.open + (spread - z) * press.axis;
}

/// The thread lies half buried in a groove, beside which the tube is gathered like a purse.
Vec3d pressed(Vec3d p, const LoopPress& press) {
  constexpr double kBuried = 0.6;  // of half of the thread
  const Vec3d d = p - press.centre;
  const double off = dot(d, press.along), fade = 1.2 * press.radius;
  const double beside = std::fabs(off) - press.half;
  if (beside > fade) return p;
  const Vec3d out = d - off * press.along;
  const double away = length(out);
  if (away > 2 * press.radius || away < 1e-6) return p;
  const double near = 1 - std::clamp(beside / fade, 0.0, 1.0), amount = near * near * (1.5 - 0.5 * near);
  const Vec3d side = any_perpendicular(press.along), over = cross(press.along, side);
  const double angle = std::atan2(dot(out, over), dot(out, side)) + (off > 0 ? 0.7 : 0);
  const double gathers = std::sin(5 * angle + 1) + 0.6 * std::sin(7 * angle + 2.4);
  const double bulge = 4 * near * (1 - near) * kPinchBulge + kGathers * gathers * smooth(0.05, 0.7, near) * (1 - near);
  const double left = (press.within + kBuried * press.half) / press.radius;
  return p + ((1 + bulge) * (1 - amount) + amount * std::min(1.0, left) - 1) * out;
}

Vec3d pressed(Vec3d p, const JawPress& press) {
  const Vec3d q = interactions::to_jaw(press.shape, p);
  const double beyond = std::max({std::fabs(q.y) - press.half_width, q.z - press.length, -q.z, 0.0});
  if (beyond > 0.006) return p;
  const double along = std::clamp(q.z, 0.0, press.length);
  const double limit = std::max(0.0, press.shape.half_opening(along)) + 1e-4 + 0.9 * beyond + 60 * beyond * beyond;
  if (std::fabs(q.x) <= limit || std::fabs(q.x) > 0.012) return p;
  const double x = q.x > 0 ? limit : -limit;
  return p + (x - q.x) * press.shape.frame.opening();
}

}  // namespace trocar::view
