#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/surgeon/needle_lead.hpp>

namespace trocar::training {
namespace {

constexpr double kRollPace = 2.5;  // [rad/s] a wrist that drives a needle
constexpr double kRolled = 0.02;   // [rad]
constexpr int kRefine = 12;        // times that the shaft's direction is looked at again
constexpr int kNearer = 4;         // times that a tip is looked at which leads another place

Vec3d beside_axis(Vec3d v, Vec3d axis) { return v - dot(v, axis) * axis; }

Vec3d jaw_normal(const interactions::ToolModel& tool, const kinematics::FulcrumPose& pose) {
  return interactions::direction_from_jaw(interactions::shape_of(tool, pose, 0), {0, 1, 0});
}

}  // namespace

NeedlePose NeedleWay::at(const suture::NeedleModel& m, double turned) const {
  const Vec3d out = rotate(quat_from_axis_angle(axis, turned), normalised(in - centre));
  const Vec3d own = normalised(m.place(0) - m.centre), z{0, 0, 1};
  const Mat3d from = Mat3d::from_columns(own, cross(z, own), z), to = Mat3d::from_columns(out, cross(axis, out), axis);
  const Quatd q = quat_from_mat3(to * transposed(from));
  return {centre - rotate(q, m.centre), q};
}

NeedleWay way_between(const suture::NeedleModel& m, Vec3d in, Vec3d out, Vec3d up, Vec3d port) {
  NeedleWay way;
  way.in = in;
  const Vec3d middle = 0.5 * (in + out), across = normalised(out - in);
  const double half = std::min(0.5 * length(out - in), 0.98 * m.radius);
  way.angle = 2 * portable::asin(half / m.radius);
  Vec3d rises = normalised(beside_axis(up, across));
  way.axis = cross(across, rises);
  for (int i = 0; i < kRefine; ++i) {
    way.centre = middle + std::sqrt(m.radius * m.radius - half * half) * rises;
    // where the jaws are half way: across from the tissue
    const Vec3d shaft = normalised(way.centre + m.radius * rises - port);
    const Vec3d axis = normalised(beside_axis(shaft, across), way.axis);
    way.axis = dot(axis, cross(rises, across)) < 0 ? -axis : axis;
    rises = normalised(beside_axis(up, across));
    rises = normalised(beside_axis(rises, way.axis), rises);
  }
  // a turn about the axis takes the tip from in to out below
  if (dot(cross(way.axis, in - way.centre), out - in) < 0) way.axis = -way.axis;
  return way;
}

HandWish wish_for(const Surgeon& op, int hand, const NeedlePose& pose) {
  const interactions::ToolModel& tool = op.tool(hand);
  const interactions::ToolShape shape = sim::shape_of(op.model(), op.state(), std::size_t(hand));
  const suture::NeedleState& needle = suture_of(op.state()).needle;
  HandWish wish;
  wish.tip = pose.x + rotate(pose.q, suture::own_of(needle, shape.frame.tip));
  const Vec3d normal = rotate(pose.q, rotate(conjugate(needle.q), interactions::direction_from_jaw(shape, {0, 1, 0})));
  const Vec3d axis = normalised(wish.tip - op.arm(hand).port);
  const Vec3d at0 = jaw_normal(tool, kinematics::inverse(op.arm(hand).port, wish.tip, 0));
  const Vec3d at1 = jaw_normal(tool, kinematics::inverse(op.arm(hand).port, wish.tip, 0.1));
  const Vec3d to = beside_axis(normal, axis);
  double roll = portable::atan2(dot(cross(at0, to), axis), dot(at0, to));
  if (dot(cross(at0, at1), axis) < 0) roll = -roll;
  while (roll - op.arm(hand).roll > portable::pi) roll -= 2 * portable::pi;
  while (roll - op.arm(hand).roll < -portable::pi) roll += 2 * portable::pi;
  wish.roll = roll;
  return wish;
}

HandWish wish_for(const Surgeon& op, int hand, const NeedlePose& pose, double arc) {
  const interactions::ToolModel& tool = op.tool(hand);
  const suture::NeedleModel& m = suture_of(op.model()).needle;
  const interactions::ToolShape now = sim::shape_of(op.model(), op.state(), std::size_t(hand));
  const Vec3d local = interactions::to_jaw(now, suture::needle_point(m, suture_of(op.state()).needle, arc));
  const Vec3d to = pose.x + rotate(pose.q, m.place(arc));
  HandWish wish = wish_for(op, hand, pose);
  for (int i = 0; i < kNearer; ++i) {
    const kinematics::FulcrumPose there = kinematics::inverse(op.arm(hand).port, wish.tip, wish.roll);
    wish.tip += to - interactions::from_jaw(interactions::shape_of(tool, there, 0), local);
  }
  return wish;
}

namespace {

bool lead_to(Surgeon& op, int hand, const HandWish& wish, double speed) {
  Arms::Arm& arm = op.arm(hand);
  const double step = kRollPace * sim::kTick;
  arm.roll += std::clamp(wish.roll - arm.roll, -step, step);
  return op.arms().move(hand, wish.tip, speed) && std::fabs(wish.roll - arm.roll) < kRolled;
}

}  // namespace

bool lead_needle(Surgeon& op, int hand, const NeedlePose& pose, double speed) {
  return lead_to(op, hand, wish_for(op, hand, pose), speed);
}
bool lead_needle(Surgeon& op, int hand, const NeedlePose& pose, double speed, double arc) {
  return lead_to(op, hand, wish_for(op, hand, pose, arc), speed);
}

}  // namespace trocar::training
