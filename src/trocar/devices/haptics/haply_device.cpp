#include <exception>
#include <thread>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/haptics/haply_device.hpp>
#include <trocar/devices/haptics/haply_messages.hpp>

namespace trocar::devices {
namespace {

constexpr auto kLookAgain = std::chrono::milliseconds(1);
constexpr auto kAskAgain = std::chrono::milliseconds(20);  // after an answer that never came
constexpr int kMostAtOnce = 8;                             // messages looked at in one read()
constexpr double kReach = 0.1, kSmallReach = 0.04;         // [m] the radii that the vendor's own examples keep within

/// The vendor's pages state no figures; these are our estimates, and cautious.
HapticCapabilities cautious() {
  HapticCapabilities c;
  c.name = "Haply Inverse3";
  c.force_max = 5;
  c.stiffness_max = 1000;
  c.damping_max = 2;
  c.own_damping = 0.6;
  c.reach = {kReach, kReach, kReach};
  return c;
}

}  // namespace

HaplyDevice::HaplyDevice(int port, double patience) : m_port(port), m_patience(patience), m_capabilities(cautious()) {}

void HaplyDevice::open() {
  const std::string what = fmt::format("haply:{}", m_port);
  if (const std::string fault = m_socket.connect(m_port, "/", m_patience); !fault.empty())
    throw core::EnvironmentLacks(
        tr("{}: no Inverse Service on port {} of this machine ({}): start it (systemctl start "
           "haply-inverse-service), or name its port",
           what, m_port, fault));
  const auto until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(m_patience));
  std::optional<HaplyState> state;
  while (!state && m_socket.connected() && Clock::now() < until) {
    while (!state && m_socket.receive(m_text)) state = read_haply(m_text);
    if (!state) std::this_thread::sleep_for(kLookAgain);
  }
  if (!state) {
    close();
    throw core::EnvironmentLacks(
        tr("{}: the Inverse Service knows of no Inverse3: plug it in, switch it on and calibrate it, then try again",
           what));
  }
  m_device = state->device;
  m_capabilities.turns = state->turns;
  if (state->small) m_capabilities.reach = {kSmallReach, kSmallReach, kSmallReach};
  m_first = true;
  m_owed = false;
  say({});
}

void HaplyDevice::close() noexcept {
  if (!m_socket.connected()) return;
  try {
    if (!m_device.empty()) m_socket.send(haply_command(m_device, {}, false));
  } catch (const std::exception&) {  // no memory: the service takes the force away itself when we are gone
  }
  m_socket.close();
}

void HaplyDevice::say(const HapticForce& force) {
  m_socket.send(haply_command(m_device, force.force, m_first));
  m_first = false;
  m_owed = true;
  m_asked = Clock::now();
}

/// The newest of what has come. A message that makes no sense is left out; one that never ends ends the connection.
bool HaplyDevice::read(HapticSample& sample) noexcept {
  bool any = false;
  try {
    for (int i = 0; i < kMostAtOnce && m_socket.receive(m_text); ++i) {
      m_owed = false;
      const std::optional<HaplyState> state = read_haply(m_text);
      if (!state || state->device != m_device) continue;
      sample = state->sample;
      sample.number = ++m_number;
      any = true;
    }
  } catch (const std::exception&) {
    m_socket.close();
  }
  return any;
}

/// One message is on its way at a time: the service answers each, and a queue would be old news.
void HaplyDevice::write(const HapticForce& force) noexcept {
  if (!m_socket.connected() || (m_owed && Clock::now() - m_asked < kAskAgain)) return;
  try {
    say(force);
  } catch (const std::exception&) {
    m_socket.close();
  }
}

}  // namespace trocar::devices
