#include <cmath>

#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/sim/verbs/clipping.hpp>

namespace trocar::sim {

void Clipping::work(StepContext& c, std::size_t t) noexcept {
  State& s = c.state;
  interactions::ToolState& tool = s.tools[t];
  const int clips = tool.clips_left;
  const bool fired = update_clip_applier(c.model.tool(s, t), c.work.shapes[t], int(t), tissue_of(c), s.strands,
                                         jaw_tips_visible(c.model, s, int(t)), s.tick, tool, {s.clips, s.clip_count});
  if (fired) {
    const int clip = s.clip_count - 1;
    clip_vessels(c, t, clip);
    if (s.clips[size_t(clip)].dropped()) clip_threads(c, t, clip);
    emit_event(c, s.clips[size_t(clip)].dropped() ? Event::dropped_clip : Event::clipped, int(t), clip);
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
