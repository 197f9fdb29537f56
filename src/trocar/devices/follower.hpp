// Smooth 1 kHz motion from commands that come at the display's rate: N values that follow their targets as a critically
// damped second-order system does, x'' = w^2 (target - x) - 2 w x', w = 1 / time_constant.
//
// Written as two equal first-order lags in a row, each stepped implicitly:
//   mid += k (target - mid),  x += k (x_target - x) with x_target = mid,  k = dt / (dt + time_constant)
// Both poles are real, equal and in (0, 1) for every dt, so that a step is approached without overshoot and nothing
// can become unstable; only + - * / are used. A ramp is followed with a lag of two time constants.
#pragma once

#include <array>
#include <cstddef>

namespace trocar::devices {

template <std::size_t N>
struct Follower {
  std::array<double, N> mid{}, x{};
};

/// The share of the way that one lag goes in one tick.  @param dt, time_constant [s], dt > 0, time_constant >= 0
constexpr double follower_gain(double dt, double time_constant) noexcept { return dt / (dt + time_constant); }

/// At rest at `at`.
template <std::size_t N>
constexpr Follower<N> resting(const std::array<double, N>& at) noexcept {
  return {at, at};
}

/// One tick; `gain` from follower_gain().
template <std::size_t N>
constexpr void follow(Follower<N>& state, const std::array<double, N>& target, double gain) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    state.mid[i] += gain * (target[i] - state.mid[i]);
    state.x[i] += gain * (state.mid[i] - state.x[i]);
  }
}

}  // namespace trocar::devices
