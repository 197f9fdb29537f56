// What tissues and metals look like: the looks that the Model brings along (files under scenes/looks/), as materials.
//   render::Material m = look(model, "uterus").material;
#pragma once

#include <string>
#include <vector>

#include <trocar/render/frame/material.hpp>
#include <trocar/sim/model/looks.hpp>
#include <trocar/sim/model/model.hpp>
#include <trocar/view/base/relief.hpp>

namespace trocar::view {

struct Look {
  using Generator = sim::Surrounding::Generator;

  std::string name;
  render::Material material;
  bool translucent = false;
  bool moulded = false;                        ///< of a model: it goes into what holds it and does not grow out of it
  Relief relief;                               ///< of solids
  std::vector<sim::Surrounding> surroundings;  ///< anatomy that is drawn around such a body

  /// How many of these are drawn around it, at most; 0: that generator is not named.
  int count(Generator generator) const;
  bool has(Generator generator) const { return count(generator) > 0; }
};

/// The model's look of that name, as long as a Model with the same library lives. One that is not there gives a neutral
/// tissue and is reported once.
const Look& look(const sim::Model& model, const std::string& name);
/// Of all that continues from the model's walls.
const Look& wall_look(const sim::Model& model);
/// Living tissue lets light through a thin rim; a box's silicone and board do not.
bool is_alive(const Look& look);
/// All of the model's.
const std::vector<Look>& all_looks(const sim::Model& model);

}  // namespace trocar::view
