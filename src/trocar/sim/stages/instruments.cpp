#include <algorithm>
#include <cmath>

#include <trocar/sim/stages/instruments.hpp>

namespace trocar::sim {
namespace {

using interactions::ToolShape;

constexpr int kRounds = 3;
constexpr double kBothHands = 250;    // [N/m]
constexpr double kMostPush = 15;      // [N]
constexpr double kStillTouch = 2e-5;  // [m] apart that is touching: what rounding and the other parts leave
constexpr double kNearTrocar = 0.01;  // [m] of a shaft that does not move

/// Where two instruments overlap most.
struct DeepestContact {
  collision::RodContact contact;
  bool there = false;
};

ToolShape shape_of_hand(const StepContext& c, size_t t) noexcept { return shape_of(c.model, c.state, t); }
ToolShape before_of_hand(const StepContext& c, size_t t) noexcept {
  return interactions::shape_before(c.model.tool(c.state, t), c.state.touches[t]);
}

/// @param least  overlap that counts [m]
DeepestContact deepest_contact(const ToolShape& a0, const ToolShape& a, const ToolShape& b0, const ToolShape& b,
                               double least) noexcept {
  DeepestContact deepest;
  deepest.contact.depth = least;
  for (int p = 0; p < end_of(a); p = interactions::next(p))
    for (int q = 0; q < end_of(b); q = interactions::next(q)) {
      Vec3f side{};
      const collision::RodContact now = collision::touch(a0.rod(p), a.rod(p), b0.rod(q), b.rod(q), side);
      if (now.depth > deepest.contact.depth) deepest = {now, true};
    }
  return deepest;
}

double along(Vec3d port, const ToolShape& shape, Vec3d place) noexcept {
  return std::max(kNearTrocar, dot(place - port, shape.shaft.axis()));
}

/// Turns the instrument about its trocar so that its axis moves by `way` where it is met.
void shift(const interactions::ToolModel& tool, Vec3d port, const ToolShape& shape, Vec3d place, Vec3d way,
           interactions::ToolState& state) noexcept {
  const double s = along(port, shape, place);
  const Vec3d to = port + s * shape.shaft.axis() + way;
  kinematics::FulcrumPose pose = kinematics::inverse(port, to, state.roll);
  pose.depth += state.depth - s;
  pose = kinematics::clamped(pose, tool.limits);
  state.yaw = pose.yaw;
  state.pitch = pose.pitch;
  state.depth = pose.depth;
}

/// How far a hand wants its instrument along `n` from where it is, at the place where it is met.
double commanded_displacement(const StepContext& c, size_t t, const ToolShape& shape, Vec3d place, Vec3d n) noexcept {
  const interactions::ToolModel& tool = c.model.tool(c.state, t);
  const ToolInput& in = c.input.tools[t];
  const WristInput& bent = c.input.wrists[t];
  const Vec3d port = port_of(c.model, c.state, t);
  const kinematics::FulcrumPose goal =
      interactions::wanted_arm(tool, held_pose(c.model, c.state, t, pose_of(in)),
                               {double(bent.pitch), double(bent.yaw)}, c.state.tools[t], joints_of(c.state, t))
          .pose;
  if (!std::isfinite(goal.yaw) || !std::isfinite(goal.pitch) || !std::isfinite(goal.depth)) return 0;
  if (in.instrument != c.state.tools[t].instrument) return 0;  // it is being drawn back
  const double s = along(port, shape, place), deeper = goal.depth - c.state.tools[t].depth;
  const Vec3d axis = kinematics::forward(port, goal).axis();
  return dot((port + (s + deeper) * axis) - (port + s * shape.shaft.axis()), n);
}

template <class F>
void for_pairs(const StepContext& c, F f) noexcept {
  for (size_t i = 0; i < c.model.hands.size(); ++i)
    for (size_t j = i + 1; j < c.model.hands.size(); ++j) f(i, j);
}

void add(double (&sum)[3], Vec3d f) noexcept {
  sum[0] += f.x;
  sum[1] += f.y;
  sum[2] += f.z;
}

}  // namespace

void separate_instruments(StepContext& c) noexcept {
  if (!c.model.instruments_push) return;
  for (int round = 0; round < kRounds; ++round)
    for_pairs(c, [&c](size_t i, size_t j) noexcept {
      const ToolShape a = shape_of_hand(c, i), b = shape_of_hand(c, j);
      const DeepestContact m = deepest_contact(before_of_hand(c, i), a, before_of_hand(c, j), b, 0);
      if (!m.there) return;
      const Vec3d half = 0.5 * m.contact.depth * m.contact.normal;
      shift(c.model.tool(c.state, i), port_of(c.model, c.state, i), a, m.contact.on_first, -half, c.state.tools[i]);
      shift(c.model.tool(c.state, j), port_of(c.model, c.state, j), b, m.contact.on_second, half, c.state.tools[j]);
    });
}

void feel_instruments(StepContext& c) noexcept {
  if (!c.model.instruments_push) return;
  for_pairs(c, [&c](size_t i, size_t j) noexcept {
    const ToolShape a = shape_of_hand(c, i), b = shape_of_hand(c, j);
    const DeepestContact m = deepest_contact(a, a, b, b, -kStillTouch);
    if (!m.there) return;
    const Vec3d n = m.contact.normal;
    const double through = commanded_displacement(c, i, a, m.contact.on_first, n) -
                           commanded_displacement(c, j, b, m.contact.on_second, n);
    const Vec3d force = std::clamp(kBothHands * through, 0.0, kMostPush) * n;
    add(c.state.tools[i].contact_force, -force);
    add(c.state.tools[j].contact_force, force);
  });
}

}  // namespace trocar::sim
