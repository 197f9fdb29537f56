// Where a membrane hangs: every node of its borders rides on a strand, on an organ's skin, or stays in space. The node
// is exactly where its holder is when the tick ends; the holder bears what the sheet pulls with.
//
// Holders step before the sheet does, with its pull at the tick's beginning. To hold a stiff sheet with a light holder
// they resist changes of their velocity beside that, implicitly: an inertia of added_damping() x dt. A holder of mass m
// with the border's own stiffness k and damping d is stable from 1/4 k dt^2 and 1/2 d dt on, however small m; what the
// inertia differs from the sheet's own is momentum that goes astray while the holder's speed changes (a test bounds
// it).
#pragma once

#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/couplings/loads.hpp>
#include <trocar/interactions/couplings/strand_body.hpp>
#include <trocar/tissue/membrane/membrane.hpp>

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

/// Bodies that may hold a border, and where their loads go.
struct Holders {
  std::span<const StrandBody> strands;
  std::span<const tissue::StrandState> strand_states;
  std::span<const tissue::NodeView> nodes;  ///< of the organs
  std::span<const tissue::Skin* const> skins;
};

/// Where the node shall be: on its holder as that is now.
Vec3d held_place(const BorderHold& hold, const Holders& holders) noexcept;
/// How fast its holder moves there [m/s].
Vec3d held_velocity(const BorderHold& hold, const Holders& holders) noexcept;

/// Gives a force to the holder, and a resistance `d` to changes of its velocity there [N s/m]. Nothing to space.
void bear(const BorderHold& hold, Vec3d force, double d, const Holders& holders, std::span<StrandLoads> strand_loads,
          std::span<NetworkLoads> organ_loads) noexcept;

/// What a border node resists its holder's changes of velocity with [N s/m].
double added_damping(const tissue::BorderPull& pull, double dt) noexcept;

/// Gives the sheet's pulls to the holders.
/// @param holds, pulls  (held nodes of the membrane)
void border_loads(std::span<const BorderHold> holds, std::span<const tissue::BorderPull> pulls,
                  const tissue::MembraneModel& sheet, const tissue::MembraneState& state, const Holders& holders,
                  double dt, std::span<StrandLoads> strand_loads, std::span<NetworkLoads> organ_loads) noexcept;

void add_to_hash(core::Hasher& hasher, const BorderHold& hold) noexcept;

}  // namespace trocar::interactions
