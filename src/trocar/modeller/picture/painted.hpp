// What a brush has left on a body, for showing it while one paints.
#pragma once

#include <string>
#include <vector>

#include <trocar/modeller/document/document.hpp>
#include <trocar/scene/description/stiffness_region.hpp>

namespace trocar::modeller {

/// Balls of a solid or a pouch, as its text has them [m].
struct Painted {
  std::vector<scene::StiffnessRegion> balls;  ///< holds and bonds: stiffness means nothing
  bool stiffness = false;

  /// Of stiffness: how many times the tissue's it is there. Else 1 within a ball and 0 outside.
  double at(Vec3d place) const;
};
/// @param what   "hold", "bonds" or "stiffness", as the operation `paint` calls them
/// @param bonds  name of the bonds; empty: the first
Painted painted_on(const Document& document, const std::string& thing, const std::string& what,
                   const std::string& bonds = "");

}  // namespace trocar::modeller
