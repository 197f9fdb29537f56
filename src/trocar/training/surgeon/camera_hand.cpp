#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/surgeon/camera_hand.hpp>

namespace trocar::training {
namespace {

constexpr double kMargin = 0.72;                   // of the field's half angle
constexpr double kShaftTurn = 0.7, kWrist = 1.2;   // [rad/s]: of the shaft; of light post and camera head
constexpr double kAdvance = 0.045;                 // [m/s]
constexpr double kShallow = 0.012, kDeep = 0.130;  // [m] lens from the trocar

double towards(double now, double wanted, double pace) { return now + std::clamp(wanted - now, -pace, pace); }

double within_half_turn(double angle) {
  while (angle > portable::pi) angle -= 2 * portable::pi;
  while (angle < -portable::pi) angle += 2 * portable::pi;
  return angle;
}

/// One tick's turn. @return how far it was from there [rad]
double turn(Vec3d& axis, Vec3d wanted) {
  const Vec3d way = wanted - axis;
  const double angle = length(way), most = std::min(kShaftTurn, 0.01 + 5 * angle) * sim::kTick;
  axis = angle <= most ? wanted : normalised(axis + (most / angle) * way);
  return angle;
}

double turn_post(sim::ScopeInput& input, double wanted) {
  const double post = within_half_turn(wanted - double(input.post));
  input.post = float(towards(double(input.post), double(input.post) + post, kWrist * sim::kTick));
  return post;
}

void advance(double& depth, double way) {
  const double pace = std::min(kAdvance, 0.001 + 4 * std::fabs(way)) * sim::kTick;
  depth += std::clamp(way, -pace, pace);
}

Vec3d mean_direction(Vec3d from, std::span<const Vec3d> points) {
  Vec3d sum;
  for (const Vec3d& p : points) sum += normalised(p - from);
  return sum;
}

double mean_distance(Vec3d from, std::span<const Vec3d> points) {
  double sum = 0;
  for (const Vec3d& p : points) sum += length(p - from);
  return sum / double(points.size());
}

/// From where an oblique lens has all of the points in the picture, `middle` in its middle.
/// @param pose_from  by how far the lens is from it
template <class PoseFrom>
auto pose_of_all(std::span<const Vec3d> points, Vec3d middle, Vec3d port, double cone, double distance,
                 PoseFrom&& pose_from) {
  constexpr int kRounds = 3;  // the further the lens, the less its direction changes
  double off = distance;
  auto pose = pose_from(off);
  for (int i = 0; i < kRounds; ++i) {
    const Vec3d looks = normalised(middle - port - pose.depth * pose.axis);
    for (const Vec3d& p : points) {
      const double beyond = dot(p - middle, looks), beside = length(p - middle - beyond * looks);
      off = std::max({off, beside / cone - beyond, distance - beyond});
    }
    pose = pose_from(off);
  }
  return pose;
}

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

void CameraHand::show(std::span<const Vec3d> points, double distance, const std::optional<Vec3d>& facing) {
  if (points.empty()) return;
  const Vec3d ahead = normalised(mean_direction(m_port, points), m_axis);
  double angle = 0, depth = kDeep, post = 0;
  if (m_angle > 0) {
    const Vec3d middle = m_port + mean_distance(m_port, points) * ahead;
    const Pose wanted = pose_of_all(points, middle, m_port, m_cone, distance,
                                    [&](double off) { return pose_for(middle, facing, off); });
    angle = turn(m_axis, wanted.axis);
    post = turn_post(m_input, wanted.post);
    depth = wanted.depth;
  } else {
    angle = turn(m_axis, ahead);
    for (const Vec3d& p : points) {
      const double before = dot(p - m_port, m_axis), beside = length(p - m_port - before * m_axis);
      depth = std::min({depth, before - beside / m_cone, before - distance});
    }
    depth = std::max(depth, kShallow);
  }
  const double way = depth - m_depth;
  advance(m_depth, way);
  m_settled = angle < 0.05 && std::fabs(post) < 0.05 && std::fabs(way) < 0.004;
  put(m_depth);
}

void CameraHand::put(double depth) {
  const kinematics::FulcrumPose pose = kinematics::inverse(m_port, m_port + depth * m_axis, double(m_input.roll));
  m_input.yaw = float(pose.yaw);
  m_input.pitch = float(pose.pitch);
  m_input.depth = float(pose.depth);
}

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
  pose.depth = far * cosine - distance * portable::cos(m_angle);
  if (pose.depth < kShallow || pose.depth > kDeep) {
    // It cannot go there: the triangle of how far it can.
    pose.depth = std::clamp(pose.depth, kShallow, kDeep);
    const double across = std::min(0.9, pose.depth * portable::sin(m_angle) / std::max(far, pose.depth));
    const double turned = m_angle - portable::atan2(across, std::sqrt(1 - across * across));
    pose.axis = normalised(portable::cos(turned) * ahead + portable::sin(turned) * aside);
  }
  const kinematics::TipFrame tip =
      kinematics::forward(m_port, {kinematics::inverse(m_port, m_port + pose.axis, 0).yaw,
                                   kinematics::inverse(m_port, m_port + pose.axis, 0).pitch, 0, pose.depth});
  const Vec3d look = at - tip.tip;
  pose.post = portable::atan2(dot(look, tip.opening()), dot(look, tip.normal()));
  return pose;
}

void CameraHand::view(Vec3d at, const std::optional<Vec3d>& facing, double distance) {
  constexpr double kTurned = 0.15;  // [rad] before which the lens goes no nearer
  const Pose wanted = pose_for(at, facing, distance);
  const double angle = turn(m_axis, wanted.axis), post = m_angle > 0 ? turn_post(m_input, wanted.post) : 0;
  // The head keeps the horizon level whatever the post does.
  const kinematics::FulcrumPose now = kinematics::inverse(m_port, m_port + m_depth * m_axis, 0);
  const kinematics::ScopeFrame frame = kinematics::scope_frame(m_port, now, m_angle, double(m_input.post));
  const double head = portable::atan2(dot(m_plumb, frame.right), dot(m_plumb, frame.up));
  const double off = within_half_turn(head - double(m_input.roll));
  m_input.roll = float(towards(double(m_input.roll), double(m_input.roll) + off, kWrist * sim::kTick));
  const bool turned = angle < kTurned && std::fabs(post) < kTurned;
  advance(m_depth, turned ? wanted.depth - m_depth : std::min(0.0, wanted.depth - 0.02 - m_depth));
  m_settled =
      angle < 0.02 && std::fabs(post) < 0.03 && std::fabs(off) < 0.03 && std::fabs(wanted.depth - m_depth) < 0.002;
  put(m_depth);
}

void CameraHand::fill(sim::Input& input) const { input.scope = m_input; }

}  // namespace trocar::training
