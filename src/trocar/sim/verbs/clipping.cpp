#include <algorithm>
#include <cmath>
#include <optional>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/clip_seat.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/sim/verbs/clipping.hpp>

namespace trocar::sim {
namespace {

constexpr std::int16_t kArmed = 1, kBlocked = 2;  // ToolState::armed: a clip is ready; and others keep the jaws apart
constexpr double kHalfClip = kClipHalfGap + kClipLegThickness;  // of a closed clip, the way that it has closed [m]

/// A closed clip where it is now; nothing where it was dropped or has detached.
std::optional<ClipLegs> legs_now(StepContext& c, int number) noexcept {
  const interactions::Clip& clip = c.state.clips[size_t(number)];
  if (clip.dropped()) return {};
  if (clip.strand >= 0) return legs_on(clip, seat_on_strand(clip, c.model, c.state));
  if (clip.vessel > 0)
    return legs_on(clip, seat_on_vessel(clip, c.model, c.state, points_of(c, size_t(clip.vessel - 1))));
  const suture::ThreadClip* sits =
      interactions::thread_clip(interactions::part_of<interactions::Suture>(c.state), clip, number);
  if (!sits) return {};
  return legs_on_thread(clip, *sits);
}

/// How far from the jaws' mid-plane a clip reaches that lies between the legs of the one that is about to close [m];
/// below 0: it lies beside them.
/// @param was  the jaws when the tick began: what they have had between them
double reach_between(const interactions::ToolModel& tool, const interactions::ToolShape& shape,
                     const interactions::ToolShape& was, const ClipLegs& legs) noexcept {
  const Vec3d low = to_jaw(shape, legs.centre + legs.low * legs.axis),
              high = to_jaw(shape, legs.centre + legs.high * legs.axis);
  // Where it is nearest to the new legs, as both are seen along the way that these close.
  const auto flat = [](Vec3d p) { return Vec3d{0, p.y, p.z}; };
  const geometry::SegmentPair<double> near = geometry::closest_segments(
      flat(low), flat(high), Vec3d{0, 0, tool.jaw_length - tool.clip_length}, Vec3d{0, 0, tool.jaw_length});
  if (near.distance2 > kClipLegWidth * kClipLegWidth) return -1;
  const Vec3d at = low + near.s * (high - low);
  const double off = std::fabs(at.x);
  return off < was.half_opening(at.z) ? off + kHalfClip : -1;
}

/// Legs of titanium do not close on a clip of titanium: the jaws stay as far open as what lies between them is thick.
void stop_at_clips(StepContext& c, std::size_t t) noexcept {
  interactions::ToolState& tool = c.state.tools[t];
  if (tool.armed <= 0 || c.state.clip_count == 0) return;
  const interactions::ToolModel& model = c.model.tool(c.state, t);
  const interactions::ToolShape& shape = c.work.shapes[t];
  const interactions::ToolShape was = interactions::shape_before(model, c.state.touches[t]);
  double reach = -1;
  for (int i = 0; i < c.state.clip_count; ++i) {
    const std::optional<ClipLegs> legs = legs_now(c, i);
    if (!legs || length(legs->centre - shape.frame.tip) > 2 * model.jaw_length) continue;
    reach = std::max(reach, reach_between(model, shape, was, *legs));
  }
  const double stop = reach < 0 ? 0 : interactions::aperture_at(model, 2 * reach, model.jaw_length);
  if (tool.aperture >= stop) return;
  tool.aperture = stop;
  c.work.shapes[t] = shape_of(c.model, c.state, t);
  if (tool.armed == kArmed) emit_event(c, Event::of_hand(Event::clip_blocked, int(t)));
  tool.armed = kBlocked;
}

}  // namespace

void Clipping::work(StepContext& c, std::size_t t) noexcept {
  State& s = c.state;
  interactions::ToolState& tool = s.tools[t];
  stop_at_clips(c, t);
  const int clips = tool.clips_left;
  const bool fired = update_clip_applier(c.model.tool(s, t), c.work.shapes[t], int(t), bodies_of(c), s.strands,
                                         jaw_tips_visible(c.model, s, int(t)), s.tick, tool, {s.clips, s.clip_count});
  if (fired) {
    const int number = s.clip_count - 1;
    const interactions::Clip& clip = s.clips[size_t(number)];
    clip_vessels(c, t, number);
    if (clip.dropped()) clip_threads(c, t, number);
    emit_event(c, clip.dropped() ? Event::recorded(Event::dropped_clip, int(t), number, {})
                                 : Event::recorded(Event::clipped, int(t), number, clip.body()));
  } else if (tool.clips_left < clips) {
    c.report.flags |= StepReport::kRecordsFull;
  }
}

bool Clipping::sound(const Model& model, const interactions::Clip& clip) noexcept {
  return clip.strand >= -1 && clip.strand < std::int32_t(model.strands.size()) && std::isfinite(clip.s) &&
         clip.vessel >= -std::int32_t(model.objects.sutures.list.size()) &&
         clip.vessel <= std::int32_t(model.vessels.list.size());
}

}  // namespace trocar::sim
