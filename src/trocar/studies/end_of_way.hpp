// Where a mechanism is with its only drive at 1: where the jaws of an instrument are closed. New dimensions must keep
// that, or what was a grasper closes no more, or goes on through its other jaw.
#pragma once

#include <optional>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::studies {

struct EndOfWay {
  std::optional<Vec3d> followed;          ///< place of the frame that is followed [m]
  std::optional<kinematics::Frame> jaws;  ///< "tip_upper" seen from "tip_lower", if it has both frames

  /// How far it is from there: of places, and of a turn at the mechanism's length [m].
  double off(const EndOfWay& as_drawn, double length) const noexcept;
};

/// Nothing: it has not one drive, or does not get there.
std::optional<EndOfWay> end_of_way(const kinematics::Mechanism& m, int follow);

/// The named parameter that says where the way of the only drive ends, has bounds, and says nothing else; -1: none.
int end_parameter(const kinematics::Mechanism& m);

/// The value of that parameter, within its bounds, with which the end is nearest to where it was drawn.
double fitted_end(const kinematics::Mechanism& m, int parameter, int follow, const EndOfWay& as_drawn);

}  // namespace trocar::studies
