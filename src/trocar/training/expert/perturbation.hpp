// The success of a hand's work depends on tenths of a millimetre that no plan foresees. So a demonstration has decision
// points, where a skill begins and every ten seconds while it lasts: from there on it can be performed as it is
// written, or with a perturbation: the hand trembles otherwise, draws somewhat further, grasps deeper, puts down beside
// the place. A rehearsal (attempt/rehearsal/rehearsal.hpp) finds choices that succeed; the exercise's file keeps them
// as numbers.
#pragma once

#include <trocar/training/expert/plan.hpp>
#include <trocar/training/surgeon/arms.hpp>

namespace trocar::training {

inline constexpr double kChoiceEvery = 10;  ///< while a skill lasts [s]

/// The task with that perturbation: where to, how far, how deep and how hard change, never what is done, and nothing
/// that the exercise judges by. Drawn from the perturbation's number.
/// @param perturbation  0: the task as it is written
PlanTask perturbed(const PlanTask& task, int perturbation);
/// The tremor of the hands with that perturbation. 0: none.
Tremor perturbed_tremor(int perturbation);

}  // namespace trocar::training
