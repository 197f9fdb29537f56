// Seeded random numbers that are the same everywhere (splitmix64; no std:: distributions, which differ by library).
#pragma once

#include <cstdint>

namespace trocar::core {

class Random {
 public:
  explicit Random(std::uint64_t seed) noexcept : m_state(seed) {}
  std::uint64_t next() noexcept {
    std::uint64_t z = (m_state += 0x9e3779b97f4a7c15ull);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
  }
  /// Uniform in [0, 1), 53 bits.
  double uniform() noexcept { return double(next() >> 11) * 0x1p-53; }
  double uniform(double low, double high) noexcept { return low + (high - low) * uniform(); }
  std::uint64_t state() const noexcept { return m_state; }

 private:
  std::uint64_t m_state;
};

}  // namespace trocar::core
