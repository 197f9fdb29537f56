// Arms that carry the instruments as the hands of an attempt moved them.
#pragma once

#include <string>

#include <trocar/studies/operating_room/motion.hpp>

namespace trocar::app {

/// The motion of a recording's hands, each by the arm at its port. @param seconds  of it, 0: all
/// @throws core::BadInput where it is no recording, or no hand has an arm's port
studies::RoomMotion motion_of_recording(const studies::RoomModel& model, const std::string& file, double seconds);

}  // namespace trocar::app
