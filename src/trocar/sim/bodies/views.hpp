// What instruments look at, in a tick.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// [m] folds and organs further from an instrument than this are not looked at
inline constexpr double kNearSheet = 0.03;

}  // namespace trocar::sim
