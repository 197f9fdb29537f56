// How near the current step of an exercise is to being done: its condition's rows, and how long it still has to hold.
#pragma once

#include <trocar/training/exercise/rules.hpp>
#include <trocar/training/rules/nearness.hpp>

namespace trocar::training {

inline constexpr std::size_t kMostRows = 5;  ///< what a trainee can take in beside the picture (our choice)

/// Where the rules are ticked. Of an act the condition that must hold meanwhile. None beyond the last step.
std::vector<Nearness> nearness_of(const Rules& rules, int step, const Snapshot& snapshot);

}  // namespace trocar::training
