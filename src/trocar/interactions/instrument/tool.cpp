#include <algorithm>

#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kMaxAngularSpeed = 4.0;  // [rad/s] peak of a hand
constexpr double kMaxRollSpeed = 8.0;     // [rad/s]
constexpr double kMaxTipSpeed = 0.6;      // [m/s] along the shaft and across it together
constexpr double kMaxHandleSpeed = 8.0;   // [1/s]
constexpr double kShaftInside = 0.14;     // [m] of the shaft behind the jaws that can meet tissue

/// The wire and its foot end where closed jaws would: nothing of them reaches beyond the tip.
void bend_wire(const ToolModel& model, ToolShape& s) noexcept {
  const double radius = 0.5 * model.jaw_thickness;
  const Vec3d bend = s.frame.tip - radius * s.frame.axis();
  s.has_foot = true;
  s.part[kJawA] = {s.pivot, bend, radius};
  s.part[kJawB] = {bend, bend + std::max(0.0, model.foot - radius) * s.frame.opening(), radius};
}

double stepped(double from, double to, double most) noexcept { return from + std::clamp(to - from, -most, most); }

}  // namespace

ToolShape shape_of(const ToolModel& model, const kinematics::FulcrumPose& pose, double aperture) noexcept {
  ToolShape s;
  s.frame = kinematics::forward(model.port, pose);
  const Vec3d axis = s.frame.axis(), open = s.frame.opening();
  s.pivot = s.frame.tip - model.jaw_length * axis;
  const double behind = std::max(0.0, std::min(kShaftInside, pose.depth - model.jaw_length));
  s.part[kShaft] = {s.pivot - behind * axis, s.pivot, model.shaft_radius};
  if (model.foot > 0) {
    bend_wire(model, s);
    return s;
  }
  s.spreads = model.can().spread;
  s.half_gap = 0.5 * model.parallel_gap * aperture;
  s.half_angle = 0.5 * model.opening * aperture;
  const double c = portable::cos(s.half_angle), sn = portable::sin(s.half_angle);
  s.tangent = sn / c;
  const double half_thick = 0.5 * model.jaw_thickness;
  for (int jaw = 0; jaw < 2; ++jaw) {
    const double side = jaw == 0 ? 1.0 : -1.0;
    const Vec3d root = s.pivot + side * (s.half_gap + half_thick) * open;
    const Vec3d along = c * axis + side * sn * open;
    s.part[kJawA + jaw] = {root, root + model.jaw_length * along, half_thick};
  }
  return s;
}

Vec3d to_jaw(const ToolShape& shape, Vec3d world) noexcept {
  const Vec3d d = world - shape.pivot;
  return {dot(d, shape.frame.opening()), dot(d, shape.frame.normal()), dot(d, shape.frame.axis())};
}

Vec3d direction_from_jaw(const ToolShape& shape, Vec3d local) noexcept {
  return local.x * shape.frame.opening() + local.y * shape.frame.normal() + local.z * shape.frame.axis();
}

Vec3d from_jaw(const ToolShape& shape, Vec3d local) noexcept { return shape.pivot + direction_from_jaw(shape, local); }

double aperture_at(const ToolModel& model, double thickness, double along) noexcept {
  if (model.parallel_gap > 0) return std::min(1.0, thickness / model.parallel_gap);
  const double reach = std::max(along, 0.003);
  const double half = portable::atan2(0.5 * thickness, reach);
  return std::min(1.0, 2.0 * half / model.opening);
}

void follow(const ToolModel& model, const ToolCommand& command, double dt, ToolState& state) noexcept {
  const kinematics::FulcrumPose goal = kinematics::clamped(command.pose, model.limits);
  const double yaw = stepped(state.yaw, goal.yaw, kMaxAngularSpeed * dt) - state.yaw;
  const double pitch = stepped(state.pitch, goal.pitch, kMaxAngularSpeed * dt) - state.pitch;
  const double depth = goal.depth - state.depth;
  const double turn = yaw * yaw + pitch * pitch;  // no less than the angle between the axes before and after
  const double way = std::sqrt(state.depth * state.depth * turn + depth * depth), most = kMaxTipSpeed * dt;
  if (way > most) {
    const double share = most / way;
    state.yaw += share * yaw;
    state.pitch += share * pitch;
    state.depth += share * depth;
  } else {
    state.yaw = stepped(state.yaw, goal.yaw, kMaxAngularSpeed * dt);
    state.pitch = stepped(state.pitch, goal.pitch, kMaxAngularSpeed * dt);
    state.depth = goal.depth;
  }
  state.roll = stepped(state.roll, goal.roll, kMaxRollSpeed * dt);
  state.handle = stepped(state.handle, std::clamp(command.handle, 0.0, 1.0), kMaxHandleSpeed * dt);
}

}  // namespace trocar::interactions
