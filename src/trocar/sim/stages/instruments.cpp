#include <algorithm>
#include <array>
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

/// An instrument from the last tick to this one, and a rod around all of it.
struct Moved {
  ToolShape before, now;
  collision::Capsule around;

  void put(const ToolShape& shape) noexcept {
    now = shape;
    around = {now.part[interactions::kShaft].a, now.frame.tip, 0};
    for (int p = 0; p < end_of(now); p = interactions::next(p)) {
      const collision::Capsule& rod = now.rod(p);
      const double beside =
          std::max(length(rod.a - nearest_on_axis(around, rod.a)), length(rod.b - nearest_on_axis(around, rod.b)));
      around.radius = std::max(around.radius, beside + rod.radius + collision::way_of(before.rod(p), rod));
    }
  }
};

/// @param least  overlap that counts [m]
DeepestContact deepest_contact(const Moved& a, const Moved& b, double least) noexcept {
  DeepestContact deepest;
  deepest.contact.depth = least;
  if (!collision::passes_within(a.around.a, a.around.b, b.around.a, b.around.b,
                                a.around.radius + b.around.radius - least))
    return deepest;
  for (int p = 0; p < end_of(a.now); p = interactions::next(p))
    for (int q = 0; q < end_of(b.now); q = interactions::next(q)) {
      Vec3f side{};
      const collision::RodContact met =
          collision::touch(a.before.rod(p), a.now.rod(p), b.before.rod(q), b.now.rod(q), side);
      if (met.depth > deepest.contact.depth) deepest = {met, true};
    }
  return deepest;
}

double along(Vec3d port, const ToolShape& shape, Vec3d place) noexcept {
  return std::max(kNearTrocar, dot(place - port, shape.shaft.axis()));
}

/// Turns an instrument about its trocar so that its axis moves by `way` where it is met.
void shift(StepContext& c, size_t t, Moved& moved, Vec3d place, Vec3d way) noexcept {
  const interactions::ToolModel& tool = c.model.tool(c.state, t);
  interactions::ToolState& state = c.state.tools[t];
  const Vec3d port = port_of(c.model, c.state, t);
  const double s = along(port, moved.now, place);
  const Vec3d to = port + s * moved.now.shaft.axis() + way;
  kinematics::FulcrumPose pose = kinematics::inverse(port, to, state.roll);
  pose.depth += state.depth - s;
  pose = kinematics::clamped(pose, tool.limits);
  state.yaw = pose.yaw;
  state.pitch = pose.pitch;
  state.depth = pose.depth;
  moved.put(shape_of(c.model, c.state, t));
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
  std::array<Moved, kMaxTools> tools;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    tools[t].before = interactions::shape_before(c.model.tool(c.state, t), c.state.touches[t]);
    tools[t].put(shape_of(c.model, c.state, t));
  }
  for (int round = 0; round < kRounds; ++round) {
    bool apart = true;
    for_pairs(c, [&](size_t i, size_t j) noexcept {
      const DeepestContact m = deepest_contact(tools[i], tools[j], 0);
      if (!m.there) return;
      apart = false;
      const double first = along(port_of(c.model, c.state, i), tools[i].now, m.contact.on_first);
      const double second = along(port_of(c.model, c.state, j), tools[j].now, m.contact.on_second);
      const double share = first * first / (first * first + second * second);
      const Vec3d way = m.contact.depth * m.contact.normal;
      shift(c, i, tools[i], m.contact.on_first, -share * way);
      shift(c, j, tools[j], m.contact.on_second, (1 - share) * way);
    });
    if (apart) return;
  }
}

void feel_instruments(StepContext& c) noexcept {
  std::array<Moved, kMaxTools> tools;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    tools[t].before = c.work.shapes[t];
    tools[t].put(c.work.shapes[t]);
  }
  for_pairs(c, [&](size_t i, size_t j) noexcept {
    const ToolShape &a = tools[i].now, &b = tools[j].now;
    const DeepestContact m = deepest_contact(tools[i], tools[j], -kStillTouch);
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
