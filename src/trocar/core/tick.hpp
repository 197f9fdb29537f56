// The one length of a tick, from which all that counts in ticks follows.
#pragma once

#include <cstdint>

namespace trocar::core {

inline constexpr std::uint64_t kTicksPerSecond = 1000;
inline constexpr double kTick = 1e-3;  ///< [s]

}  // namespace trocar::core
