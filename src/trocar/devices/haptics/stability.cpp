#include <algorithm>
#include <cmath>

#include <trocar/devices/haptics/stability.hpp>

namespace trocar::devices {
namespace {

constexpr double kAtRest = 1e-12;    // [(m/s)^2] below which no damper takes anything away
constexpr double kFarthestHand = 1;  // [m]

}  // namespace

double stiffest_passive(const HapticCapabilities& device, double period, double damping) noexcept {
  // [Colgate & Schenkel 1994]  b > K T / 2 + |B|
  double stiffness = std::max(0.0, 2 * (device.own_damping - std::fabs(damping)) / period);
  // [Abbott & Okamura 2005]  K <= min(2 b / T, 2 f_c / resolution)
  if (device.own_friction > 0 && device.resolution > 0)
    stiffness = std::min(stiffness, 2 * device.own_friction / device.resolution);
  return device.stiffness_max > 0 ? std::min(stiffness, device.stiffness_max) : stiffness;
}

// [Hannaford & Ryu 2002]
Vec3d PassivityControl::control(Vec3d position, Vec3d force, double period) noexcept {
  if (!m_begun) m_position = position;
  m_begun = true;
  const Vec3d way = position - m_position, velocity = way / period;
  m_energy = std::clamp(m_energy - dot(m_force, way), -m_limits.energy_max, m_limits.energy_max);
  m_damping = 0;
  const double v2 = dot(velocity, velocity);
  if (m_energy < 0 && v2 > kAtRest) m_damping = std::min(-m_energy / (period * v2), m_limits.damping_max);
  m_force = force - m_damping * velocity;
  m_position = position;
  return m_force;
}

Vec3d ForceGuard::guard(Vec3d force, double silence, double period) noexcept {
  const double way = period / m_limits.fade;
  m_share = std::clamp(m_share + (silence > m_limits.patience ? -way : way), 0.0, 1.0);
  Vec3d out = finite(force) ? m_share * force : Vec3d{};
  if (const double size = length(out); size > m_limits.force_max) out *= m_limits.force_max / size;
  // Up slowly, down at once: a force that ends must end. Turned round, it starts from nothing.
  const Vec3d rise = out - m_last;
  const double most = m_limits.rate_max * period, step = length(rise);
  if (step > most && dot(out, out) > dot(m_last, m_last)) out = m_last + (most / step) * rise;
  m_last = out;
  return out;
}

bool plausible(const HapticSample& s) noexcept {
  const double turn = dot(s.rotation, s.rotation);
  return finite(s.position) && dot(s.position, s.position) < kFarthestHand * kFarthestHand && turn > 0.9 &&
         turn < 1.1 && s.grip >= 0 && s.grip <= 1;
}

}  // namespace trocar::devices
