#include <cmath>

#include <trocar/devices/haptics/simulated_device.hpp>

namespace trocar::devices {
namespace {

constexpr double kSimulatedReach = 0.15;  // [m]

double rounded(double value, double step) { return step > 0 ? step * std::floor(value / step + 0.5) : value; }

}  // namespace

SimulatedDevice::SimulatedDevice(const Settings& s) : m_settings(s) {
  m_capabilities.name = "simulated";
  m_capabilities.force_max = s.force_max;
  m_capabilities.own_damping = s.own_damping + s.hand_damping;  // the holding hand damps it, too
  m_capabilities.own_friction = s.own_friction;
  m_capabilities.damping_max = 0.25 * s.mass / s.period;
  m_capabilities.resolution = s.resolution;
  m_capabilities.reach = {kSimulatedReach, kSimulatedReach, kSimulatedReach};
}

/// Half a kick, a drift, half a kick: a constant force is gone through exactly, and the hand's spring neither gains nor
/// loses; an order of less would shift the limit of stability by a tenth. Dampers are implicit; friction takes from the
/// speed what is there.
void SimulatedDevice::advance(double dt) noexcept {
  const Vec3d was = m_x;
  kick(0.5 * dt);
  m_x += dt * m_v;
  kick(0.5 * dt);
  m_work += dot(m_force, m_x - was);
}

void SimulatedDevice::kick(double dt) noexcept {
  const Settings& s = m_settings;
  const Vec3d pull = m_force + s.hand_stiffness * (m_hand - m_x);
  m_v = (m_v + (dt / s.mass) * pull) / (1 + dt * (s.hand_damping + s.own_damping) / s.mass);
  if (const double speed = length(m_v), loss = dt * s.own_friction / s.mass; loss > 0)
    m_v = speed > loss ? (1 - loss / speed) * m_v : Vec3d{};
}

bool SimulatedDevice::read(HapticSample& sample) noexcept {
  m_wanted.take(m_hand);
  for (int i = 0; i < m_settings.inner_steps; ++i) advance(m_settings.period / m_settings.inner_steps);
  const double r = m_settings.resolution;
  sample.position = {rounded(m_x.x, r), rounded(m_x.y, r), rounded(m_x.z, r)};
  sample.rotation = {};
  sample.grip = 0;
  sample.switches = 0;
  sample.number = ++m_number;
  return true;
}

}  // namespace trocar::devices
