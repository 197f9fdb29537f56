// Halton's sequence: points that fill a cube evenly, the same ones every time [Halton 1960].
#pragma once

#include <array>
#include <cstdint>

namespace trocar::studies {

inline constexpr int kHaltonAxes = 100;

namespace halton_detail {
inline constexpr auto kPrimes = [] {
  std::array<int, kHaltonAxes> primes{};
  int count = 0;
  for (int n = 2; count < kHaltonAxes; ++n) {
    bool prime = true;
    for (int i = 0; i < count && prime; ++i) prime = n % primes[std::size_t(i)] != 0;
    if (prime) primes[std::size_t(count++)] = n;
  }
  return primes;
}();
}  // namespace halton_detail

/// @param index  from 1  @param axis  any; beyond kHaltonAxes they repeat
inline double halton(std::int64_t index, int axis) noexcept {
  const int base = halton_detail::kPrimes[std::size_t(axis % kHaltonAxes)];
  double value = 0, digit = 1;
  for (std::int64_t i = index; i > 0; i /= base) {
    digit /= base;
    value += digit * double(i % base);
  }
  return value;
}

}  // namespace trocar::studies
