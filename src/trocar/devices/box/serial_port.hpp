// A serial port as raw bytes (termios): 8 data bits, no parity, one stop bit, no flow control, nothing interpreted.
// Pseudo-terminals count as ports, too. Reading and writing never block.
//
//   SerialPort port = SerialPort::open("/dev/ttyUSB0", 38'400);     // throws core::EnvironmentLacks with the remedy
//   if (port.wait(until)) count = port.read(buffer);                // -1: the port is gone
#pragma once

#include <span>
#include <string>
#include <utility>

#include <trocar/devices/box/box_time.hpp>

namespace trocar::devices {

/// A file descriptor that is closed with its owner.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : m_fd(fd) {}
  Descriptor(Descriptor&& other) noexcept : m_fd(std::exchange(other.m_fd, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor() { close(); }
  void close() noexcept;
  int get() const noexcept { return m_fd; }
  explicit operator bool() const noexcept { return m_fd >= 0; }

 private:
  int m_fd = -1;
};

/// Is it one that terminals here can be set to?
bool known_baud(int baud);

/// Waits until there is something to read, the other end is gone, or `until`. False: neither of the first two.
bool wait_readable(int fd, BoxTime until);
/// Nothing interpreted, nothing echoed. False with errno where it is no terminal. @param baud 0: as it is
bool make_raw(int fd, int baud);

class SerialPort {
 public:
  SerialPort() = default;
  /// What had come before is thrown away.  @throws core::EnvironmentLacks with what to do about it
  static SerialPort open(const std::string& path, int baud);

  explicit operator bool() const { return bool(m_fd); }
  bool wait(BoxTime until) const { return wait_readable(m_fd.get(), until); }
  /// The number of bytes, 0: none now, -1: the port is gone.
  long read(std::span<std::uint8_t> into);
  /// False: the port is gone. What the line has no room for is lost.
  bool write(std::span<const std::uint8_t> bytes);
  void close() { m_fd.close(); }

 private:
  Descriptor m_fd;
};

}  // namespace trocar::devices
