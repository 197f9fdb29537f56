// The skin of a body that can be cut: the faces that no other cell lies behind, as they are now. Its vertices are the
// body's nodes, under their numbers, so that a hold on a vertex is a hold on the same one after a cut; nodes inside the
// body are vertices without triangles until a cut lays them bare.
//
//   CuttableSkin skin = make_skin(model);             // room for all that cuts can add
//   update(model, state, skin);                       // after a cut; nothing to do otherwise
//   pose_skin(view_of(model, state), skin.skin, pose);
//
// Like the arrays of the kernel it follows from the State alone: it is scratch.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/skin.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::tissue {

/// Corners of the face opposite to each corner of an upright cell, counter-clockwise seen from outside.
inline constexpr int kFaceCorners[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

struct CuttableSkin {
  Skin skin;
  std::vector<std::uint8_t> inner;  ///< (triangles) 1: laid bare by a cut
  std::uint64_t made_for = ~0ull;   ///< CuttableState::version

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("skin", s.skin), v("inner", s.inner), v("made_for", s.made_for);
  }
};

CuttableSkin make_skin(const CuttableModel& model);
/// Takes no memory. Triangles come in the order of their cells, neighbours and faces ascending as in every skin.
void update(const CuttableModel& model, const CuttableState& state, CuttableSkin& skin) noexcept;

}  // namespace trocar::tissue
