// The shipped pelvis, dry and with blood, compiled once for all tests of the folder.
#pragma once

#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {

inline const sim::Model& pelvis() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  return model;
}

inline const sim::Model& bleeding() {
  static const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  return model;
}

/// Its organs, drawn without relief.
inline std::vector<OrganDrawing> drawn_organs(render::Backend& backend) {
  std::vector<OrganDrawing> organs;
  for (const sim::SolidModel& s : pelvis().solids)
    organs.emplace_back(s, Relief{}, std::vector<Paint>(s.fine.rest.size()), backend);
  return organs;
}

inline const render::Target kTarget = render::Target::off_screen(64, 48);

}  // namespace trocar::view
