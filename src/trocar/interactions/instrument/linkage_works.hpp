// What of a linkage shows between an instrument's shaft and its jaws: rods and bars and where each of them stands along
// the handle's way, and the tails by which they turn the jaws. Drawn only: the step computes with linkage.hpp's table.
//
// Frame: that of the closed jaws' hinge, x where jaws open, z from the shaft to the jaws.
#pragma once

#include <vector>

#include <trocar/interactions/instrument/linkage.hpp>
#include <trocar/kinematics/chains/frame.hpp>

namespace trocar::interactions {

/// A round piece between two points.
struct WorksRod {
  Vec3d a, b;
  double radius = 0;  ///< [m]
};

struct LinkageWorks {
  /// What moves as one; its rods are in its own frame.
  struct Part {
    std::vector<WorksRod> rods;
    std::vector<Vec3d> pins;            ///< joints with others, about y
    std::vector<kinematics::Frame> at;  ///< (kLinkageSteps + 1)
  };
  /// Behind the hinge, fixed on a jaw: from the hinge to where it is taken hold of, with open and with closed jaws. Of
  /// a slot these are two places.
  struct Tail {
    int jaw = 0;  ///< 0 opens along x, 1 against it
    Vec3d open, closed;
  };
  std::vector<Part> parts;
  std::vector<Tail> tails;
  double shaft_end = 0;  ///< behind the hinge [m]
};

/// Where a part stands at a place of the handle, 0 open .. 1 closed.
kinematics::Frame at_handle(const LinkageWorks::Part& part, double handle) noexcept;

}  // namespace trocar::interactions
