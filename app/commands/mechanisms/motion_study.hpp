// How a mechanism moves by itself: with its masses, under gravity and springs.
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::app {

struct MotionChoice {
  double seconds = 1, step_ms = 0.5;
  std::string data;  ///< file for a table; empty: none
};

/// Released at rest from a closed pose, nothing being held.
/// @param u  (u_count) where it begins
/// @return the exit code: 1 where the motion cannot be computed to its end, and why is printed
int show_motion(const kinematics::Mechanism& m, std::vector<double> u, const MotionChoice& choice, bool json);

}  // namespace trocar::app
