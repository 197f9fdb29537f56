// Operations of membranes: folds, and the walls of pouches (tissue/membrane/membrane.hpp).
#pragma once

#include <trocar/sim/bodies/parting.hpp>
#include <trocar/sim/bodies/touching.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Its skin and both sides as they are.
void pose(StepContext& context, MembraneRef membrane) noexcept;
/// Loads start afresh.
void hang(StepContext& context, MembraneRef membrane) noexcept;
/// An instrument at it. Far from one that it was not near before there is nothing to do, and nothing to forget.
void touch(StepContext& context, MembraneRef membrane, HandContact& hand) noexcept;
/// How it pulls on what carries its borders ...
void find_pulls(StepContext& context, MembraneRef membrane) noexcept;
/// ... and the loads of that.
void pull_on_holders(StepContext& context, MembraneRef membrane) noexcept;
/// Borders go where their holders have gone.
void advance(StepContext& context, MembraneRef membrane) noexcept;
void clamp_to_cavity(StepContext& context, MembraneRef membrane) noexcept;

/// Half the length of the cut that a wire makes [m].
double wire_cut(const Model& model, MembraneRef membrane) noexcept;
/// Springs that cross the blade are severed.
Parting cut(StepContext& context, MembraneRef membrane, const geometry::Blade& blade) noexcept;
bool can_tear(const Model& model, MembraneRef membrane) noexcept;
/// Where it is stretched beyond what it bears.
Parting tear(StepContext& context, MembraneRef membrane) noexcept;

/// How it came through the tick, and whether its loads found room.
tissue::StepReport report_of(const StepContext& context, MembraneRef membrane) noexcept;
bool overloaded(const StepContext& context, MembraneRef membrane) noexcept;

}  // namespace trocar::sim
