#include <algorithm>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOpenForClip = 0.8;  // aperture at which a fresh clip drops into the jaws
constexpr double kHalfClosed = 0.5;   // closing time counts from here
constexpr double kClipSet = 0.04;     // aperture at which the clip is set
constexpr double kClipStiffness = 6;  // of a clipped element, times its own: titanium holds it straight

struct Catch {
  int strand = -1;
  StrandPlace place;
  Vec3d local;
  double cover = 0;
};

/// Where a strand crosses the middle of the jaws, as far as the clip's legs are beside it there.
Catch crossing(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, size_t strand) noexcept {
  const StrandBody& body = bodies.strand(strand);
  const tissue::StrandState& state = bodies.strand_state(strand);
  Catch best;
  double nearest = 1e9;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    if (!where.inside) continue;
    const double off = std::fabs(where.local.y);
    const double cover = leg_cover(from_bend(model, where.local.z), body.model.radius[size_t(e)], model.clip_length);
    if (cover <= 0 || off >= nearest) continue;
    nearest = off;
    best = {int(strand), {e, where.w}, where.local, cover};
  }
  return best;
}

/// Of several strands between the jaws the one of which the legs cover most; where they cover as much, the one nearest
/// to the legs' middle.
Catch caught(const ToolModel& model, const ToolShape& shape, const Bodies& bodies) noexcept {
  constexpr double kAsMuch = 0.01;  // of covers
  const auto from_middle = [&](const Catch& c) {
    return std::fabs(from_bend(model, c.local.z) - 0.5 * model.clip_length);
  };
  Catch best;
  for (size_t s = 0; s < bodies.strand_count(); ++s) {
    const Catch next = crossing(model, shape, bodies, s);
    if (next.strand < 0 || next.cover < best.cover - kAsMuch) continue;
    if (next.cover > best.cover + kAsMuch || from_middle(next) < from_middle(best)) best = next;
  }
  return best;
}

void store(double (&out)[3], Vec3d v, const StrandFrame& f) noexcept {
  out[0] = dot(v, f.tangent);
  out[1] = dot(v, f.normal);
  out[2] = dot(v, f.binormal);
}

}  // namespace

// The clip sits at the end of the jaws.
StrandPlace fit_clip(const ToolModel& model, const ToolShape& shape, const Bodies& bodies, Clip& clip) noexcept {
  const Catch c = caught(model, shape, bodies);
  clip.strand = c.strand;
  if (c.strand < 0) return c.place;
  const StrandBody& body = bodies.strand(size_t(c.strand));
  const StrandFrame frame = frame_at(body, bodies.strand_state(size_t(c.strand)), c.place);
  clip.s = arc_at(body, c.place);
  clip.cover = c.cover;
  clip.theta = portable::acos(std::min(1.0, std::fabs(dot(shape.frame.normal(), frame.tangent))));
  clip.reach = from_bend(model, c.local.z);
  store(clip.opening, shape.frame.opening(), frame);
  store(clip.axis, shape.frame.axis(), frame);
  return c.place;
}

bool update_clip_applier(const ToolModel& model, const ToolShape& shape, int tool_index, const Bodies& bodies,
                         std::span<tissue::StrandState> strand_states, int tips_visible, std::uint64_t tick,
                         ToolState& tool, ClipBook book) noexcept {
  if (tool.aperture > kOpenForClip && tool.clips_left > 0) tool.armed = 1;
  if (tool.aperture > kHalfClosed) tool.closed_for = 0;
  if (!tool.armed) return false;
  if (tool.aperture > kClipSet) {
    if (tool.aperture <= kHalfClosed) tool.closed_for += core::kTick;
    return false;
  }
  tool.armed = 0;
  --tool.clips_left;
  if (book.count == kMaxClips) return false;
  Clip& clip = book.clips[size_t(book.count++)];
  clip = {};
  clip.tick = tick;
  clip.tool = tool_index;
  clip.length = model.clip_length;
  clip.tips_visible = tips_visible;
  clip.closing_time = tool.closed_for;
  const StrandPlace place = fit_clip(model, shape, bodies, clip);
  if (clip.strand >= 0) {  // what is half cut is not healed
    double& scale = strand_states[size_t(clip.strand)].scale[size_t(place.element)];
    scale = std::min(scale, 1.0) * kClipStiffness;
  }
  return true;
}

}  // namespace trocar::interactions
