// Haply's Inverse3, through the vendor's service on the same machine: nothing of the vendor's is linked.
#pragma once

#include <chrono>

#include <trocar/devices/haptics/device.hpp>
#include <trocar/devices/haptics/web_socket.hpp>

namespace trocar::devices {

class HaplyDevice : public HapticDevice {
 public:
  static constexpr int kUsualPort = 10001;

  explicit HaplyDevice(int port = kUsualPort, double patience = 3);
  ~HaplyDevice() override { HaplyDevice::close(); }

  void open() override;
  void close() noexcept override;
  const HapticCapabilities& capabilities() const noexcept override { return m_capabilities; }
  bool read(HapticSample& sample) noexcept override;
  void write(const HapticForce& force) noexcept override;

 private:
  using Clock = std::chrono::steady_clock;
  void say(const HapticForce& force);

  int m_port;
  double m_patience;
  HapticCapabilities m_capabilities;
  WebSocket m_socket;
  std::string m_device, m_text;
  bool m_first = true, m_owed = false;  ///< it owes an answer
  Clock::time_point m_asked;
  std::uint32_t m_number = 0;
};

}  // namespace trocar::devices
