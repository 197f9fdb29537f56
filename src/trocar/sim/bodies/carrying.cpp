#include <algorithm>

#include <trocar/interactions/instrument/needle.hpp>
#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/sim/bodies/carrying.hpp>

namespace trocar::sim {

void carry_along(const StepContext& c, const CarriedSkin& b) noexcept {
  constexpr double kThin = 0.0005;  // [m]
  interactions::CarriedExtent extent;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    if (!interactions::comes_near(shape, b.surface.pose->bounds, kNearSheet)) continue;
    const interactions::ToolState& tool = c.state.tools[t];
    const interactions::HeldVertices between(bodies_of(c), b.body, tool);
    const interactions::Needles needles = interactions::needles_of(
        c.work.shapes_before[t], shape, c.model.tool(c.state, t).can().blunt(), std::max(kThin, b.thickness));
    interactions::carry_along(needles,
                              {*b.surface.skin,
                               *b.surface.pose,
                               b.open,
                               b.fixed,
                               {between.vertex.data(), between.count},
                               b.surface.nodes.origin,
                               b.rows},
                              b.gap ? b.gap[t * b.each] : 0, kTick, extent);
  }
}

}  // namespace trocar::sim
