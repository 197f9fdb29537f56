// How often conditions, and facts that remember, look at the simulation.
#pragma once

#include <trocar/core/tick.hpp>

namespace trocar::training {

inline constexpr int kSampleEvery = 20;                        ///< ticks: 50 Hz
inline constexpr double kSample = kSampleEvery * core::kTick;  ///< [s]

}  // namespace trocar::training
