#include <trocar/interactions/verbs/grasp.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/verbs/gripping.hpp>

namespace trocar::sim {

void Gripping::work(StepContext& c, std::size_t t) noexcept {
  const interactions::ToolModel& model = c.model.tool(c.state, t);
  interactions::ToolState& tool = c.state.tools[t];
  const int held = tool.holds, slips = tool.slipped;
  interactions::update_grip(model, c.work.shapes[t], bodies_of(c), tool);
  if (held == 0 && tool.holds > 0) emit_event(c, Event::on_body(Event::grasped, int(t), tool.hold[0].at.body));
  if (held > 0 && tool.holds == 0) emit_grip_end(c, t, slips);
  c.work.shapes[t] = shape_of(c.model, c.state, t);
}

}  // namespace trocar::sim
