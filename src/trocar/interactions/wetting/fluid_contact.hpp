// What drops meet in a scene: skins of organs and walls, folds (from either side) and strands, as planes; and where on
// them film lies. Instruments are none of this: fluids know them as capsules.
//
//   WetGround ground{bodies, first, grids};            // first: film_places(...), once
//   answer_drops(ground, down, state.droplets, work.droplets, wet);     // between fluids' begin_tick and finish_tick
//
// Bodies are numbered in that order (wet_order.hpp). Places of film are skin vertices; a fold has
// two a node, above and below; a strand one a node.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/fluids/droplets.hpp>
#include <trocar/interactions/bodies/bodies.hpp>
#include <trocar/interactions/contact/skin_grid.hpp>
#include <trocar/interactions/wetting/wet_order.hpp>

namespace trocar::interactions {

/// What fluids know of bodies beside what all know.
struct WetGround {
  Bodies bodies;
  std::span<const std::int32_t> first;  ///< (bodies + 1) where a body's places of film begin
  std::span<const SkinGrid> grids{};    ///< of the last surfaces, which never move; may be empty

  std::size_t surface_count() const noexcept { return bodies.work->surfaces.size(); }  ///< organs, walls
  WetOrder order() const noexcept { return {surface_count(), bodies.membrane_count()}; }
  int count() const noexcept { return int(surface_count() + bodies.membrane_count() + bodies.strand_count()); }
};

inline constexpr double kWetReach = 0.006;  ///< [m] between a point and the vertex next to it: more than skins' edges

/// Scratch: what many drops ask for in one tick is worked out once.
struct WetWork {
  std::vector<tissue::Box> bounds;  ///< (bodies) beyond it nothing of the body is near
  /// Blocks of moving skins, and other bodies whole, each with a box beyond which nothing of it is near. Side by side,
  /// as all are looked at at once; body after body, ascending.
  struct Blocks {
    std::vector<float> low[3], high[3];
    std::vector<std::int32_t> body, block;  ///< block: its number in the skin, -1: the whole body
    std::vector<std::int32_t> inside, hit;  ///< 1: met by what is looked at now; those that are
    int count = 0;

    template <class S, class V>
    static void fields(S& s, V&& v) {
      v("low", s.low), v("high", s.high), v("body", s.body), v("block", s.block), v("inside", s.inside),
          v("hit", s.hit), v("count", s.count);
    }
  };
  Blocks blocks;
  /// A body that may be met, and which of its blocks: hits[first] .. hits[last - 1]; none: all.
  struct Candidate {
    std::int32_t body = 0, first = 0, last = 0;
  };
  std::vector<Candidate> near;             ///< (bodies) those that may be met
  std::vector<std::int32_t> hits;          ///< (blocks) numbers of their blocks
  std::vector<tissue::Box> pieces;         ///< of strands, kPiece elements each
  std::vector<std::int32_t> first_piece;   ///< (strands + 1)
  std::vector<Vec3d> normal;               ///< (places of film) of skins' vertices that somebody has asked for
  std::vector<std::uint8_t> normal_known;  ///< (places of film)

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("bounds", s.bounds), v("blocks", s.blocks), v("near", s.near), v("hits", s.hits), v("pieces", s.pieces),
        v("first_piece", s.first_piece, core::kMadeOnce), v("normal", s.normal), v("normal_known", s.normal_known);
  }
};
/// @param first  as in WetGround; only sizes are looked at
WetWork make_wet_work(std::span<const StrandBody> strands, std::span<const std::int32_t> first);

/// Where each body's places of film begin; the last number is how many there are. Only sizes are looked at.
/// @param skins   (surfaces), then `sheets` of folds
std::vector<std::int32_t> film_places(std::span<const tissue::Skin* const> skins,
                                      std::span<const tissue::Skin* const> sheets, std::span<const StrandBody> strands);

/// A place of film as it lies now.
struct WetPlace {
  Vec3d point, normal, velocity;  ///< [m]; unit, away from the tissue; [m/s]
  std::int32_t body = -1;         ///< -1: there is no such place
};
/// @param down  unit; a strand's film hangs below it
WetPlace wet_place(const WetGround& ground, Vec3d down, std::int32_t place) noexcept;

/// Is p nearer than `reach` to tissue or a wall, or in it?
/// @param reach  [m], at most 2 mm
bool covered(const WetGround& ground, Vec3d p, double reach) noexcept;

/// Answers all questions of the drops and of overfull places of film.
void answer_drops(const WetGround& ground, Vec3d down, const fluids::DropletState& state, fluids::DropletWork& work,
                  WetWork& wet) noexcept;

}  // namespace trocar::interactions
