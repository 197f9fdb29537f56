// Bodies take turns to be looked at for tears, so that no tick looks at all of them; and what a look has found.
#pragma once

#include <algorithm>
#include <vector>

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

inline std::uint64_t turn_of(const StepContext& c, size_t body) noexcept { return c.state.tick + 7 * body; }

/// What could not open is not tried again before its time has come once more.
inline Parting opened(Parting parting, std::vector<std::uint8_t>& counters) noexcept {
  if (!parting.parted) std::fill(counters.begin(), counters.end(), std::uint8_t(0));
  return parting;
}

}  // namespace trocar::sim
