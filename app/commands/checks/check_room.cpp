#include "commands/checks/check_room.hpp"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/studies/operating_room/motion.hpp>

#include "rooms/room_beside.hpp"

namespace trocar::app {

namespace fs = std::filesystem;
using namespace studies;

namespace {

bool has_any(const scene::JsonValue& root, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return root.find(key) != nullptr; });
}

/// JSON files in a folder, by name.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  for (const fs::directory_entry& e : fs::directory_iterator(folder.empty() ? fs::path(".") : folder, error))
    if (e.path().extension() == ".json") out.push_back(e.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// Rooms that a programme may be for.
std::vector<fs::path> rooms_near(const fs::path& programme) {
  const fs::path here = programme.parent_path();
  std::vector<fs::path> out;
  for (const fs::path& folder : {here / "..", here})
    for (const fs::path& file : files_in(folder)) {
      std::vector<core::Fault> ignored;
      if (is_room_file(scene::load_json(file, ignored).root)) out.push_back(file.lexically_normal());
    }
  return out;
}

}  // namespace

bool is_room_file(const scene::JsonValue& root) {
  return !is_programme_file(root) && has_any(root, {"staff", "monitors", "arms", "ports_of", "targets"});
}

bool is_programme_file(const scene::JsonValue& root) { return root.find("moves") != nullptr; }

Json describe_room(const fs::path& path) {
  const std::unique_ptr<RoomModel> model = load_room(path.string());
  const RoomPose pose = model->start();
  std::vector<std::string> wrong;
  for (std::size_t a = 0; a < model->arms().size(); ++a) {
    const ArmModel& arm = model->arms()[a];
    if (const double gap = port_gap(model->shaft(pose, int(a)), arm.port); gap > 1e-4)
      wrong.push_back(tr("the shaft of {} is {:.1f} mm beside its port", arm.described->name, 1e3 * gap));
    if (const double beyond = model->beyond_set_up(int(a)); beyond > 0)
      wrong.push_back(
          tr("the base of {} is {:.0f} mm beyond the reach of its set-up joints", arm.described->name, 1e3 * beyond));
  }
  for (std::size_t k = 0; k < model->room().staff.size(); ++k)
    if (const double beyond = model->person(int(k), pose).beyond_reach; beyond > 0)
      wrong.push_back(tr("what {} holds is {:.0f} mm beyond their reach", model->room().staff[k].name, 1e3 * beyond));
  if (!model->can_tilt(pose.tilt)) wrong.push_back("the table cannot tilt so far");
  const std::vector<Near> near = model->nearest(pose);
  for (const Near& n : near)
    if (n.distance < model->room().margin)
      wrong.push_back(tr("{} and {} are {:.1f} mm apart, less than the margin", n.first, n.second, 1e3 * n.distance));
  Json out{{"file", path.string()},
           {"kind", "room"},
           {"arms", model->arms().size()},
           {"ports", model->room().ports.size()},
           {"staff", model->room().staff.size()},
           {"least_clearance_mm", near.empty() ? Json() : Json(1e3 * near.front().distance)},
           {"wrong", wrong}};
  if (!wrong.empty()) out["verdict"] = "not possible";
  return out;
}

Json describe_programme(const fs::path& path) {
  std::optional<core::BadInput> best;
  for (const fs::path& file : rooms_near(path)) {
    try {
      const std::unique_ptr<RoomModel> model = load_room(file.string());
      const scene::Programme programme = scene::read_programme(path, model->room());
      const MotionReport r = go_through(*model, motion_of(*model, programme), {});
      std::vector<std::string> wrong;
      for (const MotionFault& f : r.faults)
        wrong.push_back(fmt::format("{:.2f} to {:.2f} s, {}: {}", f.from, f.to, word_of(f.kind), f.words));
      Json out{{"file", path.string()},
               {"kind", "programme"},
               {"room", model->room().name},
               {"seconds", r.length},
               {"least_clearance_mm", 1e3 * r.least_clearance},
               {"wrong", wrong}};
      if (!r.good()) out["verdict"] = "it cannot be done";
      return out;
    } catch (const core::BadInput& bad) {
      if (!best || bad.faults().size() < best->faults().size()) best = bad;
    }
  }
  if (best) throw *best;
  throw core::BadInput(
      {{{path.generic_string(), 0, 0}, "expected the room that it is for beside it or in the folder above, got none"}});
}

void print_room(const Json& r) {
  if (r["kind"] == "programme")
    fmt::print("{}", tr("  in {}: {:.2f} s, least clearance {:.1f} mm\n", r["room"].get<std::string>(),
                        r["seconds"].get<double>(), r["least_clearance_mm"].get<double>()));
  else
    fmt::print("{}", tr("  {} arms, {} ports, {} people\n", r["arms"].get<int>(), r["ports"].get<int>(),
                        r["staff"].get<int>()));
  for (const Json& w : r["wrong"]) fmt::print("  {}\n", w.get<std::string>());
}

}  // namespace trocar::app
