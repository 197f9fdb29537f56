#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/attempt/catch_up.hpp>
#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/tracker/tracked_source.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/steady_now.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::attempt {
namespace {

constexpr std::size_t kNamesTold = 5;  // of tools that are seen instead

/// By whole turns nearest to `before`.
double unwrapped_roll(double roll, double before) {
  const double turns = (before - roll) / portable::two_pi;
  return roll + portable::two_pi * std::floor(turns + 0.5);
}

/// To where its tool is: at once, or, of a tool that was elsewhere in between, slowly.
template <class Pose>
void go_after(bool& catches, Pose& command, const Pose& to) {
  Pose slow = command;
  catches = catches && !approach(slow, to);
  command = to;
  if (catches) command.yaw = slow.yaw, command.pitch = slow.pitch, command.roll = slow.roll, command.depth = slow.depth;
}

}  // namespace

kinematics::FulcrumPose TrackedTool::follow(const devices::TrackedPose& seen, Vec3d port,
                                            const kinematics::FulcrumPose& placed) {
  const Mat3d stands = m_plan.axes * seen.turned;
  const Vec3d tip = m_plan.scale * (m_plan.axes * (seen.place + seen.turned * m_tool.tip));
  if (!m_seen) {
    m_seen = true;
    const kinematics::TipFrame frame = kinematics::forward(port, placed);
    m_from = m_plan.origin ? Vec3d{} : tip;
    m_to = m_plan.origin ? *m_plan.origin : frame.tip;
    m_first = transposed(stands);
    m_opening = frame.opening();
    m_roll = placed.roll;
  }
  const kinematics::FulcrumPose straight = kinematics::inverse(port, m_to + (tip - m_from), 0);
  const kinematics::TipFrame frame = kinematics::forward(port, straight);
  const Vec3d opens = stands * (m_first * m_opening);
  const double across = dot(opens, frame.normal()), along = dot(opens, frame.opening());
  kinematics::FulcrumPose pose = straight;
  // Seen from its end, a tool that points along where the jaws opened says nothing of the roll.
  if (across * across + along * along > 0.01) m_roll = unwrapped_roll(portable::atan2(across, along), m_roll);
  pose.roll = m_roll;
  return pose;
}

TrackedSource::TrackedSource(InputSource& own, const sim::Model& model, const TrackerPlan& plan)
    : m_own(own), m_model(model), m_plan(plan), m_wanted(model.start), m_tracker(plan.address, plan.port) {
  for (const TrackerPlan::Tool& tool : m_plan.tools) {
    Duty duty = duty_of(tool.role, model, m_plan.file);
    duty.pedals = false;
    for (const Led& other : m_led)
      if (duty.overlaps(other.duty))
        throw core::BadInput(
            {{{m_plan.file, 0, 0}, tr("expected tools with different targets, got {} twice", tool.role)}});
    m_led.push_back({&tool, duty, first_of(duty), TrackedTool(m_plan, tool), true, 0});
  }
}

/// What the tracker does not see now, in words.
std::string TrackedSource::missing() const {
  const std::string place = m_tracker.place();
  if (!m_tracker.status().connected) return tr("the tracker at {} has disconnected", place);
  const std::int64_t now = devices::steady_now();
  std::map<std::string, std::string> led_by;  // what is sent, and which tool of the file takes it
  for (const Led& led : m_led) {
    const std::string& name = led.tool->transform;
    const auto seen = m_tracker.pose(name);
    if (!seen || seen->times == 0) return never_seen(name, seen ? seen->unseen : std::string());
    if (const auto [other, is_new] = led_by.emplace(seen->what.name, name); !is_new && other->second != name)
      return tr("the tools {} and {} cannot be distinguished: the tracker cuts both names to {}. Shorten one of them.",
                other->second, name, seen->what.name);
    if (seen->at + devices::kUnseen >= now) continue;
    return seen->unseen.empty() ? tr("the tracked tool {} is not visible", name)
                                : tr("the tracked tool {} is not visible ({})", name, seen->unseen);
  }
  return {};
}

std::string TrackedSource::never_seen(const std::string& name, const std::string& why) const {
  if (!why.empty()) return tr("the tracked tool {} has not been seen yet ({})", name, why);
  std::string others;
  std::size_t count = 0;
  for (const auto& heard : m_tracker.poses())
    if (heard.times > 0 && count++ < kNamesTold) others += (others.empty() ? "" : ", ") + heard.what.name;
  return others.empty() ? tr("the tracked tool {} has not been seen yet", name)
                        : tr("the tracked tool {} has not been seen yet; the tracker sends {}", name, others);
}

std::string TrackedSource::waits_for() const {
  const std::string own = m_own.waits_for();
  return own.empty() ? missing() : own;
}

void TrackedSource::follow(Led& led, const devices::TrackedPose& seen, const sim::State& state,
                           const sim::Input& given) {
  if (led.hand < 0) {
    const kinematics::FulcrumPose pose = led.pose.follow(seen, m_model.scope.port, sim::pose_of(given.scope));
    sim::ScopeInput scope = given.scope;
    scope.yaw = float(pose.yaw), scope.pitch = float(pose.pitch), scope.roll = float(pose.roll);
    scope.depth = float(pose.depth);
    return go_after(led.catches, m_wanted.scope, scope);
  }
  sim::ToolInput& tool = m_wanted.tools[led.hand];
  const sim::ToolInput& theirs = given.tools[led.hand];
  const Vec3d port = m_model.tool(state, std::size_t(led.hand)).port;
  go_after(led.catches, tool,
           sim::tool_input(led.pose.follow(seen, port, sim::pose_of(theirs)), theirs.handle, theirs.instrument));
  m_wanted.wrists[led.hand] = given.wrists[led.hand];
  if (!led.tool->grip) return;
  const TrackerPlan::Grip& grip = *led.tool->grip;
  const auto values = m_tracker.values(grip.sensor);
  if (!values || std::size_t(grip.index) >= values->what.values.size()) return;
  const double closed = (values->what.values[std::size_t(grip.index)] - grip.open) / (grip.closed - grip.open);
  tool.handle = float(std::clamp(closed, 0.0, 1.0));
}

bool TrackedSource::next(const sim::State& state, sim::Input& input) {
  if (!m_own.next(state, input)) return false;
  const std::int64_t now = devices::steady_now();
  const bool stood_still = m_last_next != 0 && now - m_last_next > kStoodStill;
  m_last_next = now;
  for (Led& led : m_led) {
    const auto seen = m_tracker.pose(led.tool->transform);
    if (!seen || seen->times == 0) continue;
    led.catches = led.catches || stood_still || seen->at - led.seen_at > kStoodStill;
    led.seen_at = seen->at;
    follow(led, seen->what, state, input);
  }
  if (!m_smooth) m_smooth = std::make_unique<SmoothInput>(input);
  const sim::Input smooth = m_smooth->step(m_wanted);
  for (const Led& led : m_led) copy(led.duty, smooth, input);
  return true;
}

std::optional<DeviceNews> TrackedSource::device() const {
  if (const std::optional<DeviceNews> own = m_own.device()) return own;
  DeviceNews news;
  const devices::TrackerThread::Status status = m_tracker.status();
  news.text = tr("tracker: {} tools, {} messages", m_led.size(), status.messages);
  for (const Led& led : m_led)
    if (const auto seen = m_tracker.pose(led.tool->transform)) news.acquired = std::max(news.acquired, seen->at);
  return news;
}

Json TrackedSource::describe() const {
  Json out = m_own.describe();
  const devices::TrackerThread::Status status = m_tracker.status();
  Json tools = Json::object();
  for (const Led& led : m_led) tools[led.tool->role] = led.tool->transform;
  out["tracker"] = {{"place", m_tracker.place()},
                    {"tools", tools},
                    {"messages", status.messages},
                    {"damaged", status.damaged},
                    {"connections", status.connections}};
  return out;
}

}  // namespace trocar::attempt
