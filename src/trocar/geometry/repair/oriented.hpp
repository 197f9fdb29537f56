// All triangles of a shell face the same way, and shells face outwards.
//
//   const Repaired good = oriented(mesh);
//
// Closed shells that were consistent before and face inwards inside of another one are walls of cavities, and stay so.
// Open ones that were consistent stay as they are: which side is which is seen once they are closed. Others are judged
// as if their holes were closed by fans; sheets, which enclose next to nothing, face as most of their area did.
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

/// @param mesh  edges with more than two triangles part shells here: see parted()
/// A shell with one side only (a Moebius strip) is parted along some edges, where it then has borders.
Repaired oriented(const TriMesh& mesh);

}  // namespace trocar::geometry
