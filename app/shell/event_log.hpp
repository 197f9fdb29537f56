// What happens in the window as JSON lines, one object a line, flushed at once: for tests that drive the real window,
// and for people who want to know afterwards.
//
//   {"event":"grasped","tick":5120,"tool":"grasper","text":"grasper grasped tube_left"}
//   {"event":"screen","name":"start","widgets":{"Start":[640,700],...}}   what can be pressed, and where, when it
//   changed
//   {"event":"pose", ...}      ten times a second: what an eye sees: instruments, tubes, clips, and how the picture
//   lies
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include <trocar/attempt/live.hpp>
#include <trocar/devices/both_hands.hpp>
#include <trocar/kinematics/fulcrum.hpp>

namespace trocar::app {

class EventLog {
 public:
  /// The path that was given, else TROCAR_WINDOW_LOG.
  static std::string path_of(const std::string& given);
  /// Nothing is logged to an empty path.  @throws core::EnvironmentLacks
  explicit EventLog(const std::string& path);

  void event(const std::string& name, const Json& details = Json::object());
  void moment(const sim::Model& model, const attempt::Moment& moment);
  /// At most ten times a second of simulated time. @param led instrument, or -1 for the scope
  /// @param both  null while one hand is led
  void pose(const sim::Model& model, const attempt::Snapshot& now, int led, const devices::BothHands* both = nullptr);
  bool on() const { return m_file != nullptr; }
  /// Empty, or why lines are missing from the file (the disk is full): told on stderr when it began.
  const std::string& failure() const { return m_failure; }

 private:
  struct Close {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::unique_ptr<std::FILE, Close> m_file;
  std::string m_path, m_failure;
  std::uint64_t m_next_pose = 0, m_last_tick = 0;
};

}  // namespace trocar::app
