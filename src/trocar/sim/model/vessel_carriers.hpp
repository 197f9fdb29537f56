// What carries vessels, for who asks in every tick where they run; and where they are cut through.
#pragma once

#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Vertices of lattices' skins that carry vessels with a pulse: several points ride on each, so that where it is is
/// worked out once a tick.
struct RiddenCorners {
  struct Corner {
    std::int32_t organ = 0, vertex = 0;
  };
  std::vector<Corner> list;               ///< each once
  std::vector<std::vector<Vec3d>> place;  ///< (organs)(skin vertices) where those are [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("list", s.list, core::kMadeOnce), v("place", s.place);
  }
};
RiddenCorners make_ridden_corners(const Model& model);
void pose(const interactions::Bodies& bodies, RiddenCorners& corners) noexcept;

/// Places of a vessel that are cut through. @param out  at least kMaxOpenings
std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept;

}  // namespace trocar::sim
