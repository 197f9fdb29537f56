// Bodies that are carried to each other, farther than they were drawn apart: a loop of bowel on the liver, a freed
// gallbladder on the colon. What was drawn near is tested pair by pair (body_contact.hpp), with the overlap that it was
// drawn with; this is for all else.
//
// Every sample of a body (skin vertex, node of a membrane, node of a rod) may come to any place of another one. Boxes
// of blocks of skin say in turn, a few blocks a tick, whether something is near; what comes nearer at up to 1.5 m/s is
// found before it touches. From then on the sample remembers its vertex (State) and walks over the skin with it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {

/// Const after compile.
struct CarriedPair {
  BodyId body;                      ///< whose samples: an organ, a membrane or a rod
  BodyId on;                        ///< on whose skin: an organ or a closed membrane
  std::vector<std::uint8_t> never;  ///< (samples) 1: drawn near, which is another test's, or held

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("on", s.on), v("never", s.never);
  }
};

/// @param tick     whose turn it is to look
/// @param nearest  (samples) State: vertex of the skin next to it, -1: none is near
void carried_contact(const Bodies& bodies, const CarriedPair& pair, std::uint64_t tick,
                     std::span<std::int32_t> nearest) noexcept;

}  // namespace trocar::interactions
