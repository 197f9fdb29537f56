// The drawn skin of a body of tetrahedra: the faces that no other cell lies behind, each as a few small triangles that
// bend smoothly where the body's own surface does, and flat ones where a cut has laid its inside bare.
//
//   const FaceSkin skin = face_skin(tets, uncut.across, row_of_node, 3);    // 9 triangles a face
//   pose_skin(view_of(model, state), skin.skin, pose);
//
// Every vertex rides on the four corners of a cell (x = W q, weights may be slightly negative): the surface is as
// smooth in the drawn shape in any affine motion of the cell. Edges between own and bare faces stay sharp, with
// vertices on both sides. Curving: a point between corners moves towards their tangent planes [Boubekeur & Alexa 2008].
#pragma once

#include <span>

#include <trocar/geometry/tets/tet_cut.hpp>
#include <trocar/tissue/network/skin.hpp>

namespace trocar::tissue {

struct FaceSkin {
  Skin skin;
  std::vector<std::uint8_t> bare;             ///< (vertices) 1: on a face that a cut has laid bare
  std::vector<std::array<int, 3>> corners;    ///< (vertices) nodes between which it lies ...
  std::vector<std::array<float, 3>> between;  ///< ... and how much of each
};

inline constexpr int kDrawnParts = 3;  ///< of a face's edge, in every scene

/// @param uncut  neighbours of the cells before any cut, as CuttableTets::across; faces that had none are the body's
/// own
/// @param parts  of an edge, 1 to 8: a face gives parts^2 triangles
FaceSkin face_skin(const geometry::CuttableTets& tets, std::span<const geometry::Tet> uncut,
                   std::span<const int> row_of_node, int parts);

}  // namespace trocar::tissue
