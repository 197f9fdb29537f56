// A patch in a surface that is made as fine as what is around it, and as smooth [Liepa 2003, Filling holes in meshes].
//
//   PatchWork patch(mesh, faces);             // faces of the EditableMesh that are the patch
//   patch.refine();
//   patch.fair(PatchShape::continued);        // as the surface around it continues
//
// Only the patch changes; the vertices of its border stay where they are.
#pragma once

#include <vector>

#include <trocar/geometry/remesh/editable.hpp>

namespace trocar::geometry {

enum class PatchShape : unsigned char {
  stretched,  ///< as a soap film: flat where the border is
  continued,  ///< as a thin plate: without a kink at the border
};

class PatchWork {
 public:
  /// @param faces  alive; the surface around them needs no more than to be there
  PatchWork(EditableMesh& mesh, std::vector<int> faces);

  /// Splits triangles until their edges are as long as those around the border, and flips edges to keep them well
  /// shaped.
  void refine();
  /// Moves the vertices within.
  void fair(PatchShape shape);
  const std::vector<int>& faces() const { return m_faces; }

 private:
  EditableMesh& m_mesh;
  std::vector<int> m_faces, m_inner;
  std::vector<bool> m_in_patch;    ///< of faces
  std::vector<double> m_fineness;  ///< (vertices) [m] how long edges are there; 0 away from the patch

  bool split_coarse();
  bool relax();
  double edge_length(int a, int b) const;
};

}  // namespace trocar::geometry
