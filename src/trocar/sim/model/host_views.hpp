// Bodies as carriers of vessels, in the way interactions/couplings/vessel_path.hpp wants to see them.
#pragma once

#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Views of a State: valid until its next tick.
struct HostViews {
  std::vector<tissue::NodeView> organs, membranes;
  std::vector<const tissue::Skin*> skins;  ///< (organs) those of lattices are touched; cells carry in the others
  std::vector<std::int32_t> cuttable_of;   ///< (organs) which of the cuttables it is; -1: a lattice
  /// Vertices of lattices' skins that carry vessels with a pulse, each once.
  struct Corner {
    std::int32_t organ = 0, vertex = 0;
  };
  std::vector<Corner> ridden;
  std::vector<std::vector<Vec3d>> corners;  ///< (organs)(skin vertices) where those are [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("organs", s.organs), v("membranes", s.membranes), v("skins", s.skins, core::kMadeOnce),
        v("cuttable_of", s.cuttable_of, core::kMadeOnce), v("ridden", s.ridden, core::kMadeOnce),
        v("corners", s.corners);
  }
};
HostViews make_host_views(const Model& model);

/// Looks at the State as it is now; takes no memory.
interactions::VesselHosts look_at_hosts(const Model& model, const State& state, HostViews& views) noexcept;
/// The same for who poses all vessels with a pulse, and no others: what several of their points ride on is worked out
/// once.
interactions::VesselHosts look_at_hosts_of_all(const Model& model, const State& state, HostViews& views) noexcept;

/// Places of a vessel that are cut through. @param out  at least kMaxOpenings
std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept;

}  // namespace trocar::sim
