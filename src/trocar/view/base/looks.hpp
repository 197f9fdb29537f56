// What tissues and metals look like: a table of named presets, which scene files ask for by "look".
//   render::Material m = look("uterus").material;
// Colours are what calibrated pictures of laparoscopies show, read off as sRGB; sizes of patterns from anatomy.
#pragma once

#include <string>
#include <vector>

#include <trocar/render/frame/material.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {

struct Look {
  std::string name;
  render::Material material;
  bool translucent = false;
  Relief relief;           ///< of solids
  int fat_tags = 0;        ///< of large bowel
  int adhesions = 0;       ///< strings and veils to the wall, at most
  bool draped = false;     ///< peritoneum covers it and runs out on what is around
  bool omentum = false;    ///< fat lies on the lowest part of such a wall
  bool continued = false;  ///< only its lower edge is simulated: the rest is drawn (liver_dome.hpp)
};

/// The preset of that name. An unknown name gives a neutral tissue and is reported once.
const Look& look(const std::string& name);
/// All of them, for galleries and tests.
const std::vector<Look>& all_looks();

}  // namespace trocar::view
