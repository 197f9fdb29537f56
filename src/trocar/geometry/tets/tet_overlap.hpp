// Cells that lie in each other without sharing a face: what a mesh's faces cannot tell (repair() finds cells on the
// same side of a face). Random or folded cells, two bodies pushed into one another, a part that is there twice.
#pragma once

#include <string>

#include <trocar/geometry/tets/tet_mesh.hpp>

namespace trocar::geometry {

/// Deeper than this share of the thinner one along every direction; less is the rounding of files. Our choice.
inline constexpr double kOverlapDepth = 0.01;
/// It stops looking at so many.
inline constexpr int kMostOverlaps = 1000;

struct CellOverlaps {
  int pairs = 0;  ///< at most kMostOverlaps
  Vec3d at{};     ///< between the middles of the first pair [m]
};
/// @param mesh  without flat cells, as repair() leaves it
CellOverlaps cell_overlaps(const TetMesh& mesh);

/// "12 pairs of cells lie in each other, the first at ... mm"
std::string in_words(const CellOverlaps& overlaps);

}  // namespace trocar::geometry
