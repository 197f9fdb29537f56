// Operations of lattices: organs of springs that no blade is meant for (tissue/network/network.hpp).
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/bodies/touching.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Its skin and surface as they are.
void pose(StepContext& context, SolidRef solid) noexcept;
/// Loads start afresh, with the springs that hang it in space.
void hang(StepContext& context, SolidRef solid) noexcept;
/// An instrument at it.
void touch(StepContext& context, SolidRef solid, HandContact& hand) noexcept;
/// (vertices) Which piece of it each belongs to; empty where it hangs together.
std::span<const std::int32_t> pieces_of(const StepContext& context, SolidRef solid) noexcept;
/// Rows of its nodes at cells that are folded.
std::span<const std::uint8_t> folded_of(StepContext& context, SolidRef solid) noexcept;
/// Explicit, in its own sub-steps.
void advance(StepContext& context, SolidRef solid) noexcept;
void clamp_to_cavity(StepContext& context, SolidRef solid) noexcept;

/// Half the length of the cut that a wire makes [m].
double wire_cut(const Model& model, SolidRef solid) noexcept;
/// Springs that cross the blade are severed.
Parting cut(StepContext& context, SolidRef solid, const geometry::Blade& blade) noexcept;
bool can_tear(const Model& model, SolidRef solid) noexcept;
/// Where it is stretched beyond what it bears.
Parting tear(StepContext& context, SolidRef solid) noexcept;

/// How it came through the tick, and whether its loads found room.
tissue::StepReport report_of(const StepContext& context, SolidRef solid) noexcept;
bool overloaded(const StepContext& context, SolidRef solid) noexcept;

}  // namespace trocar::sim
