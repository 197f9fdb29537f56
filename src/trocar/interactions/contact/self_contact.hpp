// An organ touches itself: one that is folded rests on itself and does not pass through. Samples of its skin are tested
// against the plane of the nearest vertex of *another part* of the same skin: one that is further away along the skin,
// in the drawn shape, than the body can be creased.
//
// What must not be taken for contact is the body's own inside: behind a sample on a thin slab lies its other face, with
// a normal opposed to the sample's, and the sample is behind it. So a part is only ever found from outside, by looking
// along the sample's normal: it lies in front of the sample, the sample lies in front of it, and they face each other.
// Samples look in turn, a few a tick, 12 mm far: what comes nearer at up to 0.37 m/s is found before it touches. From
// then on the vertex is remembered (State) and walks over that part's skin, as between organs, until the two are 15 mm
// apart or no longer face each other; it never walks into the sample's own neighbourhood.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

/// Which parts of an organ's skin can meet. Const after compile.
struct SelfPair {
  std::int32_t organ = 0;
  std::int32_t words = 0;             ///< of `others`, for each sample
  std::vector<std::int32_t> sample;   ///< skin vertices
  std::vector<float> overlap;         ///< what a sample lies behind another part in the drawn shape [m]
  std::vector<std::uint64_t> others;  ///< (samples x words) bit v: vertex v is another part of the skin

  bool other(std::size_t i, int vertex) const noexcept {
    return vertex < 64 * words && (others[i * std::size_t(words) + std::size_t(vertex / 64)] >> (vertex % 64) & 1u);
  }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("organ", s.organ), v("sample", s.sample), v("overlap", s.overlap), v("others", s.others),
        v("words", s.words, core::kNotHashed);
  }
};

/// @param drawn  the organ in the drawn shape
/// @param apart  along the skin, nearer vertices are a sample's own neighbourhood [m]
SelfPair make_self_pair(int organ, const Surface& drawn, std::span<const int> samples, double apart);

/// How slender a skin is: its longest way along the surface over its volume per area [-]. A ball has 9, a rod three
/// times as long as thick 18; below about 16 a body is too stout to be folded onto itself.
double slenderness(const tissue::Skin& skin);

/// @param part     (vertices) which piece of a cut body each belongs to, or empty: pieces meet elsewhere
/// @param folded   (rows) what is folded into itself, or empty: that has left its place through the body, and would be
///                 held off from its way home
/// @param tick     whose turn it is to look
/// @param nearest  (samples) State: the vertex of the other part, -1 where none is near
void self_contact(const SelfPair& pair, const Surface& surface, std::span<const std::int32_t> part,
                  std::span<const std::uint8_t> folded, std::uint64_t tick, std::span<std::int32_t> nearest,
                  NetworkLoads& loads) noexcept;

}  // namespace trocar::interactions
