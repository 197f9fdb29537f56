// An attempt led by an instrument box: what its hands do is what the instruments do.
//
//   BoxSource source(lesson.model, "/dev/ttyUSB0", wiring, BoxPace::live);   // throws core::EnvironmentLacks
//
// Where the box's hands are when an attempt begins, continues after a pause, or after blocks were missing, the
// instruments are not: they go there no faster than kCatchSpeed, and jaws keep their grip until the handle has come to
// it. After an exchange the new instrument waits in its trocar until the hand has been drawn back less than kDrawnBack
// deep.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include <trocar/attempt/box/box_hands.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/devices/box/box_thread.hpp>

namespace trocar::attempt {

enum class BoxPace {
  live,     ///< ticks keep the clock's time; the box is asked by a thread of its own
  stepped,  ///< the box is asked by ticks, and waited for: for a simulation that may be slower than the clock
};

/// What a box says, tick by tick, of the hands' commands: catching up, exchanging, smoothing. No port and no clock.
class BoxLeader {
 public:
  static constexpr double kDrawnBack = 0.050;  ///< [m]
  static constexpr double kResetHeld = 1;      ///< [s] that the pedal is down until it counts

  BoxLeader(const sim::Model& model, const devices::BoxWiring& wiring);

  void take(const devices::BoxPose& pose) { m_bridge.take(pose); }
  /// The input of the next tick. @param now  as poses are stamped
  sim::Input next(const sim::State& state, devices::BoxTime now);
  /// Time stood still: hands are elsewhere by now.
  void catch_up();
  bool wants_reset() const { return double(m_reset_ticks) * core::kTick >= kResetHeld; }
  bool waits_in_trocar(int hand) const { return m_waits[std::size_t(hand)]; }
  int instrument(int hand) const { return m_instrument[std::size_t(hand)]; }  ///< that is wanted
  const devices::BoxBridge& bridge() const { return m_bridge; }
  const BoxHands& hands() const { return m_hands; }

 private:
  void exchange(const devices::BoxPose& pose, const sim::State& state, sim::Input& wanted);
  void go_towards(const sim::Input& wanted);
  float grip(int hand, float handle);

  const sim::Model& m_model;
  BoxHands m_hands;
  devices::BoxBridge m_bridge;
  sim::Input m_command;
  SmoothInput m_smooth;
  std::array<bool, sim::kMaxTools> m_catches{}, m_waits{}, m_keeps_grip{};
  bool m_scope_catches = true, m_was_frozen = true, m_began = false;
  std::array<int, sim::kMaxTools> m_instrument{};
  std::array<std::uint32_t, devices::kBoxHands> m_changes{};
  std::uint64_t m_reset_ticks = 0;
  bool m_reset_was_up = false;  ///< a foot that restarted is still on it
};

class BoxSource : public InputSource {
 public:
  /// Waits until the box has answered.
  BoxSource(const sim::Model& model, const std::string& port, const devices::BoxWiring& wiring, BoxPace pace);
  bool next(const sim::State& state, sim::Input& input) override;
  std::optional<DeviceNews> device() const override;
  Json describe() const override;

 private:
  struct Ages {
    double sum = 0, most = 0;  ///< [s]
    std::uint64_t count = 0;
  };
  void wait_for_first();
  void step_line(std::uint64_t tick);
  void take_live();
  void keep_pace(std::uint64_t tick);
  void note_age(devices::BoxTime now);
  void note_news(const sim::State& state);
  devices::BoxCounts counts() const;

  const sim::Model& m_model;
  std::string m_port;
  BoxPace m_pace;
  BoxLeader m_leader;
  std::unique_ptr<devices::BoxThread> m_thread;  ///< live
  std::unique_ptr<devices::BoxLink> m_link;      ///< stepped
  devices::BoxReader m_reader;                   ///< stepped
  devices::BoxTime m_tick_time = 0;              ///< stepped: the link's clock
  devices::BoxTime m_first_tick_time = 0;        ///< stepped: what it said at the first tick
  devices::BoxTime m_began = 0, m_last_next = 0;
  std::uint64_t m_next_ask = 0, m_frozen_ticks = 0, m_ticks = 0, m_answered = 0;
  std::uint64_t m_used = 0;  ///< number of the block that was used last
  devices::BoxPose m_pose;
  Ages m_ages;
  mutable std::mutex m_lock;
  DeviceNews m_news;
  std::atomic<std::int64_t> m_acquired{0};
  std::atomic<bool> m_wants_restart{false};
};

/// The source that --input names: box:PORT or box:PORT#FILE, and what make_source() knows.  @throws core::BadInput,
/// core::EnvironmentLacks
std::unique_ptr<InputSource> make_input(const Lesson& lesson, const std::string& input, BoxPace pace);

}  // namespace trocar::attempt
