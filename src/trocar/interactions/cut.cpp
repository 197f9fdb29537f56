#include <algorithm>

#include <trocar/interactions/clip.hpp>
#include <trocar/interactions/cut.hpp>
#include <trocar/interactions/tool_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOpenEnough = 0.5;  // aperture from which the blades can cut again
constexpr double kShut = 0.2;        // aperture at which the blades have crossed

}  // namespace

int update_scissors(const ToolModel& model, const ToolShape& shape, int tool_index, const TissueView& view,
                    std::span<tissue::StrandState> strand_states, int tips_visible, std::uint64_t tick, ToolState& tool,
                    CutBook book) noexcept {
  if (tool.aperture > kOpenEnough) tool.armed = 1;
  if (!tool.armed || tool.aperture > kShut) return 0;
  tool.armed = 0;
  int made = 0;
  for (size_t s = 0; s < view.strands.size(); ++s) {
    const StrandBody& body = view.strands[s];
    tissue::StrandState& state = strand_states[s];
    if (!body.cuttable) continue;
    int element = -1;
    BetweenJaws best;
    for (int e = 0; e + 1 < body.nodes(); ++e) {
      if (!state.alive[size_t(e)]) continue;
      const BetweenJaws where = between_jaws(model, shape, body, state, e);
      if (!where.inside || (element >= 0 && std::fabs(where.local.y) >= std::fabs(best.local.y))) continue;
      element = e;
      best = where;
    }
    if (element < 0 || book.count == kMaxCuts) continue;
    const double radius = body.model.radius[size_t(element)];
    Cut& cut = book.cuts[size_t(book.count++)];
    cut = {};
    cut.strand = std::int32_t(s);
    cut.tool = tool_index;
    cut.tips_visible = tips_visible;
    cut.tick = tick;
    cut.s = arc_at(body, {element, best.w});
    cut.fraction = leg_cover(best.local.z, radius, model.jaw_length);
    cut.beyond = std::max(0.0, model.jaw_length - best.local.z - radius);
    if (cut.fraction >= kThrough)
      tissue::cut_element(state, element);
    else
      state.scale[size_t(element)] *= 1.0 - cut.fraction;
    ++made;
  }
  return made;
}

}  // namespace trocar::interactions
