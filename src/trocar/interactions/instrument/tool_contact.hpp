// An instrument touches tissue: shaft and jaws against organ skins and strands. The contact pushes the tissue away
// from the instrument, implicitly, so the force is the tissue's reaction and not a penalty; friction holds it
// (touch.hpp).
//
// Nothing tunnels, whatever the speed: contacts push as far in a tick as the instrument has moved and some more, and
// State remembers from which side it came. A strand's element has a side of each rod. A vertex of an organ's skin that
// finds itself behind the instrument's axis is pushed inwards along its own normal, down to 25 mm, if it or a neighbour
// was near the instrument in the last tick, or the axis was outside then; so the far side of a thin organ is left
// alone. Closed jaws, the spread ones of a dissector and a hook's wire, thinner than the skin's triangles, are
// also pressed against those.
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>
#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/interactions/instrument/touch.hpp>

namespace trocar::interactions {

/// May anything of the instrument be nearer to the box than `margin`? Its axis is asked, of a bent one each piece of
/// it.
bool comes_near(const ToolShape& shape, const tissue::Box& box, double margin) noexcept;

/// Of one body what jaws hold: vertices of its skin.
struct HeldVertices {
  std::array<std::int32_t, kMaxHolds> vertex{};
  std::size_t count = 0;

  HeldVertices() noexcept = default;
  HeldVertices(const Bodies& bodies, BodyId body, const ToolState& tool) noexcept;
  bool has(std::int32_t v) const noexcept {
    return std::find(vertex.begin(), vertex.begin() + count, v) != vertex.begin() + count;
  }
};

/// What jaws hold, and the skin next to that, lies around them in a fold and not before them: only the shaft touches
/// it, as with strands and folds.
/// @param held  what the jaws hold of it
void tool_on_surface(Touching& touching, BodyId body, const Surface& surface, NetworkLoads& loads,
                     const HeldVertices& held = {}) noexcept;

/// @param side  (elements x kToolParts, or kMostParts where instruments bend) State: on which side of each of this
///              tool's rods an element lies (collision::touch)
void tool_on_strand(const ToolModel& model, Touching& touching, const ToolState& tool_state, const StrandBody& body,
                    BodyId strand, const tissue::StrandState& state, std::span<Vec3f> side,
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
/// The same of anything straight with these ends.
BetweenJaws between_jaws(const ToolModel& model, const ToolShape& shape, Vec3d a, Vec3d b, double radius) noexcept;

/// How far a point `along` from the jaws' pivot is from the bend of the clip that lies between them [m].
double from_bend(const ToolModel& model, double along) noexcept;

/// Share of a tube of `radius` at `along` that lies between legs from 0 to `length`.
double leg_cover(double along, double radius, double length) noexcept;

}  // namespace trocar::interactions
