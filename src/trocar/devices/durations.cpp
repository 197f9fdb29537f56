#include <algorithm>

#include <trocar/devices/durations.hpp>

namespace trocar::devices {

void Durations::add(double seconds) noexcept {
  const double at = std::clamp(seconds / m_width, 0.0, double(kBins - 1));
  std::atomic<std::uint32_t>& bin = m_bin[std::size_t(at)];
  bin.store(bin.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  m_count.store(m_count.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  if (seconds > longest()) m_longest.store(seconds, std::memory_order_relaxed);
}

double Durations::quantile(double share) const noexcept {
  const double wanted = share * double(count());
  double sum = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    sum += double(m_bin[i].load(std::memory_order_relaxed));
    if (sum >= wanted) return m_width * double(i + 1);
  }
  return m_width * double(kBins);
}

}  // namespace trocar::devices
