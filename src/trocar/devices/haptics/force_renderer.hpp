// What a device is to push with, from where it is and what the simulation said last: one call a period, no clock, no
// thread, so that a test can go through it step by step.
//
//   ForceRenderer renderer(device.capabilities(), {});
//   force = renderer.force(sample, model, silence);      // every renderer.settings().period seconds
#pragma once

#include <trocar/devices/haptics/device.hpp>
#include <trocar/devices/haptics/local_model.hpp>
#include <trocar/devices/haptics/stability.hpp>

namespace trocar::devices {

class ForceRenderer {
 public:
  struct Settings {
    double period = 1e-3;         ///< [s]
    bool passivity = true;        ///< PassivityControl watches
    bool limit_stiffness = true;  ///< no stiffer than stiffest_passive() (tests want to see why)
    double rate_max = 500;        ///< of the force, while it grows [N/s]
  };
  ForceRenderer(const HapticCapabilities& device, const Settings& settings);

  /// The device has said that it can do other things: less counts from the next force on, more fades in within
  /// kGrowth.
  void adapt(const HapticCapabilities& device) noexcept { m_wanted = bounds_of(device); }

  /// @param silence  since either side was last heard [s]
  HapticForce force(const HapticSample& sample, const LocalModel& model, double silence) noexcept;

  const Settings& settings() const noexcept { return m_settings; }
  const PassivityControl& passivity() const noexcept { return m_passivity; }
  double share() const noexcept { return m_guard.share(); }
  double stiffness_limit() const noexcept { return m_now.stiffness; }  ///< at the device [N/m]
  double force_limit() const noexcept { return m_now.force; }          ///< [N]

  static constexpr double kGrowth = 1;  ///< [s] from nothing to all

 private:
  /// What a device bears.
  struct Bounds {
    double stiffness = 0, damping = 0, force = 0;
  };
  Bounds bounds_of(const HapticCapabilities& device) const noexcept;
  void follow_bounds() noexcept;
  Vec3d push(Vec3d p, const LocalModel& model, double stiffness) noexcept;
  Vec3d seal(Vec3d p, const LocalModel& model, double stiffness) noexcept;

  Settings m_settings;
  Bounds m_wanted, m_now;
  PassivityControl m_passivity;
  ForceGuard m_guard;
  Vec3d m_proxy, m_last;
  double m_anchor = 0;  ///< of the seal, along the shaft [m]
  bool m_touching = false, m_sealed = false, m_begun = false;
};

}  // namespace trocar::devices
