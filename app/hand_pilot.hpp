// From what mouse, keyboard and gamepad did to the Input of the simulation: the led tip goes where the hand goes in the
// picture (inverse fulcrum kinematics), everything else keeps pose and grip.
//
//   HandPilot pilot(model);
//   mailbox.put(pilot.lead(sample, published_state));     // once per picture
#pragma once

#include <trocar/devices/follower.hpp>
#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/sim/state.hpp>

namespace trocar::app {

class HandPilot {
 public:
  explicit HandPilot(const sim::Model& model);

  /// One sample; `state` is the newest one seen. Returns where everything is commanded to be now.
  const sim::Input& lead(const devices::HandSample& sample, const sim::State& state);

  const devices::HandState& hands() const { return m_hands; }
  const devices::HandSettings& settings() const { return m_settings; }

 private:
  void move_tool(const devices::HandCommand& command, const kinematics::ScopeFrame& view, const sim::State& state);
  void move_scope(const devices::ScopeMotion& motion, const kinematics::ScopeFrame& view);

  const sim::Model& m_model;
  devices::HandSettings m_settings;
  devices::HandState m_hands;
  sim::Input m_input;
};

/// Commands that come at display rate as smooth motion at 1 kHz: every coordinate of an Input through a critically
/// damped follower. On the simulation's thread.
class SmoothInput {
 public:
  explicit SmoothInput(const sim::Input& start);
  sim::Input step(const sim::Input& target);

 private:
  static constexpr std::size_t kCoordinates = 5 * (1 + sim::kMaxTools);
  devices::Follower<kCoordinates> m_follower;
};

}  // namespace trocar::app
