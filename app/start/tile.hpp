// A tile: a picture with a few words below, that can be chosen with mouse, keys and gamepad.
#pragma once

#include <string>

#include <imgui.h>

namespace trocar::app {

struct TileLook {
  std::string id;           ///< for tests and for ImGui
  std::string title;        ///< in as many lines as it needs
  std::string over;         ///< on the picture's lower edge: "about 4 minutes"; may be empty
  std::string badge;        ///< on its upper edge: "Next for you"; may be empty
  std::string detail;       ///< grey, one line: "Beginner"; may be empty
  std::string result;       ///< one line: "Best 85 of 100"; may be empty
  bool passed = false;      ///< a tick beside the result
  unsigned texture = 0;     ///< GL; 0: a drawing stands in
  float aspect = 4.0f / 3;  ///< of the texture
};

/// Height of a tile that is `width` wide [px].
float tile_height(const TileLook& look, float width);
/// True: it was chosen. @param size [px]
bool draw_tile(const TileLook& look, ImVec2 size);

}  // namespace trocar::app
