// A membrane as it is now, for hands and drops: a surface with two sides.
#pragma once

#include <span>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

struct SheetView {
  Surface surface;                       ///< its skin's vertices are its nodes
  std::span<const std::uint8_t> parted;  ///< (triangles) 1 = cut open
  std::span<const std::uint8_t> fixed;   ///< (nodes) tissue::Held bits
  double half_thickness = 0;             ///< [m]
  /// Of a closed wall, whose nodes are too far apart to bulge between jaws: beside them, within this, they are pinched
  /// into a fold all the same [m].
  double pinch_reach = 0;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("surface", s.surface), v("parted", s.parted), v("fixed", s.fixed), v("half_thickness", s.half_thickness),
        v("pinch_reach", s.pinch_reach);
  }
};

}  // namespace trocar::interactions
