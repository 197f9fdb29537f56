// The readers of operating rooms and of programmes, and what is made of what they accept: figures that are finite,
// distances that are told, motions that end.
#include <cmath>
#include <filesystem>

#include <trocar/core/files.hpp>
#include <trocar/scene/operating_room/room_file.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

std::vector<std::uint8_t> shipped(const std::string& name) {
  return bytes_of(core::read_file(std::filesystem::path(TROCAR_SOURCE_DIR) / "scenes/rooms" / name, 1u << 20));
}

void require_told(const std::vector<core::Fault>& faults) {
  require(faults.size() <= scene::kMaxFaults + 1, "faults are bounded");
  for (const core::Fault& f : faults) require(!f.message.empty(), "a fault says what was expected");
}

}  // namespace

void room_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const scene::Room room = scene::parse_room(text_of(bytes), "memory.json", faults);
  require_told(faults);
  if (!faults.empty()) return;
  require(room.arms.size() <= std::size_t(scene::kMostArms) && room.staff.size() <= std::size_t(scene::kMostPeople),
          "lists are bounded");
  const geometry::Figure figure(room.patient);
  require(std::fabs(figure.front(0, 0)) < 1e-9, "the umbilicus is the origin");
  for (const scene::RoomPort& p : room.ports)
    require(std::isfinite(figure.distance(p.position)), "a port is somewhere");
  for (double y = -1; y <= 1; y += 0.25)
    for (double x = -0.5; x <= 0.5; x += 0.25)
      require(std::isfinite(figure.front(x, y)) && std::isfinite(figure.distance({x, y, 0.1})), "skin is finite");
}

void programme_file(Bytes bytes) {
  std::vector<core::Fault> faults;
  const scene::Programme p = scene::parse_programme(text_of(bytes), "memory.json", nullptr, faults);
  require_told(faults);
  if (!faults.empty()) return;
  require(p.length() >= 0 && p.length() <= scene::kLongestProgramme, "programmes end");
  for (const scene::Programme::Move& m : p.moves)
    for (std::size_t k = 1; k < m.poses.size(); ++k) require(m.poses[k].at > m.poses[k - 1].at, "time goes on");
}

std::vector<Seed> room_seeds() {
  return {{"telemanipulated", shipped("telemanipulated.json")},
          {"small", bytes_of(R"({"format": 1, "name": "r", "ports": [{"name": "a", "at_mm": [0, 0, 0]}],
 "staff": [{"name": "s", "role": "surgeon", "at_mm": [500, 0]}],
 "instruments": [{"name": "i", "port": "a", "held_by": "s", "tip_mm": [0, 50, -80]}],
 "arms": [{"name": "l", "mechanism": "m.json", "port": "a", "on": "table", "base": [1, 0, 1], "stand_mm": [500, 0]}]})")}};
}
std::vector<Seed> programme_seeds() {
  return {{"triangle", shipped("programmes/triangle.json")}, {"too_far", shipped("programmes/too_far.json")}};
}

}  // namespace trocar::fuzz
