// A motion or a plan in an operating room as a page for people: one HTML file, its drawings inside, its pictures beside
// it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/studies/operating_room/motion.hpp>
#include <trocar/studies/operating_room/ports.hpp>

namespace trocar::reports {

struct RoomPicture {
  std::string file, words;  ///< beside the page
};

/// @param led_by  the programme or recording
std::string motion_html(const studies::RoomModel& model, const studies::MotionReport& report, const std::string& led_by,
                        const std::vector<RoomPicture>& pictures);

std::string plan_html(const studies::RoomModel& model, const studies::PortPlan& plan,
                      const std::vector<RoomPicture>& pictures);

/// Writes index.html. @return its path  @throws core::EnvironmentLacks
std::string write_room_page(const std::filesystem::path& folder, const std::string& html);

}  // namespace trocar::reports
