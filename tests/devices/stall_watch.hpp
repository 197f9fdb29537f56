// What the machine lets threads wait beyond the time at which they asked to be woken. A measurement of the real time is
// worth something between two such stalls only.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include <pthread.h>

#include <trocar/devices/real_time.hpp>
#include <trocar/devices/steady_now.hpp>

namespace trocar::devices {

/// A real-time thread on every core that wakes up every half millisecond.
class StallWatch {
 public:
  /// @param stall  what a thread waits too long, to be told [ns]
  explicit StallWatch(std::int64_t stall) : m_stall(stall), m_told(std::max(1u, std::thread::hardware_concurrency())) {
    for (std::size_t core = 0; core < m_told.size(); ++core) m_threads.emplace_back([this, core] { watch(core); });
  }
  ~StallWatch() {
    m_stop = true;
    for (std::thread& t : m_threads) t.join();
  }
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

  /// Was there a stall in this time? [ns of the steady clock]
  bool between(std::int64_t from, std::int64_t to) const {
    const std::lock_guard lock(m_lock);
    return std::any_of(m_stalls.rbegin(), m_stalls.rend(), [&](const Stall& s) { return s.from < to && s.to > from; });
  }
  std::size_t count() const {
    const std::lock_guard lock(m_lock);
    return m_stalls.size();
  }
  /// Until when all cores have been seen.
  std::int64_t told_until() const noexcept {
    std::int64_t least = m_told[0];
    for (const auto& told : m_told) least = std::min<std::int64_t>(least, told);
    return least;
  }

 private:
  struct Stall {
    std::int64_t from, to;
  };

  void watch(std::size_t core) {
    constexpr std::int64_t kEvery = 500'000;  // [ns]
    cpu_set_t one;
    CPU_ZERO(&one);
    CPU_SET(core, &one);
    pthread_setaffinity_np(pthread_self(), sizeof one, &one);
    raise_priority();
    for (std::int64_t due = steady_now() + kEvery; !m_stop; due = m_told[core] + kEvery) {
      std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(due)));
      const std::int64_t now = steady_now();
      if (now - due > m_stall) {
        const std::lock_guard lock(m_lock);
        m_stalls.push_back({due, now});
      }
      m_told[core] = now;
    }
  }

  std::int64_t m_stall;
  mutable std::mutex m_lock;
  std::vector<Stall> m_stalls;
  std::atomic<bool> m_stop{false};
  std::vector<std::atomic<std::int64_t>> m_told;
  std::vector<std::thread> m_threads;  // last: start when all else is there
};

}  // namespace trocar::devices
