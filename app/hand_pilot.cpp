#include "hand_pilot.hpp"

#include <algorithm>
#include <cstring>

#include <trocar/sim/visibility.hpp>

namespace trocar::app {
namespace {

constexpr double kLeash = 0.02;         // [m] a command runs ahead of the instrument by no more
constexpr double kTimeConstant = 0.01;  // [s] of the smoothing

std::array<float, 3> as_array(Vec3d v) { return {float(v.x), float(v.y), float(v.z)}; }
Vec3d as_vector(const std::array<float, 3>& a) { return {double(a[0]), double(a[1]), double(a[2])}; }

}  // namespace

HandPilot::HandPilot(const sim::Model& model) : m_model(model), m_input(model.start) {
  m_settings.instruments = std::max(1, int(model.tools.size()));
  for (std::size_t t = 0; t < model.tools.size(); ++t) m_hands.handle[t] = model.start.tools[t].handle;
}

const sim::Input& HandPilot::lead(const devices::HandSample& sample, const sim::State& state) {
  const devices::HandCommand command = devices::lead(m_settings, sample, m_hands);
  const kinematics::ScopeFrame view = sim::scope_of(m_model, state);
  if (command.led == devices::kScope)
    move_scope(command.scope, view);
  else if (command.led < int(m_model.tools.size()))
    move_tool(command, view, state);
  for (std::size_t t = 0; t < m_model.tools.size(); ++t) m_input.tools[t].handle = m_hands.handle[t];
  return m_input;
}

void HandPilot::move_tool(const devices::HandCommand& command, const kinematics::ScopeFrame& view,
                          const sim::State& state) {
  const interactions::ToolModel& tool = m_model.tools[size_t(command.led)];
  sim::ToolInput& input = m_input.tools[command.led];
  const Vec3d is_at = kinematics::forward(tool.port, state.tools[size_t(command.led)].pose()).tip;
  const kinematics::TipFrame commanded = kinematics::forward(tool.port, pose_of(input));
  Vec3d tip = commanded.tip + as_vector(devices::in_space(command.tip, as_array(view.right), as_array(view.up),
                                                          as_array(commanded.axis())));
  const double ahead = length(tip - is_at);
  if (ahead > kLeash) tip = is_at + (kLeash / ahead) * (tip - is_at);
  // Clockwise as the hand sees it is against the sense of the fulcrum's roll, whose axis points back to the hand.
  const double roll = double(input.roll) - double(command.roll);
  input = sim::tool_input(kinematics::clamped(kinematics::inverse(tool.port, tip, roll), tool.limits), input.handle);
}

void HandPilot::move_scope(const devices::ScopeMotion& motion, const kinematics::ScopeFrame& view) {
  sim::ScopeInput& scope = m_input.scope;
  const Vec3d port = m_model.scope.port;
  const Vec3d axis = kinematics::forward(port, pose_of(scope)).axis();
  // The view turns by a small rotation about the trocar; an oblique lens turns with its shaft.
  const Vec3d turn = double(motion.up) * view.right - double(motion.right) * view.up;
  const Vec3d turned = normalised(axis + cross(turn, axis));
  const double depth = double(scope.depth) + double(motion.in);
  const double roll = double(scope.roll) - double(motion.head);  // the picture turns against the camera head
  const kinematics::FulcrumPose pose = kinematics::clamped(
      kinematics::inverse(port, port + std::max(depth, m_model.scope.limits.depth_min) * turned, roll),
      m_model.scope.limits);
  scope = {float(pose.yaw), float(pose.pitch), float(pose.roll), float(pose.depth), scope.post + motion.post};
}

namespace {

/// Input's coordinates side by side: the scope's five, then each instrument's five.
std::array<float, 25> coordinates(const sim::Input& input) {
  std::array<float, 25> out;
  static_assert(sizeof(sim::Input) - sizeof(std::uint32_t) == sizeof out);
  std::memcpy(out.data(), &input, sizeof out);
  return out;
}

}  // namespace

SmoothInput::SmoothInput(const sim::Input& start) {
  const std::array<float, kCoordinates> now = coordinates(start);
  for (std::size_t i = 0; i < kCoordinates; ++i) m_follower.mid[i] = m_follower.x[i] = double(now[i]);
}

sim::Input SmoothInput::step(const sim::Input& target) {
  const std::array<float, kCoordinates> to = coordinates(target);
  std::array<double, kCoordinates> wanted;
  std::copy(to.begin(), to.end(), wanted.begin());
  devices::follow(m_follower, wanted, devices::follower_gain(sim::kTick, kTimeConstant));
  std::array<float, kCoordinates> now;
  for (std::size_t i = 0; i < kCoordinates; ++i) now[i] = float(m_follower.x[i]);
  sim::Input out = target;
  std::memcpy(static_cast<void*>(&out), now.data(), sizeof now);
  return out;
}

}  // namespace trocar::app
