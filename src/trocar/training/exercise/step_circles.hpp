// Steps that wait for each other, by whatever way: none of them can ever be done.
#pragma once

#include <vector>

#include <trocar/training/exercise/rules.hpp>

namespace trocar::training {

/// A circle of steps: each waits for the next, the last for the first. Empty: there is none.
std::vector<int> circle_of(const std::vector<StepRule>& steps);

}  // namespace trocar::training
