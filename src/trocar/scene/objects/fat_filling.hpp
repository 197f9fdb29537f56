// Where lobules of fat lie: a face-centred lattice in the thick lines that are to be filled, without what is in other
// bodies.
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/scene/objects/fat_scene.hpp>

namespace trocar::scene {

struct FatFilling {
  std::vector<Vec3d> lobules;      ///< [m]
  std::vector<std::uint8_t> free;  ///< (lobules) 1: on a face that lies against nothing
};

bool within(const FatSetting::Fill& fill, Vec3d p);

/// In what the setting fills, outside strands, organs and pouches in the drawn shape. No more than a few beyond 4000
/// are made.
FatFilling filled(const FatSetting& setting, const sim::Model& model);

}  // namespace trocar::scene
