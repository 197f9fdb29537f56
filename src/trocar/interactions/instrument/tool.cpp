#include <algorithm>

#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kMaxAngularSpeed = 4.0;  // [rad/s] peak of a hand
constexpr double kMaxRollSpeed = 8.0;     // [rad/s]
constexpr double kMaxTipSpeed = 0.6;      // [m/s] along the shaft and across it together
constexpr double kMaxHandleSpeed = 8.0;   // [1/s]
constexpr double kMaxJointSpeed = 6.0;    // [rad/s]
constexpr double kSleeve = 0.018;         // [m] inside, where a trocar ends
constexpr double kUnfolds = 0.010;        // [m] beyond it on which a joint gets its whole range
constexpr int kReachRounds = 4;           // of reaching, a tick
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

/// Pieces between the shaft's end and the jaws' hinge.
void lay_links(const ToolModel& model, const kinematics::Chain& chain, ToolShape& s) noexcept {
  s.links = chain.links;
  for (int i = 0; i < chain.links; ++i) s.link[i] = {chain.bend[i], chain.bend[i + 1], model.shaft_radius};
}

/// Jaws, with frame, pivot and shaft in place.
void lay_jaws(const ToolModel& model, double aperture, ToolShape& s) noexcept {
  if (model.foot > 0) return bend_wire(model, s);
  const Vec3d axis = s.frame.axis(), open = s.frame.opening();
  s.spreads = model.can().spread;
  s.needle_in = model.needle.there ? model.needle.length * (1 - std::clamp(aperture, 0.0, 1.0)) : 0;
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
}

}  // namespace

ToolShape shape_of(const ToolModel& model, const kinematics::FulcrumPose& pose, double aperture) noexcept {
  return shape_of(model, pose, {}, aperture);
}

ToolShape shape_of(const ToolModel& model, const kinematics::FulcrumPose& pose, const kinematics::Joints& joints,
                   double aperture, Vec3d shift) noexcept {
  ToolShape s;
  const Vec3d port = model.port + shift;
  if (model.bends.bends()) {
    const kinematics::Chain chain = kinematics::chain(model.bends, port, pose, joints, model.jaw_length);
    s.frame = chain.tip;
    s.shaft = chain.shaft;
    s.pivot = chain.bend[chain.links];
    lay_links(model, chain, s);
  } else {
    s.frame = kinematics::forward(port, pose);
    s.pivot = s.frame.tip - model.jaw_length * s.frame.axis();
    s.shaft = {s.pivot, s.frame.rotation};
  }
  const double reach = model.jaw_length + model.bends.length();
  const double behind = std::max(0.0, std::min(kShaftInside, pose.depth - reach));
  s.part[kShaft] = {s.shaft.tip - behind * s.shaft.axis(), s.shaft.tip, model.shaft_radius};
  lay_jaws(model, aperture, s);
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

double outside_of(const ToolModel& model, double depth) noexcept {
  return std::max(kinematics::kLeastOutside, model.shaft_length - depth);
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

kinematics::Arm wanted_arm(const ToolModel& model, const kinematics::FulcrumPose& pose, const double (&wrist)[2],
                           const ToolState& state, const kinematics::Joints& joints) noexcept {
  const kinematics::Articulation& bends = model.bends;
  kinematics::Arm arm{kinematics::clamped(pose, model.limits), {}};
  if (!bends.bends()) return arm;
  // The shaft's end leaves the sleeve first.
  const double out = state.depth - model.jaw_length - bends.length() - kSleeve;
  const double share = std::clamp(out / kUnfolds, 0.0, 1.0);
  if (bends.redundant() && share >= 1) {
    const kinematics::TipFrame led = kinematics::led(model.port, arm.pose, wrist[0], wrist[1]);
    arm = kinematics::reach(bends, model.limits, model.port, model.jaw_length, {led.tip, led.rotation},
                            {state.pose(), joints}, kReachRounds);
  } else if (!bends.redundant()) {
    for (int j = 0; j < bends.joints; ++j) arm.joints.angle[j] = wrist[j];
    arm.joints = kinematics::clamped(bends, arm.joints);
  }
  for (double& angle : arm.joints.angle) angle *= share;
  return arm;
}

void follow_joints(const kinematics::Joints& wanted, double dt, kinematics::Joints& joints) noexcept {
  for (int j = 0; j < kinematics::kMaxJoints; ++j)
    joints.angle[j] = stepped(joints.angle[j], wanted.angle[j], kMaxJointSpeed * dt);
}

}  // namespace trocar::interactions
