// Holes are closed: rims of walls by a ring between them (rim_bridge.hpp), others by a patch (rim_patch.hpp) that is as
// fine as what is around it. Small ones continue as the surface does; where a tube ends, or a lid is large, it is
// stretched like a soap film (remesh/patch_work.hpp).
//
//   const Repaired closed = with_holes_closed(mesh);
//   for (const std::string& words : closed.left) ...     // "a sheet of 12 cm2 is left open"
//
// A sheet has no inside to close: where lids would be a large part of a shell's area, it is left as it is and told.
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

struct HoleOptions {
  bool rings = true;    ///< between rims of a wall; otherwise lids on both
  bool smooth = true;   ///< small patches continue as the surface does; otherwise all are stretched
  bool refine = true;   ///< patches are as fine as what is around; otherwise they have no vertices of their own
  bool sheets = false;  ///< close those, too
};
/// Lids that are more than this share of a shell's area close a sheet; half a ball has one of 0.5.
inline constexpr double kSheetLids = 0.7;
/// Corners of a rim that is closed.
inline constexpr std::size_t kLongestRim = 20'000;

/// @param mesh  parted and oriented: each vertex has one fan of triangles
Repaired with_holes_closed(const TriMesh& mesh, const HoleOptions& options = {});

}  // namespace trocar::geometry
