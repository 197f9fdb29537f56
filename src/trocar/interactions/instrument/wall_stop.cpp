#include <algorithm>
#include <array>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/instrument/wall_stop.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFromTrocar = 0.040;          // [m] of the shaft that no wall stops
constexpr double kShaftSpacing = 0.020;        // [m] of the points along the shaft that are tested
constexpr double kWallReach = 0.012;           // [m] further than this from its nearest vertex no wall touches a point
constexpr double kBehindWall = 0.005;          // [m]
constexpr double kBesideFoot = 0.0015;         // [m] off the foot of the normal: past the wall's rim
constexpr double kPress = 500;                 // [N/m]
constexpr double kMostStop = 15;               // [N]
constexpr double kQuickestTip = 0.0006;        // [m] that the tip moves in a tick: what hands do, no jumps
constexpr double kWithdraws = 0.0005;          // [m] further out than it is: the hand draws back, and nothing holds it
constexpr int kRounds = 4, kCornerRounds = 8;  // where one wall stops it; where several do
constexpr double kOneWall = 0.9;               // cosine between normals above which it is the same wall

/// A ball of an instrument that a wall may stop.
struct Probe {
  Vec3d at;
  double radius = 0;
  Vec3d on_axis;     ///< the point of the instrument's axis that goes where the wall wants the ball
  double along = 0;  ///< of that, from the trocar [m]
  bool tip = false;
};

struct Deepest {
  double depth = 0;  ///< [m]
  Probe probe;
  Vec3d normal;
};

/// The parts of a wall that an instrument can reach: blocks of its vertices.
struct Blocks {
  static constexpr int kMost = 64;
  std::array<int, kMost> block;
  int count = 0;
  bool all = false;  ///< more than there is room for
};
Blocks blocks_near(const Surface& wall, Vec3d start, Vec3d tip, double reach) noexcept {
  Blocks r;
  for (size_t b = 0; b < wall.pose->block.size() && !r.all; ++b) {
    if (!meets_box(wall.pose->block[b], start, tip, reach)) continue;
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

void look_at(const Surface& wall, const Blocks& blocks, const Probe& probe, Deepest& deepest) noexcept {
  const Vec3d p = probe.at;
  const int vertex = nearest_of(wall, blocks, p);
  if (vertex < 0) return;
  const SkinPoint at = nearest_skin_point(wall, vertex, p);
  const double above = dot(p - at.point, at.normal), depth = probe.radius - above;
  if (above < -kBehindWall || depth <= deepest.depth) return;
  if (length((p - at.point) - above * at.normal) > kBesideFoot) return;
  deepest = {depth, probe, at.normal};
}

/// What the instrument ends in, and where it bends.
struct Ends {
  Probe probe[2 + kinematics::kMaxLinks];
  int count = 1;
};
/// Tip and links of an instrument that bends. Where a wall wants one of them, the point of the straight axis that is as
/// far in goes: nearly the same way, and it is looked at again.
Ends bent_ends(const ToolModel& model, Vec3d port, const kinematics::FulcrumPose& pose,
               const kinematics::Joints& joints) noexcept {
  const ToolShape s = shape_of(model, pose, joints, 0, port - model.port);
  const Vec3d axis = s.shaft.axis();
  Ends r;
  r.count = 0;
  const auto add = [&](Vec3d at, double radius) {
    const double along = std::max(kFromTrocar, dot(at - port, axis));
    r.probe[r.count++] = {at, radius, port + along * axis, along, false};
  };
  add(s.frame.tip, model.jaw_thickness);
  for (int i = 0; i < s.links; ++i) add(s.link[i].b, s.link[i].radius);
  return r;
}

Ends ends_of(const ToolModel& model, Vec3d port, const kinematics::FulcrumPose& pose,
             const kinematics::Joints& joints) noexcept {
  if (model.bends.bends()) return bent_ends(model, port, pose, joints);
  const Vec3d tip = kinematics::forward(port, pose).tip;
  if (!(model.foot > 0)) return {{{tip, model.jaw_thickness, tip, pose.depth, true}, {}}, 1};
  const ToolShape s = shape_of(model, pose, {}, 0, port - model.port);
  const Capsule &wire = s.part[kJawA], &foot = s.part[kJawB];
  return {{{wire.b, wire.radius, tip, pose.depth, true}, {foot.b, foot.radius, tip, pose.depth, true}}, 2};
}

Vec3d axis_of(Vec3d port, const kinematics::FulcrumPose& pose) noexcept {
  return kinematics::forward(port, pose).axis();
}

/// How far beside the straight axis what bends may be.
double bent_reach(const ToolModel& model) noexcept {
  return model.bends.bends() ? model.bends.length() + model.jaw_length : 0.0;
}

Deepest deepest_of(const ToolModel& model, Vec3d port, std::span<const Surface> walls,
                   const kinematics::FulcrumPose& pose, const kinematics::Joints& joints) noexcept {
  Deepest deepest;
  const Vec3d axis = axis_of(port, pose);
  const double depth = pose.depth, reach = kWallReach + model.foot + bent_reach(model);
  const Vec3d tip = port + depth * axis, start = port + std::min(kFromTrocar, depth) * axis;
  const Ends ends = ends_of(model, port, pose, joints);
  for (const Surface& wall : walls) {
    if (!wall.pose->bounds.near_segment(start, tip, reach)) continue;
    const Blocks blocks = blocks_near(wall, start, tip, reach);
    if (!blocks.all && blocks.count == 0) continue;
    for (int i = 0; i < ends.count; ++i) look_at(wall, blocks, ends.probe[i], deepest);
    for (double s = depth - model.jaw_length - model.bends.length(); s > kFromTrocar; s -= kShaftSpacing)
      look_at(wall, blocks, {port + s * axis, model.shaft_radius, port + s * axis, s, false}, deepest);
  }
  return deepest;
}

/// No further from `before` than the tip may go in a tick: a little that the shaft moves near the trocar is a lot
/// there.
void slow_down(Vec3d port, const kinematics::FulcrumPose& before, ToolState& tool) noexcept {
  const double far = length(kinematics::forward(port, tool.pose()).tip - kinematics::forward(port, before).tip);
  if (far <= kQuickestTip) return;
  const double share = kQuickestTip / far;
  tool.yaw = before.yaw + share * (tool.yaw - before.yaw);
  tool.pitch = before.pitch + share * (tool.pitch - before.pitch);
  tool.depth = before.depth + share * (tool.depth - before.depth);
}

/// Walls that stop an instrument in a tick, and where they want the point of its axis that they stop: in a corner two
/// or three.
class WallContacts {
 public:
  int count() const noexcept { return m_count; }

  /// Where the point goes that a further contact stops: in front of that wall's plane and, where an earlier one stops
  /// the same point, of that one's, by the shortest way:
  ///   x' = x + b (m - (n m) n),  b = -(m (x - p)) / (1 - (n m)^2),  m the earlier normal, p its place    [wall corner]
  Vec3d add(const Deepest& d) noexcept {
    Vec3d to = d.probe.on_axis + d.depth * d.normal;
    int place = m_count;
    for (int i = 0; i < m_count; ++i) {
      const Contact& other = m_list[size_t(i)];
      const double c = dot(d.normal, other.normal);
      if (c > kOneWall) {
        place = i;
        continue;
      }
      const bool same_point = d.probe.tip == other.tip && (d.probe.tip || d.probe.along == other.along);
      const double in_front = dot(other.normal, to - other.place);
      if (!same_point || in_front >= 0 || c < -kOneWall) continue;  // walls face to face: too narrow for it
      to += (-in_front / (1 - c * c)) * (other.normal - c * d.normal);
    }
    if (place == kMost) return to;
    m_list[size_t(place)] = {d.normal, to, d.probe.along, d.probe.tip};
    m_count = std::max(m_count, place + 1);
    return to;
  }

  /// What the walls press back with against `pull`, the hand's: each along its normal and none inwards. Their sum is
  /// the part of it that they stop.                                                                       [wall corner]
  Vec3d force_against(Vec3d pull) const noexcept {
    std::array<double, kMost> force{};
    Vec3d left = pull;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (int i = 0; i < m_count; ++i) {
        const double more = std::max(dot(left, m_list[size_t(i)].normal), -force[size_t(i)]);
        force[size_t(i)] += more;
        left -= more * m_list[size_t(i)].normal;
      }
    return pull - left;
  }

 private:
  static constexpr int kMost = 3, kSweeps = 32;
  struct Contact {
    Vec3d normal, place;
    double along = 0;
    bool tip = false;
  };
  std::array<Contact, kMost> m_list;
  int m_count = 0;
};

}  // namespace

WallStop stop_at_walls(const ToolModel& model, const kinematics::FulcrumPose& wanted,
                       const kinematics::FulcrumPose& before, const kinematics::Joints& joints,
                       std::span<const Surface> walls, ToolState& tool, Vec3d shift) noexcept {
  WallStop stop;
  const Vec3d port = model.port + shift;
  if (tool.depth <= kFromTrocar || wanted.depth < tool.depth - kWithdraws) return stop;
  Deepest last;
  WallContacts contacts;
  for (int round = 0; round < (contacts.count() > 1 ? kCornerRounds : kRounds); ++round) {
    const Deepest d = deepest_of(model, port, walls, tool.pose(), joints);
    if (d.depth <= 1e-9) break;
    last = d;
    const Vec3d to = contacts.add(d);
    kinematics::FulcrumPose pose = kinematics::inverse(port, to, tool.roll);
    if (!d.probe.tip) pose.depth = tool.depth;
    pose = kinematics::clamped(pose, model.limits);
    tool.yaw = pose.yaw;
    tool.pitch = pose.pitch;
    tool.depth = pose.depth;
    stop.stopped = true;
    stop.part = d.probe.tip ? kJawA : kShaft;
    stop.normal = d.normal;
  }
  if (!stop.stopped) return stop;
  slow_down(port, before, tool);
  const kinematics::FulcrumPose goal = kinematics::clamped(wanted, model.limits);
  const Probe& at = last.probe;
  const double along = at.tip ? tool.depth : at.along, goal_along = at.tip ? goal.depth : at.along;
  stop.at = port + along * axis_of(port, tool.pose());
  const Vec3d there = port + goal_along * axis_of(port, goal);
  if (contacts.count() == 1) {
    stop.force = std::clamp(kPress * dot(stop.at - there, stop.normal), 0.0, kMostStop);
    return stop;
  }
  const Vec3d force = kPress * contacts.force_against(stop.at - there);
  stop.normal = normalised(force, stop.normal);
  stop.force = std::min(length(force), kMostStop);
  return stop;
}

}  // namespace trocar::interactions
