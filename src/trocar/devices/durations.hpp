// How long something took, counted in bins of equal width.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace trocar::devices {

/// One thread adds; others may read meanwhile.
class Durations {
 public:
  /// @param bin  width [s]; there are ten thousand, the last has all that is longer
  explicit Durations(double bin = 1e-6) noexcept : m_width(bin) {}

  void add(double seconds) noexcept;
  std::uint64_t count() const noexcept { return m_count.load(std::memory_order_relaxed); }
  /// The smallest time that so large a share took no longer than, to the bin above; at least the range where it lies
  /// beyond. @param share 0..1 [s]
  double quantile(double share) const noexcept;
  double longest() const noexcept { return m_longest.load(std::memory_order_relaxed); }  ///< [s]

 private:
  static constexpr std::size_t kBins = 10'000;
  double m_width;
  std::array<std::atomic<std::uint32_t>, kBins> m_bin{};
  std::atomic<std::uint64_t> m_count{0};
  std::atomic<double> m_longest{0};
};

}  // namespace trocar::devices
