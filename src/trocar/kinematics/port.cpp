#include <algorithm>
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/port.hpp>

namespace trocar::kinematics {
namespace {

constexpr double kLeg = 20;       // [s] from one place to the next
constexpr double kYields = 0.05;  // [s]

/// Number k of the places it wanders to; it begins in its own.
Vec3d place_of_leg(const PortModel& m, std::uint64_t k) noexcept {
  if (k == 0) return {0, 0, 0};
  core::Random random(m.seed + k * 0x9e3779b97f4a7c15ull);
  const double r = m.drift * std::sqrt(random.uniform()), angle = portable::two_pi * random.uniform();
  return r * (portable::cos(angle) * m.across[0] + portable::sin(angle) * m.across[1]);
}

}  // namespace

Vec3d drift_of(const PortModel& m, double seconds) noexcept {
  if (!(m.drift > 0) || !(seconds > 0)) return {0, 0, 0};
  const auto leg = std::uint64_t(seconds / kLeg);
  const double s = seconds / kLeg - double(leg), share = s * s * s * (10 + s * (6 * s - 15));
  const Vec3d from = place_of_leg(m, leg);
  return from + share * (place_of_leg(m, leg + 1) - from);
}

FulcrumPose about_shifted(const FulcrumPose& pose, Vec3d shift, double outside) noexcept {
  const Vec3d from_handle = shift + outside * forward({}, pose).axis();
  const double now_outside = length(from_handle);
  if (!(now_outside > 0)) return pose;
  const double depth = std::max(0.0, pose.depth + outside - now_outside);
  FulcrumPose shifted = inverse({}, from_handle, pose.roll);
  shifted.depth = depth;
  return shifted;
}

PortState moved(const PortModel& m, const PortState& state, Vec3d on_wall, const FulcrumPose& pose, double outside,
                double seconds, double dt) noexcept {
  PortState next = state;
  if (m.stiffness > 0) {
    const double magnifies = 0.5 * (1 + pose.depth / std::max(outside, kLeastOutside));
    const double time = kYields * std::max(1.0, magnifies * magnifies);
    Vec3d goal = on_wall / m.stiffness;
    const double far = length(goal);
    if (!std::isfinite(far)) goal = {0, 0, 0};
    if (far > kMostGive) goal = (kMostGive / far) * goal;
    next.give += std::min(1.0, dt / (time + dt)) * (goal - state.give);
  }
  next.shift = next.give + drift_of(m, seconds);
  return next;
}

}  // namespace trocar::kinematics
