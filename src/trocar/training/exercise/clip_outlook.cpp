#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/clip_outlook.hpp>
#include <trocar/training/exercise/clip_places.hpp>

namespace trocar::training {
namespace {

/// Would the judge take it? One alone in either place; beside others one that makes a pair, or one more than a pair.
bool belongs(const Sterilisation& goal, const sim::State& state, int strand, double s) {
  bool others = false, fits = false, paired = false;
  for (int i = 0; i < state.clip_count; ++i) {
    const interactions::Clip& c = state.clips[std::size_t(i)];
    if (c.strand != strand || !well_set(goal, c) || !place_of_a_clip(goal, c.s)) continue;
    others = true;
    fits = fits || are_a_pair(goal, c.s, s) || are_a_pair(goal, s, c.s);
    for (int k = 0; k < i; ++k) {
      const interactions::Clip& d = state.clips[std::size_t(k)];
      if (d.strand != strand || !well_set(goal, d)) continue;
      paired = paired || are_a_pair(goal, c.s, d.s) || are_a_pair(goal, d.s, c.s);
    }
  }
  return fits || ((paired || !others) && place_of_a_clip(goal, s));
}

}  // namespace

std::optional<ClipOutlook> clip_outlook(const Sterilisation& goal, const sim::Model& model, const sim::State& state,
                                        int hand) {
  const interactions::ToolModel& applier = model.tool(state, std::size_t(hand));
  const interactions::ToolState& tool = state.tools[std::size_t(hand)];
  if (applier.kind != interactions::ToolKind::clip_applier || !tool.armed) return std::nullopt;
  const interactions::ToolShape shape = interactions::shape_of(applier, tool.pose(), tool.aperture);
  interactions::TissueView view;
  view.strands = model.strand_bodies;
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
