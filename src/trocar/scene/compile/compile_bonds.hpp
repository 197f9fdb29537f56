// Where a membrane that is yet to be built is held and tied: by places of its nodes.
#pragma once

#include <string>
#include <vector>

#include <trocar/scene/description/description.hpp>
#include <trocar/sim/model/attach_near.hpp>

namespace trocar::scene {

/// A membrane, and the loose tissue between it and what it lies on.
struct BondedMembrane {
  const std::string& name;
  const tissue::MembraneDescription& of;
  const std::vector<BondSetting>& settings;
};

/// Nodes within the places. A fault where a place holds none.
std::vector<std::uint8_t> nodes_within(const std::vector<Anchor>& places, const std::string& membrane,
                                       const std::vector<Vec3d>& positions, std::vector<core::Fault>& faults);

/// Which nodes are tied, and to what. A node that is held, or tied already, stays so. Of the membrane that is compiled
/// next.
std::vector<interactions::BondSet> bonds_of(const BondedMembrane& membrane, const Description& scene,
                                            const sim::DrawnBodies& drawn, std::vector<core::Fault>& faults);

/// The membrane as it hangs with its bonds whole, which bear what it does to them there.
/// @param tied  per node: 1 = in a hand
tissue::MembraneModel build_bonded(const tissue::MembraneDescription& d, std::vector<std::uint8_t> tied,
                                   std::vector<interactions::BondSet>& sets);

}  // namespace trocar::scene
