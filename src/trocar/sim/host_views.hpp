// Bodies as carriers of vessels, in the way interactions/vessel_path.hpp wants to see them.
#pragma once

#include <vector>

#include <trocar/sim/state.hpp>

namespace trocar::sim {

/// Views of a State: valid until its next tick.
struct HostViews {
  std::vector<tissue::NodeView> organs, membranes;
  std::vector<const tissue::Skin*> skins;  ///< (organs) those of lattices are touched; cells carry in the others
};
HostViews make_host_views(const Model& model);

/// Looks at the State as it is now; takes no memory.
interactions::VesselHosts look_at_hosts(const Model& model, const State& state, HostViews& views) noexcept;

/// Places of a vessel that are cut through. @param out  at least kMaxOpenings
std::span<const double> cuts_of(const State& state, int vessel, std::span<double> out) noexcept;

}  // namespace trocar::sim
