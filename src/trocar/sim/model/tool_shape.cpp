#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

kinematics::Joints joints_of(const State& state, size_t hand) noexcept {
  return state.joints.empty() ? kinematics::Joints{} : state.joints[hand];
}

interactions::ToolShape shape_of(const Model& model, const State& state, size_t hand) noexcept {
  const interactions::ToolState& tool = state.tools[hand];
  return interactions::shape_of(model.tool(state, hand), tool.pose(), joints_of(state, hand), tool.aperture);
}

kinematics::TipFrame tip_frame_of(const Model& model, const State& state, size_t hand) noexcept {
  const interactions::ToolModel& tool = model.tool(state, hand);
  return kinematics::forward(tool.bends, model.hands[hand].port, state.tools[hand].pose(), joints_of(state, hand),
                             tool.jaw_length);
}

}  // namespace trocar::sim
