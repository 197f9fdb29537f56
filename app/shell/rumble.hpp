// The motors of a gamepad, which GLFW does not know: Linux's force feedback of input devices. The pad is found by its
// bus, vendor, product and version, which GLFW tells in its GUID. Where nobody may write to it, or it has no motors,
// nothing happens and nobody is told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace trocar::app {

/// What identifies an input device.
struct PadIds {
  std::uint16_t bus = 0, vendor = 0, product = 0, version = 0;
  friend bool operator==(const PadIds&, const PadIds&) = default;
};
/// Of a GUID as GLFW writes it, 32 hexadecimal digits; nothing where it is no such one, or says no vendor.
std::optional<PadIds> ids_of_guid(const std::string& guid);

/// 0..1 as the kernel wants it.
std::uint16_t motor_level(double share);

class Rumble {
 public:
  Rumble() = default;
  ~Rumble() { let_go(); }
  Rumble(const Rumble&) = delete;
  Rumble& operator=(const Rumble&) = delete;

  /// The pad in use; empty: none. Looks for it when it is another one than before.
  void use(const std::string& guid);
  /// How both motors shall turn from now on. @param now real time [s]
  void set(double strong, double weak, double now);
  bool turns() const { return m_device >= 0; }

 private:
  void let_go();
  void send(std::uint16_t strong, std::uint16_t weak);

  std::string m_guid;
  int m_device = -1, m_effect = -1;
  std::uint16_t m_strong = 0, m_weak = 0;
  double m_sent = 0;
};

}  // namespace trocar::app
