// A haptic device: something that is held, says where it is, and pushes back. What all of them have in common, and a
// record of what each can do. Right-handed frame of the device: x to the right, y away from who holds it, z up.
//
//   device->open();                        // throws core::EnvironmentLacks, which says what to do
//   while (...) if (device->read(sample)) device->write({renderer.force(sample.position), ...});
//   device->close();                       // never leaves a force on
//
// One thread at a time, except where a device says otherwise. read() and write() wait for nothing: they are called a
// thousand times a second.
#pragma once

#include <cstdint>
#include <string>

#include <trocar/numerics/quat.hpp>

namespace trocar::devices {

/// What a device can do. 0: it cannot, or nobody knows.
struct HapticCapabilities {
  std::string name;
  double force_max = 0;       ///< [N]
  double torque_max = 0;      ///< [N m]
  double grip_force_max = 0;  ///< [N]
  double stiffness_max = 0;   ///< that it renders stably at 1 kHz [N/m]
  double damping_max = 0;     ///< likewise [N s/m]
  double own_damping = 0;     ///< b of its mechanism: what Colgate's condition lives on [N s/m]
  double own_friction = 0;    ///< of its mechanism, Coulomb's [N]
  double resolution = 0;      ///< of its position [m]
  Vec3d reach;                ///< half the sides of the box in which it moves [m]
  bool turns = false;         ///< its rotation is measured
  bool grips = false;         ///< it has a handle that closes
};

/// What it says. `switches`: bit 0 squeezes the handle, bit 1 locks it, bit 2 is the pedal of coagulation, bit 3 lifts
/// the hand: the instrument stays while it goes back to the middle of what it can reach.
struct HapticSample {
  Vec3d position;  ///< [m]
  Quatd rotation;
  double grip = 0;  ///< 0 open .. 1 closed
  std::uint32_t switches = 0;
  std::uint32_t number = 0;  ///< counts up
};

struct HapticForce {
  Vec3d force;      ///< on the hand [N]
  Vec3d torque;     ///< [N m]
  double grip = 0;  ///< that opens the handle [N]
};

class HapticDevice {
 public:
  virtual ~HapticDevice() = default;

  /// Finds it and makes it ready.  @throws core::EnvironmentLacks
  virtual void open() = 0;
  /// Takes the force away and lets go of it. May be called twice.
  virtual void close() noexcept = 0;
  /// The place where it is now counts as the middle from here on, for devices that have no zero of their own.
  virtual void calibrate() {}
  /// As known when it was opened; the same from then on.
  virtual const HapticCapabilities& capabilities() const noexcept = 0;
  /// What it says of itself since: the newest, once each time that it has said other things; else null. Valid until the
  /// next read().
  virtual const HapticCapabilities* new_capabilities() noexcept { return nullptr; }
  /// False: what it can do is not known yet, so that nothing is to be rendered.
  virtual bool may_push() const noexcept { return true; }

  /// The newest sample; false, and `sample` as it was, where there is none since the last call.
  virtual bool read(HapticSample& sample) noexcept = 0;
  /// Holds until the next one.
  virtual void write(const HapticForce& force) noexcept = 0;

  /// Where the hand that holds a simulated device wants it to be; real ones are held by people.
  virtual void lead(Vec3d) noexcept {}
  virtual bool is_led() const noexcept { return false; }
};

/// Is that a sample that a device can send: finite, within a metre, a rotation?
bool plausible(const HapticSample& sample) noexcept;

}  // namespace trocar::devices
