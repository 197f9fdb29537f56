// What one node of a membrane, or a bond, rides on.
#pragma once

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>

namespace trocar::interactions {

/// What one held node of a membrane rides on. Const after compile.
struct BorderHold {
  enum Kind : std::int32_t { space, strand, organ } kind = space;
  std::int32_t index = -1;    ///< strand or organ
  StrandPlace place;          ///< on the strand
  std::int32_t vertex = -1;   ///< of the organ's skin
  Vec3d offset{0, 0, 0};      ///< from there to the node in the drawn shape [m]
  Vec3d drawn_pull{0, 0, 0};  ///< of the sheet in the drawn shape: its holder is drawn bearing it already [N]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kind", s.kind), v("index", s.index), v("place", s.place), v("vertex", s.vertex), v("offset", s.offset),
        v("drawn_pull", s.drawn_pull);
  }
};

void add_to_hash(core::Hasher& hasher, const BorderHold& hold) noexcept;

}  // namespace trocar::interactions
