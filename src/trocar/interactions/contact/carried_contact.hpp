// Bodies that are carried to each other: a loop of bowel on the liver, a freed gallbladder on the colon. About 160
// samples of what was drawn near are tested pair by pair (body_contact.hpp); this is for all others.
//
// Every sample of a body (skin vertex, node of a membrane, node of a rod) may come to any place of another one. Boxes
// of blocks of skin say in turn, a few blocks a tick, whether something is near; what comes nearer at up to 0.75 m/s is
// found before it touches. From then on the sample remembers its vertex (State) and walks over the skin with it. Of an
// open membrane it remembers the side on which it was found, too; beyond the border it forgets that.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {

/// Const after compile.
struct CarriedPair {
  static constexpr float kNever = 1;  ///< a sample that another test has, or that is held

  BodyId body;                 ///< whose samples: an organ, a membrane or a rod
  BodyId on;                   ///< on whose skin: an organ or a membrane
  std::vector<float> overlap;  ///< (samples) how far each lies within the contact distance in the drawn shape [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("on", s.on), v("overlap", s.overlap);
  }
};

/// An open membrane has: samples meet it from either.
bool has_two_sides(const BodyModels& models, BodyId body) noexcept;

/// @param tick     whose turn it is to look
/// @param nearest  (samples) State: vertex of the skin next to it, -1: none is near. Of what has two sides twice that,
///                 and 1 more for a sample behind it
void carried_contact(const Bodies& bodies, const CarriedPair& pair, std::uint64_t tick,
                     std::span<std::int32_t> nearest) noexcept;

}  // namespace trocar::interactions
