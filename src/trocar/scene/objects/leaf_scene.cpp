#include <trocar/scene/objects/leaf_scene.hpp>

namespace trocar::scene {

void LeafScene::bend(std::vector<Setting>& settings, const std::function<Vec3d(Vec3d)>& warp) {
  for (LeafSetting& leaf : settings) {
    for (std::vector<Vec3d>& line : leaf.lines)
      for (Vec3d& p : line) p = warp(p);
    for (Anchor& place : leaf.held) place.centre = warp(place.centre);
    for (BondSetting& bond : leaf.bonds)
      for (Anchor& place : bond.places) place.centre = warp(place.centre);
  }
}

}  // namespace trocar::scene
