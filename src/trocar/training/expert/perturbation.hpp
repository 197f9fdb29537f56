// The success of a hand's work depends on tenths of a millimetre that no plan foresees. So a demonstration has moments
// of choice, where a skill begins and every ten seconds while it lasts: from there on it can be done as it is written,
// or by a hand that trembles otherwise, draws somewhat further, holds deeper, carries to beside. It is rehearsed
// (attempt/rehearsal/rehearsal.hpp), and its exercise's file keeps the choices that went well, as numbers.
#pragma once

#include <trocar/training/expert/plan.hpp>
#include <trocar/training/surgeon/arms.hpp>

namespace trocar::training {

inline constexpr double kChoiceEvery = 10;  ///< while a skill lasts [s]

/// The task as it is done in that way: where to, how far, how deep and how hard change, never what is done, and nothing
/// that the exercise judges by. Drawn from the way's number.
/// @param perturbation  0: as it is written
PlanTask perturbed(const PlanTask& task, int perturbation);
/// Of hands in that way. 0: none.
Tremor perturbed_tremor(int perturbation);

}  // namespace trocar::training
