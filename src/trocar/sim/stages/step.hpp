// One tick of the whole simulation, as a list of named stages (docs/developers/computation.md says what each does and
// costs).
#pragma once

#include <span>

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// Advances by one tick (1 ms). No exception, no allocation, no lock, no clock, no I/O; the same bits everywhere.
StepReport step(const Model& model, const Input& input, State& state, Work& work) noexcept;

/// The stages that step() runs, in order; benchmarks time them one by one.
struct Stage {
  const char* name;
  void (*run)(StepContext&) noexcept;
};
std::span<const Stage> stages() noexcept;

}  // namespace trocar::sim
