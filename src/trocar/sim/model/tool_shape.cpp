#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

kinematics::Joints joints_of(const State& state, size_t hand) noexcept {
  return state.joints.empty() ? kinematics::Joints{} : state.joints[hand];
}

Vec3d port_shift(const State& state, size_t hand) noexcept {
  return state.ports.empty() ? Vec3d{0, 0, 0} : state.ports[hand].shift;
}

Vec3d port_of(const Model& model, const State& state, size_t hand) noexcept {
  return model.hands[hand].port + port_shift(state, hand);
}

kinematics::FulcrumPose held_pose(const Model& model, const State& state, size_t hand,
                                  const kinematics::FulcrumPose& pose) noexcept {
  if (state.ports.empty() || !model.hands[hand].give.moves()) return pose;
  return kinematics::about_shifted(pose, state.ports[hand].shift,
                                   interactions::outside_of(model.tool(state, hand), pose.depth));
}

interactions::ToolShape shape_of(const Model& model, const State& state, size_t hand) noexcept {
  const interactions::ToolState& tool = state.tools[hand];
  return interactions::shape_of(model.tool(state, hand), tool.pose(), joints_of(state, hand), tool.aperture,
                                port_shift(state, hand));
}

kinematics::TipFrame tip_frame_of(const Model& model, const State& state, size_t hand) noexcept {
  const interactions::ToolModel& tool = model.tool(state, hand);
  return kinematics::forward(tool.bends, port_of(model, state, hand), state.tools[hand].pose(), joints_of(state, hand),
                             tool.jaw_length);
}

Vec3d led_place(const Model& model, const State& state, size_t hand) noexcept {
  if (model.tool(state, hand).bends.redundant()) return tip_frame_of(model, state, hand).tip;
  return kinematics::forward(port_of(model, state, hand), state.tools[hand].pose()).tip;
}

}  // namespace trocar::sim
