// What an exercise has to be controlled with: help and introduction speak of nothing else.
#pragma once

#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::app {

struct Equipment {
  int hands = 4;
  bool jaws = true, clips = true, valves = true, needle = true, hook = true;  ///< in any rack
  bool energy = true, wrist = true, oblique = true, lens = true, declares = true;

  bool has(devices::HelpNeeds needs) const;
};

/// @param declares  the exercise asks for a declaration
Equipment equipment_of(const sim::Model& model, bool declares);

}  // namespace trocar::app
