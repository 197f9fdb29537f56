// An instrument touches a thin sheet, from either side. Shaft and jaws are rods against the sheet's triangles; for
// every rod and triangle State remembers from which side they last were near each other, and the contact pushes the
// sheet back to there, as far in a tick as the rod has moved and some more. So nothing passes through it: a rod is
// remembered from 2 mm before it touches, and where it or the sheet moves further than that in a tick it is looked at
// in between. What lies between the jaws, a little of the fold or all of it, has a jaw on either side.
//
// A fold that a shaft has got through all the same (as where it is held) lets it go: nothing of the instrument touches
// it again before all of it is out. Contact that came back as the shaft's end is drawn into the hole would close the
// fold about its neck, and the fold would come along.
#pragma once

#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/sheet_view.hpp>
#include <trocar/interactions/instrument/touch.hpp>

namespace trocar::interactions {

/// What an instrument has to do with a sheet from one tick to the next.
enum class SheetBond : std::uint8_t {
  none,
  noted,   ///< something is remembered of a side
  through  ///< its shaft goes through the sheet, or has and is not out yet
};

/// @param body  how holds name this membrane
/// @param side  (triangles x kSheetParts, or kMostParts where instruments bend) State: unit vector from the rod to the
/// sheet when they last were near
/// @param bond  State: in: of the last tick, out: of this one
/// @param gap   out: no axis of the instrument is nearer to the sheet than this [m], or it may go where it likes
void tool_on_sheet(Touching& touching, const ToolState& tool_state, BodyId body, const SheetView& sheet,
                   std::span<Vec3f> side, SheetBond& bond, NetworkLoads& loads, double& gap) noexcept;

}  // namespace trocar::interactions
