// A device that a program of somebody's own brings over the loopback: samples in, forces out, a datagram each. It may
// state its abilities at any time.
#pragma once

#include <netinet/in.h>

#include <trocar/devices/haptics/device.hpp>

namespace trocar::devices {

class SeamDevice : public HapticDevice {
 public:
  /// @param port of this machine on which the program speaks; 0: any, see port()
  /// @param patience  of open() [s]
  explicit SeamDevice(int port, double patience = 5);
  ~SeamDevice() override { SeamDevice::close(); }
  SeamDevice(const SeamDevice&) = delete;
  SeamDevice& operator=(const SeamDevice&) = delete;

  void open() override;
  void close() noexcept override;
  const HapticCapabilities& capabilities() const noexcept override { return m_capabilities; }
  const HapticCapabilities* new_capabilities() noexcept override;
  /// When it has stated its abilities, or has not for kPatience since its first sample.
  bool may_push() const noexcept override;
  bool read(HapticSample& sample) noexcept override;

  static constexpr double kPatience = 0.5;  ///< [s]
  void write(const HapticForce& force) noexcept override;

  int port() const noexcept { return m_port; }
  /// Binds the port without waiting for anybody; open() does so first where it has not been done.
  void bind();

 private:
  bool take_datagram(HapticSample& sample, bool& any) noexcept;

  int m_port;
  double m_patience;
  int m_socket = -1;
  HapticCapabilities m_capabilities;  ///< as of open()
  HapticCapabilities m_stated;        ///< what it said last
  bool m_has_stated = false, m_has_news = false;
  std::int64_t m_first_sample = 0;  ///< when, on the steady clock [ns]
  sockaddr_in m_peer{};
  bool m_has_peer = false;
  std::uint32_t m_number = 0;
};

}  // namespace trocar::devices
