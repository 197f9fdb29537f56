#include <trocar/sim/model/vessel_cuts.hpp>

namespace trocar::sim {

std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept {
  size_t n = 0;
  for (int i = 0; i < state.opening_count; ++i) {
    const interactions::VesselOpening& o = state.openings[size_t(i)];
    if (o.vessel == vessel && o.through) out[n++] = o.s;
  }
  return {out.data(), n};
}

}  // namespace trocar::sim
