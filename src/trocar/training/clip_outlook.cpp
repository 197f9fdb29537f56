#include <cmath>

#include <trocar/interactions/clip.hpp>
#include <trocar/sim/visibility.hpp>
#include <trocar/training/clip_outlook.hpp>

namespace trocar::training {
namespace {

/// A place of the first or the second clip; beside one that fits, at the distance that a pair needs.
bool belongs(const Sterilisation& goal, const sim::State& state, int strand, double s) {
  if (!goal.first_clip.holds(s) && !goal.second_clip.holds(s)) return false;
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& c = state.clips[std::size_t(i)];
    if (c.strand == strand && !goal.clip_distance.holds(std::fabs(c.s - s))) return false;
  }
  return true;
}

}  // namespace

std::optional<ClipOutlook> clip_outlook(const Sterilisation& goal, const sim::Model& model, const sim::State& state,
                                        int hand) {
  const interactions::ToolModel& applier = model.tool(state, std::size_t(hand));
  const interactions::ToolState& tool = state.tools[std::size_t(hand)];
  if (applier.kind != interactions::ToolKind::clip_applier || !tool.armed) return std::nullopt;
  const interactions::ToolShape shape = interactions::shape_of(applier, tool.pose(), tool.aperture);
  interactions::TissueView view;
  view.strands = model.bodies;
  view.strand_states = state.strands;
  interactions::Clip clip;
  interactions::fit_clip(applier, shape, view, clip);
  if (clip.strand < 0) return std::nullopt;

  ClipOutlook o;
  o.strand = clip.strand;
  for (const Side& side : goal.sides) o.tube |= model.strands[std::size_t(clip.strand)].name == side.tube;
  o.s = clip.s;
  o.theta = clip.theta;
  o.cover = clip.cover;
  o.tips_visible = sim::jaw_tips_visible(model, state, hand);
  o.in_place = o.tube && belongs(goal, state, clip.strand, clip.s);
  o.across = clip.theta <= goal.clip_angle;
  o.encloses = clip.cover >= goal.clip_cover;
  return o;
}

}  // namespace trocar::training
