// The loop of a device: a thousand times a second, on a thread of its own, whatever the simulation and the pictures
// take. It reads the device, renders the newest local model, writes the force, and reports the device's position.
//
//   HapticLoop loop(std::move(device));     // starts at once, with a force that fades in
//   loop.put(model);                         // the simulation, every tick
//   if (loop.take(report)) ...               // the simulation: where the hand is
//   loop.stop();                             // the force is taken away, the device closed
//
// Periods begin on an absolute clock, so that a late one does not shift those after it; whole periods that were missed
// are counted and left out. Where the system allows it the thread has a real-time priority.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include <trocar/devices/durations.hpp>
#include <trocar/devices/haptics/force_renderer.hpp>
#include <trocar/devices/mailbox.hpp>

namespace trocar::devices {

/// Where the hand is, and what it feels.
struct HandReport {
  HapticSample sample;
  Vec3d force;                        ///< on the device [N]
  double share = 0;                   ///< of the force that is let through
  double damping = 0;                 ///< that passivity asks for just now [N s/m]
  std::int32_t lost = 0;              ///< 1: the device has not spoken for a while
  std::int32_t turns = 0, grips = 0;  ///< 1: the device measures that, as far as it has said
};

class HapticLoop {
 public:
  /// The device is open.
  HapticLoop(std::unique_ptr<HapticDevice> device, const ForceRenderer::Settings& settings = {});
  ~HapticLoop() { stop(); }
  HapticLoop(const HapticLoop&) = delete;
  HapticLoop& operator=(const HapticLoop&) = delete;

  void put(const LocalModel& model) noexcept { m_models.put(model); }
  bool take(HandReport& report) noexcept { return m_reports.take(report); }
  void stop() noexcept;

  HapticDevice& device() noexcept { return *m_device; }
  const HapticCapabilities& capabilities() const noexcept { return m_device->capabilities(); }
  const Durations& periods() const noexcept { return m_periods; }  ///< from the start of one to the start of the next
  const Durations& computing() const noexcept { return m_computing; }  ///< within one
  std::uint64_t missed() const noexcept { return m_missed.load(std::memory_order_relaxed); }
  bool real_time() const noexcept { return m_real_time.load(); }  ///< the priority was given

 private:
  void run() noexcept;
  void once(double now) noexcept;

  std::unique_ptr<HapticDevice> m_device;
  ForceRenderer m_renderer;
  Mailbox<LocalModel> m_models;
  Mailbox<HandReport> m_reports;
  Durations m_periods, m_computing;
  std::atomic<std::uint64_t> m_missed{0};
  std::atomic<bool> m_stop{false}, m_real_time{false};

  // The loop's own.
  LocalModel m_model;
  HandReport m_report;
  double m_model_at = -1, m_sample_at = -1;  ///< when last heard of [s]; below 0: never

  std::thread m_thread;  // last
};

}  // namespace trocar::devices
