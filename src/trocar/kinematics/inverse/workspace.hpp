// Where a frame of a mechanism can get to: poses at random within limits, loops closed, counted in cells of space. The
// same seed gives the same poses.
//
//   const Workspace w = workspace(m, m.frames[tip]);
//   w.volume;              // [m^3] of the cells that were met
//
// A mechanism with drives is controlled by them, from 0 to 1; where there is one only, by all of its way in steps, and
// the frame's way is a line. One without drives is controlled by all of its coordinates.
#pragma once

#include <string>

#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {

struct WorkspaceOptions {
  int samples = 100'000;  ///< poses within limits; thirty times as many are tried at most
  double cell = 0;        ///< edge of a cell [m]; 0: a fortieth of the longest side of what is reached
  unsigned seed = 1;
};

struct Workspace {
  int samples = 0;            ///< poses that were asked for
  int closed = 0;             ///< of them: the loops close
  int within = 0;             ///< and no coordinate is beyond its limits
  Vec3d low, high;            ///< what is reached lies between [m]
  double cell = 0;            ///< [m]
  double volume = 0;          ///< of cells that hold a place that was reached [m^3]
  double volume_of_half = 0;  ///< the same of the first half of the places: how far the count has settled
  double path = 0;            ///< with one drive: length of the frame's way [m]
};

/// @throws std::invalid_argument where no closed pose is found from the start
Workspace workspace(const Mechanism& m, const BodyFrame& frame, const WorkspaceOptions& options = {});

}  // namespace trocar::kinematics
