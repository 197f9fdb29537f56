// Where vessels are cut through.
#pragma once

#include <span>

#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Places of a vessel that are cut through. @param out  at least kMaxOpenings
std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept;

}  // namespace trocar::sim
