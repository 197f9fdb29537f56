// A line on stderr every few seconds of wall time, for loops that simulate without a window.
#pragma once

#include <chrono>
#include <cstdint>

namespace trocar::attempt {

class Progress {
 public:
  /// @param first  tick from which on it is simulated
  /// @param last   where that ends; 0: not known
  explicit Progress(std::uint64_t first, std::uint64_t last = 0) : m_first(first), m_last(last) {}

  /// After every tick.
  void at(std::uint64_t tick);

 private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t m_first, m_last;
  Clock::time_point m_start = Clock::now(), m_told = m_start;
};

}  // namespace trocar::attempt
