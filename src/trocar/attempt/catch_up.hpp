// Hands and tools that went elsewhere while time stood still, or while nobody saw them: the instruments go after them
// slowly, as a tip that leaps goes through tissue.
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/core/tick.hpp>

namespace trocar::attempt {

inline constexpr double kCatchSpeed = 0.1;  ///< [m/s] along the shaft
inline constexpr double kCatchTurn = 1;     ///< [rad/s]
/// Between two ticks, or two poses of a tool: longer, and hands have gone elsewhere [ns].
inline constexpr std::int64_t kStoodStill = 200'000'000;

/// `from` goes to `to` by at most `most`; the way that is left.
inline double approach(float& from, float to, double most) {
  from += float(std::clamp(double(to) - double(from), -most, most));
  return double(std::abs(to - from));
}

/// The fulcrum's coordinates, for one tick. True: it is there.
template <class Pose>
bool approach(Pose& from, const Pose& to) {
  constexpr double kNearDepth = 0.001, kNearAngle = 0.01;  // [m] [rad] caught up
  const double turn = kCatchTurn * core::kTick;
  const double angle = std::max(
      {approach(from.yaw, to.yaw, turn), approach(from.pitch, to.pitch, turn), approach(from.roll, to.roll, turn)});
  return approach(from.depth, to.depth, kCatchSpeed * core::kTick) < kNearDepth && angle < kNearAngle;
}

}  // namespace trocar::attempt
