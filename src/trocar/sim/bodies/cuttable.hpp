// Operations of organs of tetrahedra, which can be cut anywhere (tissue/tets/cuttable.hpp).
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/bodies/touching.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Its skin and surface as they are, and what follows from its cuts.
void pose(StepContext& context, CuttableRef organ) noexcept;
/// The skin alone: blades have moved its nodes.
void pose_again(StepContext& context, CuttableRef organ) noexcept;
/// Loads start afresh, with the springs that hang it in space.
void hang(StepContext& context, CuttableRef organ) noexcept;
/// An instrument at it.
void touch(StepContext& context, CuttableRef organ, HandContact& hand) noexcept;
/// Pieces on each other, lips on lips.
void touch_itself(StepContext& context, CuttableRef organ) noexcept;
/// (vertices) Which piece of it each belongs to; empty where it hangs together.
std::span<const std::int32_t> pieces_of(const StepContext& context, CuttableRef organ) noexcept;
/// Rows of its nodes at cells that are folded.
std::span<const std::uint8_t> folded_of(StepContext& context, CuttableRef organ) noexcept;
/// Explicit, in its own sub-steps.
void advance(StepContext& context, CuttableRef organ) noexcept;
void clamp_to_cavity(StepContext& context, CuttableRef organ) noexcept;

/// Half the length of the cut that a wire makes [m].
double wire_cut(const Model& model, CuttableRef organ) noexcept;
/// Cells part at the faces that lie on the blade; nodes near it snap to it.
Parting cut(StepContext& context, CuttableRef organ, const geometry::Blade& blade) noexcept;
bool can_tear(const Model& model, CuttableRef organ) noexcept;
/// Where it is stretched beyond what it bears.
Parting tear(StepContext& context, CuttableRef organ) noexcept;

/// How it came through the tick, and whether its loads found room.
tissue::StepReport report_of(const StepContext& context, CuttableRef organ) noexcept;
bool overloaded(const StepContext& context, CuttableRef organ) noexcept;

}  // namespace trocar::sim
