// What a node of a border, or a rod's end, is attached to.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/material_point.hpp>

namespace trocar::interactions {

struct Attachment {
  MaterialPoint point;        ///< rides on its body, or is in space
  Vec3d drawn_pull{0, 0, 0};  ///< on it in the drawn shape, which its body is drawn bearing already [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("point", s.point), v("drawn_pull", s.drawn_pull);
  }
};

}  // namespace trocar::interactions
