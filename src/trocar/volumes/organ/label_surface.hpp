// An organ's label as a closed, smooth surface of triangles, by surface nets: a vertex for each cell of eight voxels
// that the border passes, a quad for each pair of neighbours on both sides of it. [Gibson 1998, Constrained elastic
// surface nets]
//
//   const LabelSurface liver = label_surface(labels, 5);
//   say(liver.ml_of_label, liver.ml);             // how much smoothing has changed
//   use(liver.mesh);                              // [m], in the frame of scenes
//
// What comes out is closed, faces outwards, and goes through itself nowhere (geometry/repair/examine.hpp), with the
// volume of the label's voxels.
#pragma once

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/volumes/image/labels.hpp>

namespace trocar::volumes {

struct SurfaceOptions {
  int smoothing = 12;      ///< passes; 0 leaves the steps of the voxels
  int most_triangles = 0;  ///< then simplified to so many; 0: as they are
  Progress progress = {};
};

struct LabelSurface {
  geometry::TriMesh mesh;        ///< [m], in the frame of scenes
  double ml_of_label = 0;        ///< of its voxels
  double ml = 0;                 ///< of the surface
  std::size_t added_voxels = 0;  ///< where voxels touched by an edge or corner alone: filled up
  int held_back = 0;     ///< vertices that were not smoothed, because the surface would have gone through itself
  bool is_body = false;  ///< closed, faces outwards, crosses itself nowhere
};
/// All parts of the label, however many. What the grid's border cuts is closed there.
/// @throws std::invalid_argument  where no voxel has the label
/// @throws Cancelled
LabelSurface label_surface(const Labels& labels, int label, const SurfaceOptions& options = {});

}  // namespace trocar::volumes
