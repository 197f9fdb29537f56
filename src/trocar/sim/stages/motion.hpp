// What moves by itself, in a tick (the model of it: sim/model/motion.hpp): where breathing has carried what holds
// bodies in space, and the stage in which muscles of hollow organs contract.
#pragma once

#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// How far a breath has carried what it carries wholly, when `ticks` have been made [m].
Vec3d breath_after(const BreathingModel& breathing, std::uint64_t ticks) noexcept;

/// How far what holds something has gone when this tick ends [m], how fast it goes in it [m/s].
struct Carried {
  Vec3d x{0, 0, 0}, v{0, 0, 0};
  bool moves = false;
};
Carried carried_organ(const StepContext& c, std::size_t organ) noexcept;
Carried carried_strand(const StepContext& c, std::size_t strand) noexcept;
Carried carried_membrane(const StepContext& c, std::size_t membrane) noexcept;

/// Held nodes set out for where they are held when this tick ends; the step of the body takes them there.
void carry_held_nodes(StepContext& c, std::size_t organ) noexcept;
/// They are there, without the rounding of the way.
void settle_held_nodes(StepContext& c, std::size_t organ) noexcept;

/// Stage: muscles of hollow organs contract.
void contract(StepContext& c) noexcept;

}  // namespace trocar::sim
