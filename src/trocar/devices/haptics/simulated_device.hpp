// A device that is not there, in a hand that is not there either: a mass on the spring and damper of a hand, with the
// mechanism's own damping, friction and quantised position. For tests, and for trials without one.
//
//   SimulatedDevice device({.mass = 0.2});
//   device.lead({0, 0, -0.01});                 // where the hand wants to be; from any one thread
//   device.read(sample);  device.write(force);  // each read() is a period later
#pragma once

#include <trocar/devices/haptics/device.hpp>
#include <trocar/devices/mailbox.hpp>

namespace trocar::devices {

class SimulatedDevice : public HapticDevice {
 public:
  struct Settings {
    double mass = 0.2;            ///< of mechanism and hand [kg]
    double hand_stiffness = 800;  ///< [N/m]
    double hand_damping = 8;      ///< [N s/m]
    double own_damping = 2;       ///< b of the mechanism [N s/m]
    double own_friction = 0;      ///< Coulomb's [N]
    double resolution = 1e-5;     ///< of the reported position [m]; 0: exact
    double force_max = 10;        ///< [N]
    double period = 1e-3;         ///< between two reads [s]
    int inner_steps = 10;         ///< a period
  };
  SimulatedDevice() : SimulatedDevice(Settings()) {}
  explicit SimulatedDevice(const Settings& settings);

  void open() override {}
  void close() noexcept override { m_force = {}; }
  const HapticCapabilities& capabilities() const noexcept override { return m_capabilities; }
  bool read(HapticSample& sample) noexcept override;
  void write(const HapticForce& force) noexcept override { m_force = force.force; }
  void lead(Vec3d hand) noexcept override { m_wanted.put(hand); }
  bool is_led() const noexcept override { return true; }

  Vec3d position() const noexcept { return m_x; }  ///< the true one [m]
  Vec3d velocity() const noexcept { return m_v; }  ///< [m/s]
  /// What write() did to the mass so far: work of the force on the device [J].
  double work() const noexcept { return m_work; }

 private:
  void advance(double dt) noexcept;
  void kick(double dt) noexcept;

  Settings m_settings;
  HapticCapabilities m_capabilities;
  Mailbox<Vec3d> m_wanted;
  Vec3d m_hand, m_x, m_v, m_force;
  double m_work = 0;
  std::uint32_t m_number = 0;
};

}  // namespace trocar::devices
