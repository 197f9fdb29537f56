// Coordinates in the units of files.
#pragma once

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::app {

inline bool is_angle(const kinematics::Mechanism& m, int q) {
  return m.measures[std::size_t(q)] == kinematics::Measure::angle;
}
/// A coordinate or its speed, from rad or m (a second) to degrees or mm (a second).
inline double in_file(const kinematics::Mechanism& m, int q, double value) {
  return is_angle(m, q) ? value * 180 / portable::pi : 1e3 * value;
}
inline const char* unit_of(const kinematics::Mechanism& m, int q) { return is_angle(m, q) ? "deg" : "mm"; }

}  // namespace trocar::app
