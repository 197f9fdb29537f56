// What an instrument file says of the mechanism in it: the linkage between handle and jaws, and what bends between
// shaft and jaws.
#pragma once

#include <memory>
#include <string>

#include <trocar/core/error.hpp>
#include <trocar/kinematics/chains/description.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::scene {

/// A file of scenes/mechanisms that something names.
struct NamedMechanism {
  std::string file;                                                     ///< as named; empty: none
  std::shared_ptr<const kinematics::MechanismDescription> description;  ///< null where it could not be read
  core::Location at;
};

/// Two hinges before the jaws, or the chain of a mechanism.
struct WristSetting {
  bool there = false;
  double between = 0, after = 0.008;  ///< [m] hinge to hinge, hinge to the jaws' hinge
  double pitch = 80 * portable::pi / 180, yaw = 80 * portable::pi / 180;  ///< as far as they turn either way [rad]
  NamedMechanism mechanism;
};

}  // namespace trocar::scene
