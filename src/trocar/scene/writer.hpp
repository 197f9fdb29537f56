// Writes a Description as one scene file that holds everything (no other files named); reading it back gives an equal
// Description (places in files aside).
//
//   const Description d = read_scene("scenes/gynaecology/scene.json");
//   std::ofstream("copy.json") << write_scene(d);
#pragma once

#include <string>

#include <trocar/scene/description.hpp>

namespace trocar::scene {

std::string write_scene(const Description& description);

}  // namespace trocar::scene
