// From what mouse, keyboard and gamepad did to the Input of the simulation: the led tip, or both led tips, go where the
// hand goes in the picture (inverse fulcrum kinematics), everything else keeps pose and grip. Of the first two hands
// the left one is that at the left for who looks at the instruments.
//
//   HandPilot pilot(model);
//   mailbox.put(pilot.lead(sample, published_state));     // once per picture
//   pilot.take(hand, 2);                                   // another instrument from the rack
//
// While a hand changes its instrument its command stays in the trocar, so that the new one is brought in by the
// trainee: with the wheel or keys, or by insert(), which moves it in until its jaws are in view. Nothing goes in deep
// that nobody sees: insert() waits within the hollow under the trocar until the endoscope shows it.
#pragma once

#include <trocar/devices/both_hands.hpp>
#include <trocar/devices/follower.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::attempt {

class HandPilot {
 public:
  explicit HandPilot(const sim::Model& model);

  /// One sample; `state` is the newest one seen. Returns where everything is commanded to be now.
  const sim::Input& lead(const devices::HandSample& sample, const sim::State& state);
  /// Nobody's hand moves anything, but what runs by itself (an insertion) continues for `dt` seconds.
  const sim::Input& rest(float dt, const sim::State& state);
  bool asks_for_rack() const { return m_asks_for_rack; }  ///< in the last lead()

  /// Both hands at once, or one. Where the scene has no two, one is controlled.
  void lead_both(bool on) { devices::lead_both(m_settings, on, m_hands); }
  bool leads_both() const { return devices::leads_both(m_settings, m_hands); }
  void exchange() { devices::exchange(m_hands); }  ///< of both: what mouse and keys lead
  void choose(int hand);                           ///< lead this one, or devices::kScope
  void take(int instrument);                       ///< the led hand wants this one of its rack
  void insert() { insert(hands().led); }  ///< the led hand's comes into the view by itself; any motion stops it
  void press(std::uint32_t panel_keys) { m_panel_keys |= panel_keys; }  ///< tissue::PanelKey bits, once
  void toggle_ratchet() { devices::toggle_ratchet(m_hands.state); }
  void toggle_fine() { m_hands.state.fine = !m_hands.state.fine; }
  bool changing(int hand, const sim::State& state) const;  ///< its instrument
  bool inserting(int hand) const { return m_inserting[size_t(hand)]; }
  /// Does its insertion continue only when it is seen?
  bool waits_for_eye(int hand) const { return m_inserting[size_t(hand)] && m_unseen[size_t(hand)]; }

  /// After a pause or a lost device: nothing that is held down now acts, every handle keeps its grip.
  void take_up(const devices::HandSample& sample) { devices::take_up(m_settings, sample, m_hands); }

  const sim::Model& model() const { return m_model; }
  const devices::HandState& hands() const { return m_hands.state; }
  const devices::BothHands& both() const { return m_hands; }
  const devices::HandSettings& settings() const { return m_settings; }
  void set(const devices::HandSettings& settings);  ///< the number of instruments stays

 private:
  int waiting(int led, const sim::State& state) const;
  void insert(int hand);
  void move_tool(const devices::HandCommand& command, const kinematics::ScopeFrame& view, const sim::State& state);
  static void bend_tool(const devices::WristMotion& motion, const interactions::ToolModel& tool,
                        const kinematics::TipFrame& straight, const kinematics::ScopeFrame& view,
                        sim::WristInput& wrist);
  void move_scope(const devices::ScopeMotion& motion, const kinematics::ScopeFrame& view);
  void move_in(int hand, float dt, const sim::State& state);
  void go_on(float dt, const sim::State& state);
  std::uint32_t take_panel_keys();

  const sim::Model& m_model;
  devices::HandSettings m_settings;
  devices::BothHands m_hands;
  bool m_asks_for_rack = false;
  sim::Input m_input;
  std::uint32_t m_panel_keys = 0;  ///< pressed since the last sample
  std::array<bool, sim::kMaxTools> m_inserting{}, m_unseen{};
};

/// Commands that come at display rate as smooth motion at 1 kHz: every coordinate of an Input through a critically
/// damped follower. On the simulation's thread.
class SmoothInput {
 public:
  explicit SmoothInput(const sim::Input& start);
  sim::Input step(const sim::Input& target);

 private:
  static constexpr std::size_t kCoordinates = 5 + 7 * sim::kMaxTools;
  devices::Follower<kCoordinates> m_follower;
};

}  // namespace trocar::attempt
