// Where breathing has carried what holds bodies in space, in a tick (the model of it: sim/model/motion.hpp).
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// How far a breath has carried what it carries wholly, when `ticks` have been made [m].
Vec3d breath_after(const BreathingModel& breathing, std::uint64_t ticks) noexcept;

/// How far what holds something has gone when this tick ends [m], how fast it goes in it [m/s].
struct Carried {
  Vec3d x{0, 0, 0}, v{0, 0, 0};
  bool moves = false;
};
Carried carried(const StepContext& c, SolidRef solid) noexcept;
Carried carried(const StepContext& c, CuttableRef organ) noexcept;
Carried carried(const StepContext& c, StrandRef strand) noexcept;
Carried carried(const StepContext& c, MembraneRef membrane) noexcept;

/// Held nodes set out for where they are held when this tick ends; the step of the body takes them there.
void carry_held_nodes(StepContext& c, SolidRef solid) noexcept;
void carry_held_nodes(StepContext& c, CuttableRef organ) noexcept;
/// They are there, without the rounding of the way.
void settle_held_nodes(StepContext& c, SolidRef solid) noexcept;
void settle_held_nodes(StepContext& c, CuttableRef organ) noexcept;

}  // namespace trocar::sim
