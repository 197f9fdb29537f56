#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/operator/camera_hand.hpp>

namespace trocar::training {
namespace {

constexpr double kMargin = 0.72;                   // of the field's half angle
constexpr double kTurn = 0.7, kAdvance = 0.045;    // [rad/s] [m/s]
constexpr double kShallow = 0.012, kDeep = 0.130;  // [m] lens from the trocar

}  // namespace

CameraHand::CameraHand(const sim::Model& model) : m_port(model.scope.port), m_input(model.start.scope) {
  const kinematics::TipFrame tip = kinematics::forward(m_port, pose_of(m_input));
  m_axis = tip.axis();
  m_depth = double(m_input.depth);
  m_angle = model.scope.angle;
  m_plumb = normalised(-1 * model.gravity, {0, 0, 1});
  const double half = 0.5 * kMargin * model.scope.field_of_view;
  m_cone = portable::sin(half) / portable::cos(half);
}

void CameraHand::show(std::span<const Vec3d> points, double distance) {
  if (points.empty()) return;
  Vec3d middle;
  for (const Vec3d& p : points) middle += normalised(p - m_port);
  const Vec3d wanted = normalised(middle, m_axis);
  const Vec3d turn = wanted - m_axis;
  const double angle = length(turn), most = std::min(kTurn, 0.01 + 5 * angle) * sim::kTick;
  m_axis = angle <= most ? wanted : normalised(m_axis + (most / angle) * turn);
  double depth = kDeep;
  for (const Vec3d& p : points) {
    const double ahead = dot(p - m_port, m_axis), beside = length(p - m_port - ahead * m_axis);
    depth = std::min({depth, ahead - beside / m_cone, ahead - distance});
  }
  depth = std::max(depth, kShallow);
  const double way = depth - m_depth, pace = std::min(kAdvance, 0.001 + 4 * std::fabs(way)) * sim::kTick;
  m_depth += std::clamp(way, -pace, pace);
  m_settled = angle < 0.05 && std::fabs(way) < 0.004;
  put(m_depth);
}

void CameraHand::put(double depth) {
  const kinematics::FulcrumPose pose = kinematics::inverse(m_port, m_port + depth * m_axis, double(m_input.roll));
  m_input.yaw = float(pose.yaw);
  m_input.pitch = float(pose.pitch);
  m_input.depth = float(pose.depth);
}

namespace {

double towards(double now, double wanted, double pace) { return now + std::clamp(wanted - now, -pace, pace); }

double within_half_turn(double angle) {
  while (angle > portable::pi) angle -= 2 * portable::pi;
  while (angle < -portable::pi) angle += 2 * portable::pi;
  return angle;
}

}  // namespace

CameraHand::Pose CameraHand::pose_for(Vec3d at, const std::optional<Vec3d>& facing, double distance) const {
  // Trocar, lens and what is seen are the corners of a triangle whose angle at the lens is the scope's. Around the line
  // from the trocar to what is seen the lens may be anywhere: where it faces best.
  const Vec3d way = at - m_port;
  const double far = length(way);
  const Vec3d ahead = normalised(way, m_axis);
  const double sine = std::min(0.9, distance * portable::sin(m_angle) / std::max(far, distance));
  const double cosine = std::sqrt(1 - sine * sine);
  const Vec3d out = facing.value_or(m_plumb);
  const Vec3d aside = normalised(out - dot(out, ahead) * ahead, m_plumb);
  Pose pose;
  pose.axis = normalised(cosine * ahead + sine * aside);
  pose.depth = std::clamp(far * cosine - distance * portable::cos(m_angle), kShallow, kDeep);
  const kinematics::TipFrame tip =
      kinematics::forward(m_port, {kinematics::inverse(m_port, m_port + pose.axis, 0).yaw,
                                   kinematics::inverse(m_port, m_port + pose.axis, 0).pitch, 0, pose.depth});
  const Vec3d look = at - tip.tip;
  pose.post = portable::atan2(dot(look, tip.opening()), dot(look, tip.normal()));
  return pose;
}

void CameraHand::view(Vec3d at, const std::optional<Vec3d>& facing, double distance) {
  constexpr double kWrist = 1.2, kTurned = 0.15;  // [rad/s]; [rad] before which the lens goes no nearer
  const Pose wanted = pose_for(at, facing, distance);
  const Vec3d turn = wanted.axis - m_axis;
  const double angle = length(turn), most = std::min(kTurn, 0.01 + 5 * angle) * sim::kTick;
  m_axis = angle <= most ? wanted.axis : normalised(m_axis + (most / angle) * turn);
  double post = 0;
  if (m_angle > 0) {
    post = within_half_turn(wanted.post - double(m_input.post));
    m_input.post = float(towards(double(m_input.post), double(m_input.post) + post, kWrist * sim::kTick));
  }
  // The head keeps the horizon level whatever the post does.
  const kinematics::FulcrumPose now = kinematics::inverse(m_port, m_port + m_depth * m_axis, 0);
  const kinematics::ScopeFrame frame = kinematics::scope_frame(m_port, now, m_angle, double(m_input.post));
  const double head = portable::atan2(dot(m_plumb, frame.right), dot(m_plumb, frame.up));
  const double off = within_half_turn(head - double(m_input.roll));
  m_input.roll = float(towards(double(m_input.roll), double(m_input.roll) + off, kWrist * sim::kTick));
  const bool turned = angle < kTurned && std::fabs(post) < kTurned;
  const double way = turned ? wanted.depth - m_depth : std::min(0.0, wanted.depth - 0.02 - m_depth);
  const double pace = std::min(kAdvance, 0.001 + 4 * std::fabs(way)) * sim::kTick;
  m_depth += std::clamp(way, -pace, pace);
  m_settled =
      angle < 0.02 && std::fabs(post) < 0.03 && std::fabs(off) < 0.03 && std::fabs(wanted.depth - m_depth) < 0.002;
  put(m_depth);
}

void CameraHand::fill(sim::Input& input) const { input.scope = m_input; }

}  // namespace trocar::training
