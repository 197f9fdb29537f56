// The thread that listens to a tracker's server (OpenIGTLink over TCP), and connects again when it was gone: three
// times a second at most, also where the server accepts and hangs up.
//
//   TrackerThread tracker("127.0.0.1", 18944);        // throws core::EnvironmentLacks
//   if (const auto seen = tracker.pose("Grasper")) ...  // any thread
#pragma once

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <trocar/devices/tracker/igtl.hpp>

namespace trocar::devices {

inline constexpr std::int64_t kUnseen = 500'000'000;  ///< a tool that was not seen for so long is away [ns]

class TrackerThread {
 public:
  TrackerThread(std::string address, int port);
  ~TrackerThread();
  TrackerThread(const TrackerThread&) = delete;
  TrackerThread& operator=(const TrackerThread&) = delete;

  template <class T>
  struct Heard {
    T what;
    std::int64_t at = 0;      ///< when it came, on the steady clock [ns]
    std::uint64_t times = 0;  ///< 0: its server has only said that it does not see it
    std::string unseen;       ///< why its server does not see it since; empty: it does
  };
  struct Status {
    bool connected = false;
    std::uint64_t messages = 0, damaged = 0, connections = 0;
  };

  /// Of that name, whole or as the protocol cuts it, the newest; nothing: none has come, or several are cut to the
  /// same.
  std::optional<Heard<TrackedPose>> pose(const std::string& name) const;
  std::optional<Heard<SensorValues>> values(const std::string& name) const;
  std::vector<Heard<TrackedPose>> poses() const;
  std::vector<Heard<SensorValues>> all_values() const;
  Status status() const;
  /// "127.0.0.1:18944"
  std::string place() const { return m_address + ':' + std::to_string(m_port); }

 private:
  void loop();
  void listen();
  void hang_up();

  std::string m_address;
  int m_port;
  int m_socket = -1;
  IgtlReader m_reader;
  std::uint64_t m_messages_before = 0, m_damaged_before = 0;  ///< of connections that are over
  mutable std::mutex m_lock;                                  ///< of all below
  std::map<std::string, Heard<TrackedPose>> m_poses;          ///< IgtlReader::kMostTools at most
  std::map<std::string, Heard<SensorValues>> m_values;
  Status m_status;
  std::atomic<bool> m_stop{false};
  std::thread m_thread;  // last: starts when all else is there
};

}  // namespace trocar::devices
