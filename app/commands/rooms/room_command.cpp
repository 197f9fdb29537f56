// trocar room: an operating room: how it stands, motions of its arms, plans of its ports, seen from outside.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/operating_room/room_file.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/rooms/room_answers.hpp"

namespace trocar::app {
namespace {

/// A path, or a name under scenes/rooms.
std::filesystem::path room_path(const std::string& name, const char* folder) {
  std::error_code error;
  const auto scenes = scene::found_scenes_folder();
  if (std::filesystem::exists(name, error) || !scenes) return name;
  const std::filesystem::path shipped = *scenes / folder / (name + ".json");
  return std::filesystem::exists(shipped, error) ? shipped : std::filesystem::path(name);
}

studies::RoomModel build_model(const std::string& file) {
  const std::filesystem::path path = room_path(file, "rooms");
  scene::Room room = scene::read_room(path);
  try {
    return studies::RoomModel(std::move(room));
  } catch (const std::invalid_argument& bad) {
    throw core::BadInput({{{path.generic_string(), 0, 0}, bad.what()}});
  }
}

int run_room(const RoomWords& given, bool json) {
  const studies::RoomModel model = build_model(given.file);
  if (given.what == "pose") return answer_pose(model, given, json);
  if (given.with.empty())
    throw core::BadInput({{{"trocar room", 0, 0},
                           fmt::format("expected a {} after \"{}\", got none",
                                       given.what == "follow" ? "recording" : "programme's file", given.what)}});
  const scene::Programme programme = scene::read_programme(room_path(given.with, "rooms/programmes"), model.room());
  return answer_motion(model, motion_of(model, programme), programme.name, given, json);
}

}  // namespace

void add_room(CLI::App& program, Chosen& chosen) {
  auto given = std::make_shared<RoomWords>();
  CLI::App* c =
      add_command(program, chosen, "room", "An operating room: telemanipulators, their programmes, where to put ports",
                  "trocar room telemanipulated pose --shots pictures\n"
                  "  trocar room telemanipulated programme triangle --out report");
  c->add_option("file", given->file, "a room's file, or its name under scenes/rooms")->required();
  c->add_option("what", given->what, "pose, programme")->check(CLI::IsMember({"pose", "programme"}))->required();
  c->add_option("with", given->with, "programme: its file, or its name under scenes/rooms/programmes");
  c->add_option("--shots", given->shots, "a folder for pictures, drawn without a window");
  c->add_option("--out", given->out, "programme: a folder for a report with pictures");
  c->add_option("--size", given->size, "of pictures")->capture_default_str();
  c->add_option("--step-ms", given->step_ms, "programme: between the steps that are looked at")
      ->check(number_between(1, 1000, "ms"))
      ->capture_default_str();
  c->add_option("--head-down", given->head_down_deg,
                "pose: how far the table is tilted, in place of what the file says")
      ->check(number_between(-60, 60, "degrees"));
  c->add_option("--left-down", given->left_down_deg, "pose: the same to the side")
      ->check(number_between(-45, 45, "degrees"));
  c->callback([given, &chosen] { chosen.run = [given, &chosen] { return run_room(*given, chosen.json); }; });
}

}  // namespace trocar::app
