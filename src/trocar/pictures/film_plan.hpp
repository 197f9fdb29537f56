// Which moments of a recording a film shows: pictures at a fixed rate from one tick to another, at any speed.
//
//   const FilmPlan plan{from, to, 0.25};                  // four times as long as it took
//   for (std::uint64_t k = 0; k < plan.pictures(); ++k) video.add(draw(state_at(plan.tick(k))));
#pragma once

#include <cstdint>

#include <trocar/core/tick.hpp>
#include <trocar/pictures/video.hpp>

namespace trocar::pictures {

inline constexpr double kSlowest = 0.02, kFastest = 8;  ///< simulated time per time of the film

struct FilmPlan {
  std::uint64_t from = 0, to = 0;  ///< ticks, from <= to
  double speed = 1;                ///< kSlowest .. kFastest

  double ticks_per_picture() const { return double(core::kTicksPerSecond) / kVideoRate * speed; }
  double seconds() const { return double(to - from) * core::kTick / speed; }  ///< of the film
  /// At least one; together they last seconds() to within one picture.
  std::uint64_t pictures() const {
    const auto whole = std::uint64_t(seconds() * kVideoRate + 0.5);
    return whole > 0 ? whole : 1;
  }
  std::uint64_t tick(std::uint64_t picture) const {
    const std::uint64_t t = from + std::uint64_t(double(picture) * ticks_per_picture() + 0.5);
    return t < to ? t : to;
  }
};

}  // namespace trocar::pictures
