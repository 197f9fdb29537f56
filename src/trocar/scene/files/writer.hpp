// Writes a Description as one scene file that holds everything; reading it back gives an equal Description (places in
// files aside). Meshes and voxels alone stay in files of their own, named as their source named them: they must lie the
// same way from the new file, and what a variation did to them is not written.
//
//   const Description d = read_scene("scenes/gynaecology/scene.json");
//   std::ofstream("copy.json") << write_scene(d);
#pragma once

#include <string>

#include <trocar/scene/description/description.hpp>

namespace trocar::scene {

std::string write_scene(const Description& description);

}  // namespace trocar::scene
