#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/haptics/seam_device.hpp>
#include <trocar/devices/haptics/seam_protocol.hpp>
#include <trocar/devices/steady_now.hpp>

namespace trocar::devices {
namespace {

constexpr int kMostDatagrams = 64;  // datagrams looked at in one read()
constexpr auto kListenAgain = std::chrono::milliseconds(1);

/// For devices that do not state their abilities: soft and weak.
HapticCapabilities modest() {
  HapticCapabilities c;
  c.name = "seam";
  c.force_max = 3;
  c.stiffness_max = 800;
  c.damping_max = 2;
  c.own_damping = 0.5;
  c.reach = {0.1, 0.1, 0.1};
  return c;
}

}  // namespace

SeamDevice::SeamDevice(int port, double patience) : m_port(port), m_patience(patience), m_capabilities(modest()) {}

void SeamDevice::bind() {
  if (m_socket >= 0) return;
  m_socket = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(std::uint16_t(m_port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (m_socket < 0 || ::bind(m_socket, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
      getsockname(m_socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    close();
    throw core::EnvironmentLacks(
        tr("seam:{}: cannot listen on port {} of this machine: close the program that does, or take another", m_port,
           m_port));
  }
  m_port = ntohs(address.sin_port);
}

void SeamDevice::open() {
  bind();
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(m_patience);
  HapticSample sample;
  while (!read(sample)) {
    if (std::chrono::steady_clock::now() >= until) {
      const int port = m_port;
      close();
      throw core::EnvironmentLacks(
          tr("seam:{}: no device has sent data on 127.0.0.1:{} for {:g} s: start the program that drives it "
             "(docs/guides/haptics.md), then try again",
             port, port, m_patience));
    }
    std::this_thread::sleep_for(kListenAgain);
  }
}

void SeamDevice::close() noexcept {
  if (m_socket < 0) return;
  write({});
  ::close(m_socket);
  m_socket = -1;
  m_has_peer = false;
}

/// One datagram, if there is one. The first that speaks sense is the device from then on; nobody else is listened to.
bool SeamDevice::take_datagram(HapticSample& sample, bool& any) noexcept {
  std::array<std::uint8_t, 256> bytes;
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const ssize_t n =
      recvfrom(m_socket, bytes.data(), bytes.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
  if (n < 0) return false;
  if (n > ssize_t(bytes.size()) || size != sizeof from) return true;
  if (m_has_peer && (from.sin_port != m_peer.sin_port || from.sin_addr.s_addr != m_peer.sin_addr.s_addr)) return true;
  const std::span<const std::uint8_t> datagram(bytes.data(), std::size_t(n));
  if (const std::optional<HapticCapabilities> can = read_abilities(datagram)) {
    m_stated = *can;
    m_has_stated = true;
    m_has_news = m_has_peer;
    if (!m_has_peer) m_capabilities = *can;
    return true;
  }
  const std::optional<HapticSample> said = read_sample(datagram);
  if (!said) return true;
  if (!m_has_peer) m_first_sample = steady_now();
  m_peer = from;
  m_has_peer = true;
  m_number = said->number;
  sample = *said;
  any = true;
  return true;
}

const HapticCapabilities* SeamDevice::new_capabilities() noexcept {
  return std::exchange(m_has_news, false) ? &m_stated : nullptr;
}

bool SeamDevice::may_push() const noexcept {
  return m_has_stated || steady_now() - m_first_sample >= std::int64_t(1e9 * kPatience);
}

bool SeamDevice::read(HapticSample& sample) noexcept {
  bool any = false;
  for (int i = 0; m_socket >= 0 && i < kMostDatagrams && take_datagram(sample, any); ++i) {
  }
  return any;
}

void SeamDevice::write(const HapticForce& force) noexcept {
  if (m_socket < 0 || !m_has_peer) return;
  std::array<std::uint8_t, kForceBytes> bytes;
  write_force(bytes, m_number, force);
  sendto(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&m_peer), sizeof m_peer);
}

}  // namespace trocar::devices
