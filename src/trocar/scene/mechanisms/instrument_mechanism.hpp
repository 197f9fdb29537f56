// Mechanisms inside instruments, made into what the step computes with: a table of the jaws' ways for a linkage, a
// chain of hinges for what bends.
#pragma once

#include <vector>

#include <trocar/interactions/instrument/tool.hpp>
#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

/// Closes the linkage's loop all along its handle's way. Jaws turn between the frames "tip_upper" and "tip_lower", or
/// shift apart where the instrument's are parallel; leverage follows from their ways by virtual work. Sets the tool's
/// linkage and opening, where the jaws do not go as the handle does anyway, and what of it is drawn. What does not
/// close, or does not close the jaws all the way and one way, is a fault.
void take_linkage(const Instrument& instrument, interactions::ToolModel& tool, std::vector<core::Fault>& faults);

/// Sets what of the tool bends: a wrist of two hinges, or the chain of a mechanism from its link "shaft" to its frame
/// "tip", whose hinges turn about the shaft's x or y and follow each other along its axis.
void take_wrist(const Instrument& instrument, interactions::ToolModel& tool, std::vector<core::Fault>& faults);

}  // namespace trocar::scene
