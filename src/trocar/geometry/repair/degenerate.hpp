// Triangles without area go, and leave no hole: needles by their short edge, which collapses, flat ones by their long
// edge, which is flipped.
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

/// @param mesh    where edges have more than two triangles, what is degenerate there stays; see parted()
/// @param height  [m] lower ones go, too; the surface moves by about as much at most
Repaired without_degenerate(const TriMesh& mesh, double height = 0);

}  // namespace trocar::geometry
