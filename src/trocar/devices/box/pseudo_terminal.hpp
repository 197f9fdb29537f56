// A serial port that this program itself is the other end of: how the software box is plugged in.
#pragma once

#include <string>

#include <trocar/devices/box/serial_port.hpp>

namespace trocar::devices {

class PseudoTerminal {
 public:
  /// @param link  name under which it is found (a symbolic link, removed in the end); empty: only as name()
  /// @throws core::EnvironmentLacks; core::BadInput where something else has that name
  explicit PseudoTerminal(const std::string& link = {});
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  const std::string& name() const { return m_name; }  ///< "/dev/pts/7"
  bool wait(BoxTime until) const { return wait_readable(m_master.get(), until); }
  /// The number of bytes; 0: none; -1: nobody is at the other end, which may change.
  long read(std::span<std::uint8_t> into);
  void write(std::span<const std::uint8_t> bytes);

  static bool possible();  ///< on this machine

 private:
  Descriptor m_master;
  std::string m_name, m_link;
};

}  // namespace trocar::devices
