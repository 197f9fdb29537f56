// A line on stderr every few seconds of wall time, for what takes long without a window: loops that simulate, and
// static solvers of organs while they are made.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

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

/// For scene::CompileReport::said.
std::function<void(const std::string& organ, double share)> told_of_solvers();

}  // namespace trocar::attempt
