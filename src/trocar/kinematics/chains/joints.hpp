// What joints of each kind are built of: one body a freedom, in this order.
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {

struct Freedom {
  Motion motion = Motion::none;
  Vec3d axis = {0, 0, 1};
  const char* suffix = "";  ///< of the coordinate's name, behind the joint's
};
std::vector<Freedom> freedoms(const Joint& joint);

/// Name of the coordinate of a freedom.
inline std::string coordinate_name(const Link& link, const Freedom& freedom) {
  return (link.joint.name.empty() ? link.name : link.joint.name) + freedom.suffix;
}

/// All coordinates of a description, in order: of links, then of motors.
struct NamedCoordinate {
  std::string name;
  Measure measure = Measure::angle;
  int link = -1, motor = -1;
  bool screwed = false;  ///< the slide of a screw follows its turn
};
std::vector<NamedCoordinate> coordinates_of(const MechanismDescription& d);

}  // namespace trocar::kinematics
