// A surface with fewer triangles that stays near to what it was: edges collapse, those first that cost least, each into
// the place that fits the planes of all triangles it stands for. [Garland & Heckbert 1997]
//
//   const Simplified small = simplified(mesh, 2000);
//   if (small.mesh.triangles.size() > 2000) ...            // no edge could go without a fold
//
// It stays the manifold that it was, with as many holes; borders keep their line as well as the rest its planes. For
// levels of detail over the same vertices there is surfaces/coarsen.hpp.
#pragma once

#include <limits>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {

struct SimplifyOptions {
  double most_error = std::numeric_limits<double>::infinity();  ///< [m] root mean square from the planes of a vertex
};
struct Simplified {
  TriMesh mesh;
  double error = 0;                      ///< [m] of the dearest edge that went
  double volume_before = 0, volume = 0;  ///< [m^3]
};
/// @param triangles  as many at most, if it can be done
Simplified simplified(const TriMesh& mesh, int triangles, const SimplifyOptions& options = {});

}  // namespace trocar::geometry
