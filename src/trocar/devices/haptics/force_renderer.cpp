#include <algorithm>
#include <cmath>

#include <trocar/devices/haptics/force_renderer.hpp>

namespace trocar::devices {
namespace {

constexpr double kUnlimited = 1e5;      // [N/m] where nothing is known of a device, or no limit is wanted
constexpr double kMargin = 0.8;         // of what would just be passive
constexpr double kSealStiffness = 800;  // [N/m] before a seal slides
constexpr double kSealShare = 0.4;      // of the stiffness, at most
constexpr double kNearPort = 1e-3;      // [m] within which a shaft has no direction

}  // namespace

ForceRenderer::ForceRenderer(const HapticCapabilities& device, const Settings& settings)
    : m_settings(settings),
      m_wanted(bounds_of(device)),
      m_now(m_wanted),
      m_passivity({.damping_max = m_now.damping}),
      m_guard({.force_max = m_now.force, .rate_max = settings.rate_max}) {}

ForceRenderer::Bounds ForceRenderer::bounds_of(const HapticCapabilities& device) const noexcept {
  return {m_settings.limit_stiffness ? kMargin * stiffest_passive(device, m_settings.period, 0) : kUnlimited,
          device.damping_max > 0 ? device.damping_max : PassivityControl::Limits{}.damping_max,
          device.force_max > 0 ? device.force_max : ForceGuard::Limits{}.force_max};
}

/// Down at once, up slowly.
void ForceRenderer::follow_bounds() noexcept {
  const double share = m_settings.period / kGrowth;
  const auto follow = [share](double& now, double wanted) { now = std::min(wanted, now + share * wanted); };
  follow(m_now.stiffness, m_wanted.stiffness);
  follow(m_now.damping, m_wanted.damping);
  follow(m_now.force, m_wanted.force);
  m_passivity.bound_damping(m_now.damping);
  m_guard.bound_force(m_now.force);
}

/// From the instrument's point to the god object, which sticks to the planes within the cone of friction.
Vec3d ForceRenderer::push(Vec3d p, const LocalModel& model, double stiffness) noexcept {
  const std::span<const ContactPlane> planes(model.plane, std::size_t(std::clamp(model.planes, 0, kMostPlanes)));
  const Vec3d x = nearest_allowed(p, planes), in = x - p;
  const double deep = length(in);
  if (!(deep > 0)) {
    m_touching = false;
    return {};
  }
  const Vec3d out = in / deep;
  Vec3d slip = m_touching ? m_proxy - x : Vec3d{};
  slip -= dot(slip, out) * out;
  const double far = length(slip), most = model.rubbing * deep;
  if (far > most) slip *= most / far;
  m_proxy = nearest_allowed(x + slip, planes);
  m_touching = true;
  const double toward = m_begun ? std::max(0.0, -dot(p - m_last, out)) / m_settings.period : 0;
  return stiffness * (m_proxy - p) + (model.damping * toward) * out;
}

/// Coulomb's friction along the shaft, as a short spring to an anchor that is dragged along [Cundall & Strack 1979].
Vec3d ForceRenderer::seal(Vec3d p, const LocalModel& model, double stiffness) noexcept {
  const Vec3d shaft = p - model.port;
  const double depth = length(shaft);
  if (!(model.seal_friction > 0) || depth < kNearPort || !(stiffness > 0)) {
    m_sealed = false;
    return {};
  }
  const double reach = model.seal_friction / stiffness;
  m_anchor = m_sealed ? std::clamp(m_anchor, depth - reach, depth + reach) : depth;
  m_sealed = true;
  return (stiffness * (m_anchor - depth) / depth) * shaft;
}

HapticForce ForceRenderer::force(const HapticSample& sample, const LocalModel& model, double silence) noexcept {
  follow_bounds();
  const double scale = model.frame.scale, stiffest = m_now.stiffness / (scale * scale);
  const Vec3d p = model.frame.to_space(sample.position);
  const double seal_stiffness = std::min(kSealStiffness, kSealShare * stiffest);
  const double left = model.seal_friction > 0 ? stiffest - seal_stiffness : stiffest;
  const double held = model.holds ? std::min(model.held_stiffness, 0.5 * left) : 0;
  Vec3d f = push(p, model, std::min(model.stiffness, left - held)) + held * (model.held_at - p);
  f += seal(p, model, seal_stiffness);
  m_last = p;
  m_begun = true;
  const Vec3d guarded = m_guard.guard(model.frame.force_on_device(f), silence, m_settings.period);
  if (!m_settings.passivity) return {guarded, {}, 0};
  return {m_passivity.control(sample.position, guarded, m_settings.period), {}, 0};
}

}  // namespace trocar::devices
