// The device's own thread: asks at the box's rate, reads, and hands the newest pose to the simulation's thread. Opens
// the port again when it was gone.
//
//   BoxThread box(port, wiring);                  // throws core::EnvironmentLacks
//   if (box.take(pose)) bridge.take(pose);        // the simulation's thread
//   const BoxStatus status = box.status();        // any thread
#pragma once

#include <atomic>
#include <mutex>
#include <thread>

#include <trocar/devices/box/link.hpp>
#include <trocar/devices/box/reading.hpp>
#include <trocar/devices/durations.hpp>
#include <trocar/devices/mailbox.hpp>

namespace trocar::devices {

BoxDialogueSettings dialogue_settings(const BoxWiring& wiring);

struct BoxStatus {
  bool open = false;
  BoxCounts counts;
  std::uint64_t opened = 0;             ///< times
  double rate = 0;                      ///< blocks a second, over the last second
  BoxTime longest_trip = 0;             ///< of a block, from asking to its last byte, in the last whole second
  double trip_p999 = 0, trip_most = 0;  ///< of all blocks: 99.9 % took no longer; the longest [s]
  BoxTime last = 0;                     ///< when the last block arrived; 0: none has
};

class BoxThread {
 public:
  BoxThread(const std::string& port, const BoxWiring& wiring, ChannelMask mask);
  BoxThread(const std::string& port, const BoxWiring& wiring) : BoxThread(port, wiring, wiring.mask()) {}
  ~BoxThread();
  BoxThread(const BoxThread&) = delete;
  BoxThread& operator=(const BoxThread&) = delete;

  /// One thread only. The newest pose, if there is a newer one.
  bool take(BoxPose& pose) noexcept { return m_poses.take(pose); }
  BoxStatus status() const;

 private:
  void loop();
  void count(const BoxPacket& packet);
  void tell();

  BoxLink m_link;
  BoxReader m_reader;
  Mailbox<BoxPose> m_poses;
  BoxStatus m_now;  ///< the thread's own
  Durations m_trips{1e-5};
  BoxTime m_second_began = 0, m_longest = 0;
  bool m_first_second = true;
  std::uint64_t m_second_blocks = 0;
  mutable std::mutex m_lock;
  BoxStatus m_status;
  std::atomic<bool> m_stop{false};
  std::thread m_thread;  // last: starts when all else is there
};

}  // namespace trocar::devices
