// Straight ways from ports into the body, and which organs they go through.
#pragma once

#include <string>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::studies {

/// A closed surface in the way.
struct InTheWay {
  std::string name;
  geometry::TriMesh mesh;  ///< as the patient lies [m]
};

/// How much of the way from a to b is inside a closed surface [m]. What surrounds b itself does not count from where it
/// is entered last: it is what is worked in.
double way_through(const geometry::TriMesh& mesh, Vec3d a, Vec3d b);

/// Of ways from one place to several.
struct WaysIn {
  double blocked = 0;  ///< share of them that go through something for 3 mm or more
  std::string first;   ///< what most of these go through; empty: none does
  double longest = 0;  ///< of a way inside that [m]
};
WaysIn ways_in(const std::vector<InTheWay>& organs, Vec3d from, const std::vector<Vec3d>& to);

}  // namespace trocar::studies
