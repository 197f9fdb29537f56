// A surface that passes through itself becomes the boundary of what it encloses: triangles are cut along the lines in
// which they cross, and of the pieces those stay that have inside on one side and outside on the other. Parts that
// overlap become one body, folds lose what they fold in; all else stays as it is, to the bit.
//
//   const Repaired one = resolved(mesh);        // one.left, and the mesh as it was, where it could not be done
//
// Inside is what the surface goes around at least once, as volumes/field.hpp has it; walls of cavities, which face
// inwards, take away from that. Surfaces that only touch, or lie in each other, are moved by a hundred-millionth of the
// mesh's size first, or by more if need be, up to a millionth.
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

/// @param mesh  closed, each edge with two triangles that agree. What comes out is closed and crosses itself nowhere,
///              or is the same mesh.
Repaired resolved(const TriMesh& mesh);

}  // namespace trocar::geometry
