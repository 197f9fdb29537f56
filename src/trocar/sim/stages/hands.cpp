#include <algorithm>
#include <cmath>

#include <trocar/interactions/instrument/lever.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/stages/hands.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

bool finite(const ToolInput& t) noexcept {
  return std::isfinite(t.yaw) && std::isfinite(t.pitch) && std::isfinite(t.roll) && std::isfinite(t.depth) &&
         std::isfinite(t.handle);
}
bool finite(const WristInput& w) noexcept { return std::isfinite(w.pitch) && std::isfinite(w.yaw); }

float stepped(float from, float to, float most) noexcept { return from + std::clamp(to - from, -most, most); }

constexpr double kParked = 0.012;  // [m] an instrument is changed with its tip this deep: in the trocar's sleeve

constexpr double kIntoWall = 0.0003;  // [m] a tick

/// The memory of which side of each strand the hand's instrument is on.
std::span<Vec3f> sides_of(StepContext& c, size_t t) noexcept {
  const size_t each = c.state.tool_side.size() / c.model.hands.size();
  return {c.state.tool_side.data() + t * each, each};
}

/// Puts the instrument down and takes number `wanted` of the rack.
void change_instrument(StepContext& c, size_t t, std::int32_t wanted) noexcept {
  interactions::ToolState& tool = c.state.tools[t];
  std::int32_t* magazine = c.state.magazine.data() + t * size_t(kMaxRack);
  magazine[tool.instrument] = tool.clips_left;
  interactions::ToolState next;
  next.yaw = tool.yaw;
  next.pitch = tool.pitch;
  next.roll = tool.roll;
  next.depth = tool.depth;
  next.slipped = tool.slipped;
  next.changes = tool.changes + 1;
  next.instrument = wanted;
  next.clips_left = magazine[wanted];
  tool = next;
  if (!c.state.joints.empty()) c.state.joints[t] = {};
  interactions::start_here(next, {}, c.state.touches[t], port_shift(c.state, t));
  for (Vec3f& side : sides_of(c, t)) side = {};
  const size_t each = c.state.sheet_side.size() / c.model.hands.size(), membranes = c.model.membranes.size();
  std::fill_n(c.state.sheet_side.begin() + std::ptrdiff_t(t * each), each, Vec3f{});
  std::fill_n(c.state.sheet_bond.begin() + std::ptrdiff_t(t * membranes), membranes, interactions::SheetBond::none);
  emit_event(c, Event::exchange(int(t), wanted));
}

/// What would go into walls stays at them.
void stop_at_walls(StepContext& c, size_t t, const kinematics::FulcrumPose& wanted,
                   const kinematics::FulcrumPose& before) noexcept {
  const std::span<const interactions::Surface> walls{c.work.surfaces.data() + c.model.organs(), c.model.walls.size()};
  c.work.wall_stops[t] = interactions::stop_at_walls(c.model.tool(c.state, t), wanted, before, joints_of(c.state, t),
                                                     walls, c.state.tools[t], port_shift(c.state, t));
}

bool holds_open_bag(const StepContext& c, size_t t) noexcept {
  if (!c.model.tool(c.state, t).can().bag) return false;
  for (const interactions::BagState& bag : interactions::part_of<interactions::Bag>(c.state))
    if (bag.hand == std::int32_t(t) && bag.hoop > interactions::BagState::kShut) return true;
  return false;
}

/// Joints go where the hand wants them; what of its pose the instrument makes of that goes into the command.
void bend(StepContext& c, size_t t, interactions::ToolCommand& command) noexcept {
  const WristInput& wrist = c.input.wrists[t];
  kinematics::Joints& joints = c.state.joints[t];
  const kinematics::Arm arm = interactions::wanted_arm(
      c.model.tool(c.state, t), command.pose, {double(wrist.pitch), double(wrist.yaw)}, c.state.tools[t], joints);
  command.pose = arm.pose;
  interactions::follow_joints(arm.joints, kTick, joints);
}

/// Trocars' fulcra give way to what pressed on them in the last tick, and wander.
void move_ports(StepContext& c) noexcept {
  for (size_t t = 0; t < c.state.ports.size(); ++t) {
    const kinematics::PortModel& give = c.model.hands[t].give;
    if (!give.moves()) continue;
    const interactions::ToolModel& tool = c.model.tool(c.state, t);
    const interactions::ToolState& state = c.state.tools[t];
    const Vec3d on_wall = interactions::load_at_trocar(tool, state, c.state.touches[t]).on_wall;
    c.state.ports[t] =
        kinematics::moved(give, c.state.ports[t], on_wall, state.pose(), interactions::outside_of(tool, state.depth),
                          double(c.state.tick) * kTick, kTick);
  }
}

/// One hand follows its input. While it wants another instrument it lets go of the tissue, draws back and changes.
void move_hand(StepContext& c, size_t t) noexcept {
  const ToolInput& in = c.input.tools[t];
  interactions::ToolState& tool = c.state.tools[t];
  const bool known = in.instrument >= 0 && size_t(in.instrument) < c.model.hands[t].rack.size();
  if (!known) c.report.flags |= StepReport::kBadInput;
  interactions::ToolCommand command{held_pose(c.model, c.state, t, pose_of(in)), double(in.handle)};
  if (known && in.instrument != tool.instrument) {
    // An empty hand opens its jaws; a bag's mouth is shut before it is drawn out, and a needle drawn in.
    const interactions::Abilities& can = c.model.tool(c.state, t).can();
    command = {tool.pose(), can.bag || can.inject ? 1.0 : 0.0};
    const bool free =
        tool.holds == 0 && !holds_open_bag(c, t) && !bound_by_sling(c, t) && !joints_of(c.state, t).bent();
    if (free) command.pose.depth = kParked;
    if (free && tool.depth <= kParked) change_instrument(c, t, in.instrument);
  }
  if (c.model.tool(c.state, t).bends.bends()) {
    if (known && in.instrument != tool.instrument)
      interactions::follow_joints({}, kTick, c.state.joints[t]);  // straight before it is drawn back
    else
      bend(c, t, command);
  }
  const kinematics::FulcrumPose wanted = command.pose, before = tool.pose();
  // At a wall the way in is of no use: most of the speed goes along it.
  if (c.state.touches[t].near(BodyId::wall(), 0))
    command.pose.depth = std::min(command.pose.depth, tool.depth + kIntoWall);
  interactions::follow(c.model.tool(c.state, t), command, kTick, tool);
  stop_at_walls(c, t, wanted, before);
}

/// Once for as long as the key is held.
void hear_declaration(StepContext& c) noexcept {
  const bool declares = (c.input.pedals & kDeclare) != 0;
  if (declares && !c.state.declaring) emit_event(c, Event::of_hand(Event::declared, 0));
  c.state.declaring = declares;
}

}  // namespace

// Hands: instruments and scope follow the input, no faster than hands can.
void move_hands(StepContext& c) noexcept {
  hear_declaration(c);
  move_ports(c);
  view_walls(c);
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    c.work.wall_stops[t] = {};
    if (finite(c.input.tools[t]) && finite(c.input.wrists[t]))
      move_hand(c, t);
    else
      c.report.flags |= StepReport::kBadInput;
  }
  const ScopeInput& in = c.input.scope;
  if (!finite({in.yaw, in.pitch, in.roll, in.depth, in.post})) {
    c.report.flags |= StepReport::kBadInput;
    return;
  }
  const kinematics::FulcrumPose goal = kinematics::clamped(pose_of(in), c.model.scope.limits);
  ScopeInput& s = c.state.scope;
  s.yaw = stepped(s.yaw, float(goal.yaw), 0.004f);
  s.pitch = stepped(s.pitch, float(goal.pitch), 0.004f);
  s.roll = stepped(s.roll, float(goal.roll), 0.008f);
  s.depth = stepped(s.depth, float(goal.depth), 0.0006f);
  s.post = stepped(s.post, in.post, 0.008f);
}

}  // namespace trocar::sim
