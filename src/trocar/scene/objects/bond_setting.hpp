// Places on bodies, and the loose tissue that ties a membrane there.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::scene {

/// A place on a body: the nodes within `radius` of `centre` are fixed (stiffness 0) or sprung to space.
struct Anchor {
  Vec3d centre;
  double radius = 0;
  double stiffness = 0;  ///< total [N/m]; 0 = rigidly fixed
  core::Location at;
};

/// Loose tissue between a membrane and what it lies on, that can be parted (interactions/couplings/bonds.hpp): at the
/// membrane's nodes in `places` that are within `reach` of one of the bodies `on`.
struct BondSetting {
  std::string name;
  std::vector<Anchor> places;   ///< centre and radius
  std::vector<std::string> on;  ///< solids, strands, membranes, pouches, fat
  double reach = 0.006;         ///< [m]
  double toughness = 50;        ///< [J/m^2]
  double opens = 0.005;         ///< [m]
  double oozes = 0;             ///< [mL/min/cm^2] where it has parted
  double bleeds = 0;            ///< [mL/min/cm^2] where what it is tied to has torn instead
  core::Location at;
};

}  // namespace trocar::scene
