// The tables of room and programme files. Private to the room.
#pragma once

#include <trocar/scene/json/shape.hpp>
#include <trocar/scene/operating_room/room.hpp>

namespace trocar::scene {

const Shape& room_patient_keys();
const Shape& room_table_keys();
const Shape& room_port_keys();
const Shape& room_instrument_keys();
const Shape& room_person_keys();
const Shape& room_monitor_keys();
const Shape& room_arm_keys();
const Shape& room_target_keys();
const Shape& programme_move_keys();
const Shape& programme_pose_keys();
const Shape& programme_tilt_keys();
std::vector<std::string> staff_words();  ///< in the order of StaffRole

}  // namespace trocar::scene
