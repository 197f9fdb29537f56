// What `trocar room` answers: a pose, a motion, plans of ports; as text, JSON, a page with pictures.
#pragma once

#include <string>

#include <trocar/core/json.hpp>
#include <trocar/pictures/picture_size.hpp>
#include <trocar/studies/operating_room/motion.hpp>
#include <trocar/studies/operating_room/ports.hpp>

namespace trocar::app {

struct RoomWords {
  std::string file, what = "show", with;
  std::string shots, out, target, log;
  std::string size = "1280x800";
  double step_ms = 20, seconds = 0;
  double head_down_deg = 1e9, left_down_deg = 1e9;
  int grid_mm = 20, sets = 5;
};

/// @return the exit code
int answer_pose(const studies::RoomModel& model, const RoomWords& words, bool json);
/// @param label  what led: a programme's or a recording's name
int answer_motion(const studies::RoomModel& model, const studies::RoomMotion& motion, const std::string& label,
                  const RoomWords& words, bool json);

/// Where to put ports.
int answer_plan(const studies::RoomModel& model, const RoomWords& words, bool json);

/// Pictures of a pose from all views into a folder. @return their names
Json take_pictures(const studies::RoomModel& model, const studies::RoomPose& pose, const RoomWords& words,
                   const std::string& folder);

}  // namespace trocar::app
