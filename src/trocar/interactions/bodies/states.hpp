// Bodies as they are now: what of them a replay needs.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/interactions/bodies/static_organ.hpp>
#include <trocar/tissue/fat/fat.hpp>
#include <trocar/tissue/membrane/membrane.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/strand/strand.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace trocar::interactions {

/// In the order of BodyModels.
struct BodyStates {
  std::vector<tissue::NetworkState> solids;
  std::vector<tissue::CuttableState> cuttables;
  std::vector<StaticOrganState> statics;  ///< (BodyModels::statics)
  std::vector<tissue::StrandState> strands;
  std::vector<tissue::MembraneState> membranes;
  std::vector<tissue::FatState> fat;
  std::vector<std::vector<std::uint8_t>> torn;  ///< (membranes) per triangle: 1 = cut open
};

}  // namespace trocar::interactions
