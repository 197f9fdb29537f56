#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/expert/camera_hand.hpp>

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
  const kinematics::FulcrumPose pose = kinematics::inverse(m_port, m_port + m_depth * m_axis, double(m_input.roll));
  m_input.yaw = float(pose.yaw);
  m_input.pitch = float(pose.pitch);
  m_input.depth = float(pose.depth);
}

void CameraHand::fill(sim::Input& input) const { input.scope = m_input; }

}  // namespace trocar::training
