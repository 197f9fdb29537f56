// Kinds of objects as scene files have them: what is written of each, how it is read, written back and compiled. The
// list of interactions/objects/object_kinds.hpp, one floor up.
#pragma once

#include <tuple>
#include <vector>

#include <trocar/core/kind_list.hpp>
#include <trocar/scene/objects/bag_scene.hpp>
#include <trocar/scene/objects/fat_scene.hpp>
#include <trocar/scene/objects/leaf_scene.hpp>
#include <trocar/scene/objects/rigid_scene.hpp>
#include <trocar/scene/objects/suture_scene.hpp>

namespace trocar::scene {

using ObjectScenes = core::KindList<RigidScene, FatScene, LeafScene, BagScene, SutureScene>;

namespace objects {
template <class K>
using SettingsOf = std::vector<typename K::Setting>;
}
/// What a scene says of objects, a list a kind.
using ObjectSettings = ObjectScenes::Map<std::tuple, objects::SettingsOf>;

template <class K, class Settings>
auto& settings_of(K, Settings& all) {
  return std::get<std::vector<typename K::Setting>>(all);
}

}  // namespace trocar::scene
