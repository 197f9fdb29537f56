#include <algorithm>
#include <array>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/instrument/wall_stop.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFromTrocar = 0.040;    // [m] of the shaft that no wall stops
constexpr double kShaftSpacing = 0.020;  // [m] of the points along the shaft that are tested
constexpr double kWallReach = 0.012;     // [m] farther than this from its nearest vertex no wall touches a point
constexpr double kBehindWall = 0.005;    // [m]
constexpr double kBesideFoot = 0.0015;   // [m] off the foot of the normal: past the wall's rim
constexpr double kPress = 500;           // [N/m]
constexpr double kMostStop = 15;         // [N]
constexpr double kQuickestTip = 0.0006;  // [m] that the tip moves in a tick: what hands do, no jumps
constexpr double kWithdraws = 0.0005;    // [m] farther out than it is: the hand draws back, and nothing holds it
constexpr int kRounds = 4;

struct Deepest {
  double depth = 0, along = 0;  ///< [m]; along: of the point, from the trocar
  bool tip = false;
  Vec3d point, normal;
};

/// The parts of a wall that an instrument can reach: blocks of its vertices.
struct Blocks {
  static constexpr int kMost = 64;
  std::array<int, kMost> block;
  int count = 0;
  bool all = false;  ///< more than there is room for
};
Blocks blocks_near(const Surface& wall, Vec3d start, Vec3d tip) noexcept {
  Blocks r;
  for (size_t b = 0; b < wall.pose->block.size() && !r.all; ++b) {
    if (!meets_box(wall.pose->block[b], start, tip, kWallReach)) continue;
    r.all = r.count == Blocks::kMost;
    if (!r.all) r.block[size_t(r.count++)] = int(b);
  }
  return r;
}

/// As nearest_vertex_near, of all walls' vertices within reach of the instrument.
int nearest_of(const Surface& wall, const Blocks& blocks, Vec3d p) noexcept {
  if (blocks.all) return nearest_vertex_near(wall, p, kWallReach);
  int best = -1;
  double least = kWallReach * kWallReach;
  for (int k = 0; k < blocks.count; ++k) {
    const int b = blocks.block[size_t(k)];
    if (!wall.pose->block[size_t(b)].reaches(p, kWallReach)) continue;
    const int last = std::min((b + 1) * tissue::kSkinBlock, wall.skin->size());
    for (int v = b * tissue::kSkinBlock; v < last; ++v) {
      const double d = geometry::distance2(wall.position(v), p);
      if (d >= least || !wall.skin->at_surface(v)) continue;
      least = d;
      best = v;
    }
  }
  return best;
}

void look_at(const Surface& wall, const Blocks& blocks, Vec3d p, double radius, double along, bool tip,
             Deepest& deepest) noexcept {
  const int vertex = nearest_of(wall, blocks, p);
  if (vertex < 0) return;
  const SkinPoint at = nearest_skin_point(wall, vertex, p);
  const double above = dot(p - at.point, at.normal), depth = radius - above;
  if (above < -kBehindWall || depth <= deepest.depth) return;
  if (length((p - at.point) - above * at.normal) > kBesideFoot) return;
  deepest = {depth, along, tip, p, at.normal};
}

Deepest deepest_of(const ToolModel& model, std::span<const Surface> walls, Vec3d axis, double depth) noexcept {
  Deepest deepest;
  const Vec3d tip = model.port + depth * axis, start = model.port + std::min(kFromTrocar, depth) * axis;
  for (const Surface& wall : walls) {
    if (!wall.pose->bounds.near_segment(start, tip, kWallReach)) continue;
    const Blocks blocks = blocks_near(wall, start, tip);
    if (!blocks.all && blocks.count == 0) continue;
    look_at(wall, blocks, tip, model.jaw_thickness, depth, true, deepest);
    for (double s = depth - model.jaw_length; s > kFromTrocar; s -= kShaftSpacing)
      look_at(wall, blocks, model.port + s * axis, model.shaft_radius, s, false, deepest);
  }
  return deepest;
}

Vec3d axis_of(const ToolModel& model, const kinematics::FulcrumPose& pose) noexcept {
  return kinematics::forward(model.port, pose).axis();
}

/// No farther from `before` than the tip may go in a tick: a little that the shaft moves near the trocar is a lot
/// there.
void slow_down(const ToolModel& model, const kinematics::FulcrumPose& before, ToolState& tool) noexcept {
  const double far =
      length(kinematics::forward(model.port, tool.pose()).tip - kinematics::forward(model.port, before).tip);
  if (far <= kQuickestTip) return;
  const double share = kQuickestTip / far;
  tool.yaw = before.yaw + share * (tool.yaw - before.yaw);
  tool.pitch = before.pitch + share * (tool.pitch - before.pitch);
  tool.depth = before.depth + share * (tool.depth - before.depth);
}

}  // namespace

WallStop stop_at_walls(const ToolModel& model, const kinematics::FulcrumPose& wanted,
                       const kinematics::FulcrumPose& before, std::span<const Surface> walls,
                       ToolState& tool) noexcept {
  WallStop stop;
  if (tool.depth <= kFromTrocar || wanted.depth < tool.depth - kWithdraws) return stop;
  Deepest last;
  for (int round = 0; round < kRounds; ++round) {
    const Deepest d = deepest_of(model, walls, axis_of(model, tool.pose()), tool.depth);
    if (d.depth <= 1e-9) break;
    last = d;
    const Vec3d to = d.point + d.depth * d.normal;
    kinematics::FulcrumPose pose = kinematics::inverse(model.port, to, tool.roll);
    if (!d.tip) pose.depth = tool.depth;
    pose = kinematics::clamped(pose, model.limits);
    tool.yaw = pose.yaw;
    tool.pitch = pose.pitch;
    tool.depth = pose.depth;
    stop.stopped = true;
    stop.part = d.tip ? kJawA : kShaft;
    stop.normal = d.normal;
  }
  if (!stop.stopped) return stop;
  slow_down(model, before, tool);
  const kinematics::FulcrumPose goal = kinematics::clamped(wanted, model.limits);
  const double along = last.tip ? tool.depth : last.along, goal_along = last.tip ? goal.depth : last.along;
  stop.at = model.port + along * axis_of(model, tool.pose());
  const Vec3d there = model.port + goal_along * axis_of(model, goal);
  stop.force = std::clamp(kPress * dot(stop.at - there, stop.normal), 0.0, kMostStop);
  return stop;
}

}  // namespace trocar::interactions
