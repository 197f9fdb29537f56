// The tables of mechanism files. Private to the room.
#pragma once

#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

const Shape& mechanism_parameter_keys();
const Shape& mechanism_link_keys();
const Shape& mechanism_joint_keys();
const Shape& mechanism_dh_keys();
const Shape& mechanism_shape_keys();
const Shape& mechanism_motor_keys();
const Shape& mechanism_coupling_keys();
const Shape& mechanism_term_keys();
const Shape& mechanism_actuator_keys();
const Shape& mechanism_frame_keys();
const Shape& mechanism_end_keys();
const Shape& mechanism_closure_keys();
const Shape& mechanism_spring_keys();

inline constexpr double kFarMechanism = 5000;  ///< [mm] no dimension is larger
inline constexpr double kMostDegrees = 3600;
inline constexpr double kMostRatio = 1e4;

}  // namespace trocar::scene
