#include <algorithm>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/surgeon/arms.hpp>

namespace trocar::training {
namespace {

constexpr double kNear = 0.0006;    // [m] close enough
constexpr double kSquare = 0.02;    // [rad] turned enough
constexpr double kFade = 0.001;     // [m/s] of a tremor that comes or goes
constexpr double kWristTurn = 1.5;  // [rad/s] of a wrist at work

/// The jaws look the same after half a turn: the nearest of the equivalent rolls.
double nearest_roll(double wanted, double now) {
  while (wanted - now > 0.5 * portable::pi) wanted -= portable::pi;
  while (wanted - now < -0.5 * portable::pi) wanted += portable::pi;
  return wanted;
}

}  // namespace

Arms::Arms(const sim::Model& model, const Tremor& tremor) : m_count(int(hands(model))) {
  for (size_t h = 0; h < hands(model); ++h) {
    const sim::ToolInput& in = model.start.tools[h];
    Arm& arm = m_arm[h];
    arm.port = model.hands[h].port;
    arm.tip = kinematics::forward(arm.port, pose_of(in)).tip;
    arm.roll = double(in.roll);
    arm.handle = double(in.handle);
  }
  draw_waves(tremor);
  m_amplitude = m_wanted;
}

void Arms::draw_waves(const Tremor& tremor) {
  core::Random random(tremor.seed * 2654435761u + 17);
  for (auto& hand : m_wave)
    for (auto& axis : hand)
      for (Wave& w : axis) w = {2 * portable::pi * random.uniform(8, 12), random.uniform(0, 2 * portable::pi)};
  m_wanted = tremor.rms * std::sqrt(2.0 / kWaves);
}

void Arms::begin_tick() {
  const double step = kFade * sim::kTick;
  m_amplitude = m_next ? std::max(0.0, m_amplitude - step) : std::min(m_wanted, m_amplitude + step);
  if (m_next && m_amplitude == 0) {
    draw_waves(*m_next);
    m_next.reset();
  }
  for (Arm& arm : m_arm) arm.moving = false;
}

bool Arms::move(int hand, Vec3d goal, double speed) {
  Arm& arm = m_arm[size_t(hand)];
  const Vec3d way = goal - arm.tip;
  const double distance = length(way);
  const double pace = std::min(speed, 0.002 + 6.0 * distance) * sim::kTick;
  arm.tip = distance <= pace ? goal : arm.tip + (pace / distance) * way;
  arm.moving = arm.moving || distance > kNear;
  return distance < kNear;
}

bool Arms::move_to_depth(int hand, double depth, double speed) {
  const Arm& arm = m_arm[size_t(hand)];
  return move(hand, arm.port + depth * normalised(arm.tip - arm.port), speed);
}

bool Arms::turn_across(int hand, Vec3d direction) {
  Arm& arm = m_arm[size_t(hand)];
  const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, arm.tip, arm.roll);
  const double wanted = nearest_roll(kinematics::roll_towards(pose, direction), arm.roll);
  arm.roll += std::clamp(wanted - arm.roll, -kWristTurn * sim::kTick, kWristTurn * sim::kTick);
  return std::fabs(wanted - arm.roll) < kSquare;
}

bool Arms::bend(int hand, const sim::WristInput& to) {
  constexpr double kBending = 1.2;  // [rad/s]
  sim::WristInput& wrist = m_arm[size_t(hand)].wrist;
  const auto most = float(kBending * sim::kTick);
  wrist.pitch += std::clamp(to.pitch - wrist.pitch, -most, most);
  wrist.yaw += std::clamp(to.yaw - wrist.yaw, -most, most);
  return std::fabs(to.pitch - wrist.pitch) + std::fabs(to.yaw - wrist.yaw) < 1e-6f;
}

bool Arms::grip(int hand, double to, double seconds) {
  double& handle = m_arm[size_t(hand)].handle;
  const double pace = sim::kTick / seconds;
  handle += std::clamp(to - handle, -pace, pace);
  return std::fabs(handle - to) < 1e-9;
}

Vec3d Arms::tremor(int hand, std::uint64_t tick) const {
  Vec3d sum;
  if (m_amplitude == 0) return sum;
  const double t = double(tick % 600'000) * sim::kTick;
  for (int axis = 0; axis < 3; ++axis)
    for (const Wave& w : m_wave[size_t(hand)][size_t(axis)])
      sum[axis] += m_amplitude * portable::sin(w.rate * t + w.phase);
  return sum;
}

void Arms::fill(std::uint64_t tick, sim::Input& input) const {
  for (int h = 0; h < m_count; ++h) {
    const Arm& arm = m_arm[size_t(h)];
    const kinematics::FulcrumPose pose = kinematics::inverse(arm.port, arm.tip + tremor(h, tick), arm.roll);
    input.tools[h] = sim::tool_input(pose, float(arm.handle), arm.instrument);
    input.wrists[h] = arm.wrist;
    input.pedals &= ~(sim::irrigates(h) | sim::sucks(h));
    if (arm.coagulating) input.pedals |= sim::kBlue;
    input.pedals |= (arm.irrigating ? sim::irrigates(h) : 0u) | (arm.sucking ? sim::sucks(h) : 0u);
  }
}

}  // namespace trocar::training
