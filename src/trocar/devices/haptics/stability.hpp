// How hard a device may push before it shakes.
#pragma once

#include <trocar/devices/haptics/device.hpp>

namespace trocar::devices {

/// The stiffest spring that a device renders passively, sampled every `period` seconds, with a damper of `damping` in
/// parallel. Colgate's condition b > K T / 2 + |B| solved for K, and what quantised positions and the mechanism's
/// friction allow, K <= 2 f_c / resolution, where both are known; never more than the device says itself. [N/m]
///                                                                          [Colgate & Schenkel 1994]
///                                                                          [Abbott & Okamura 2005]
double stiffest_passive(const HapticCapabilities& device, double period, double damping) noexcept;

/// Time-domain passivity in one place: what the hand has put into what it feels, less what it got back, must not fall
/// below nothing; where it would, a damper takes the difference away.    [Hannaford & Ryu 2002]
///
///   E(n) = E(n-1) - f(n-1) . (x(n) - x(n-1))      exact for a force that holds for a period
///   E(n) < 0:  f(n) -= alpha v(n),  alpha = -E(n) / (T v(n)^2)
///
/// The damper is limited, for a large one shakes by itself, and what was saved or owed long ago does not count: E stays
/// within a window (both are our choice; the paper has neither).
class PassivityControl {
 public:
  struct Limits {
    double damping_max = 10;   ///< [N s/m]
    double energy_max = 0.01;  ///< that may be saved up, or owed [J]
  };
  PassivityControl() = default;
  explicit PassivityControl(const Limits& limits) : m_limits(limits) {}

  /// Position and wanted force of this period; the force to apply. @param period [s]
  Vec3d control(Vec3d position, Vec3d force, double period) noexcept;

  double energy() const noexcept { return m_energy; }    ///< observed, bounded [J]
  double damping() const noexcept { return m_damping; }  ///< that was added in the last period [N s/m]
  void forget() noexcept { *this = PassivityControl(m_limits); }
  void bound_damping(double most) noexcept { m_limits.damping_max = most; }

 private:
  Limits m_limits;
  Vec3d m_position, m_force;
  double m_energy = 0, m_damping = 0;
  bool m_begun = false;
};

/// What goes to a device: no more than it can bear, no faster than it should, and nothing once either side is silent.
class ForceGuard {
 public:
  struct Limits {
    double force_max = 3;     ///< [N]
    double rate_max = 500;    ///< [N/s]
    double patience = 0.050;  ///< a side that was silent for this long is gone [s]
    double fade = 0.100;      ///< from full force to none, and back [s]
  };
  ForceGuard() = default;
  explicit ForceGuard(const Limits& limits) : m_limits(limits) {}

  /// @param silence  the longer of: since the simulation's last model, since the device's last sample [s]
  Vec3d guard(Vec3d force, double silence, double period) noexcept;
  double share() const noexcept { return m_share; }  ///< of the force that is let through, 0 at the beginning
  void bound_force(double most) noexcept { m_limits.force_max = most; }

 private:
  Limits m_limits;
  Vec3d m_last;
  double m_share = 0;
};

}  // namespace trocar::devices
