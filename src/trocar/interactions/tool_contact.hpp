// An instrument touches tissue: shaft and jaws against organ skins and strands. The contact pushes the tissue away
// from the instrument, implicitly, so the force is the tissue's reaction and not a penalty.
//
// Nothing tunnels: hands are bounded to 0.6 m/s at the tip (0.6 mm a tick, less than any radius here); a skin vertex
// that finds itself behind the instrument's axis is still pushed inwards along its own normal, to a depth of 6 mm;
// closed jaws, thinner than the skin's triangles, are also pressed against those; a strand remembers (in State) on
// which side of each rod it lies, and stays there.
#pragma once

#include <span>

#include <trocar/interactions/loads.hpp>
#include <trocar/interactions/strand_body.hpp>
#include <trocar/interactions/surface.hpp>
#include <trocar/interactions/tool.hpp>

namespace trocar::interactions {

void tool_on_surface(const ToolShape& shape, int tool, const Surface& surface, NetworkLoads& loads) noexcept;

/// @param side  (elements x kToolParts) State: on which side of each of this tool's rods an element lies
///              (collision::touch)
void tool_on_strand(const ToolModel& model, const ToolShape& shape, const ToolState& tool_state, int tool,
                    const StrandBody& body, int strand, const tissue::StrandState& state, std::span<Vec3f> side,
                    StrandLoads& loads) noexcept;

/// How a strand element lies between the jaws.
struct BetweenJaws {
  bool inside = false;   ///< in the space between the jaws, or within the jaws' width beside their mid-plane
  bool crosses = false;  ///< it passes through the jaws' mid-plane: one that lies alongside the jaws does not
  double w = 0;          ///< place within the element nearest to the jaws' mid-plane
  Vec3d local;           ///< that point in the jaw frame
};
BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                         const tissue::StrandState& state, int element) noexcept;

}  // namespace trocar::interactions
