// Which drawing each kind of instrument has: a function a kind, in a file of its own.
#pragma once

#include <iterator>

#include <trocar/view/instruments/instrument_shapes.hpp>

namespace trocar::view {

using PartsOfKind = std::vector<InstrumentPart>(const interactions::ToolModel& tool);
PartsOfKind grasper_parts, clip_applier_parts, scissors_parts, probe_parts, suction_irrigator_parts, hook_parts,
    bipolar_parts, dissector_parts, bag_parts, injection_needle_parts, endoloop_parts;

struct KindShape {
  interactions::ToolKind kind;
  PartsOfKind* parts;
};
inline constexpr KindShape kKindShapes[] = {
    {interactions::ToolKind::grasper, grasper_parts},
    {interactions::ToolKind::clip_applier, clip_applier_parts},
    {interactions::ToolKind::scissors, scissors_parts},
    {interactions::ToolKind::probe, probe_parts},
    {interactions::ToolKind::suction_irrigator, suction_irrigator_parts},
    {interactions::ToolKind::hook, hook_parts},
    {interactions::ToolKind::bipolar, bipolar_parts},
    {interactions::ToolKind::dissector, dissector_parts},
    {interactions::ToolKind::bag, bag_parts},
    {interactions::ToolKind::injection_needle, injection_needle_parts},
    {interactions::ToolKind::endoloop, endoloop_parts},
};
static_assert(std::size(kKindShapes) == std::size(interactions::kToolKinds), "a kind has no drawing");

}  // namespace trocar::view
