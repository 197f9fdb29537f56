// The steady clock in nanoseconds, by which what comes from devices is stamped.
#pragma once

#include <chrono>
#include <cstdint>

namespace trocar::devices {

inline std::int64_t steady_now() noexcept {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace trocar::devices
