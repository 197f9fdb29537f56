// trocar room: an operating room: how it stands, motions of its arms, plans of its ports, seen from outside.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/operating_room/room_file.hpp>

#include "commands/command.hpp"
#include "commands/number_options.hpp"
#include "commands/rooms/room_answers.hpp"
#include "commands/rooms/room_follow.hpp"
#include "rooms/room_beside.hpp"
#include "rooms/room_window.hpp"

namespace trocar::app {
namespace {

/// The room in a window, with a programme where one is named.
int show_room(const RoomWords& given) {
  RoomWindowOptions window;
  window.room = scene::read_room(room_path(given.file, "rooms"));
  if (!given.with.empty())
    window.programme = scene::read_programme(room_path(given.with, "rooms/programmes"), window.room);
  window.log = given.log;
  run_room_window(std::move(window));
  return core::kDone;
}

int run_room(const RoomWords& given, bool json) {
  if (given.what == "show" && given.shots.empty()) return show_room(given);
  const std::unique_ptr<studies::RoomModel> loaded = load_room(given.file);
  const studies::RoomModel& model = *loaded;
  if (given.what == "pose" || given.what == "show") return answer_pose(model, given, json);
  if (given.what == "plan") return answer_plan(model, given, json);
  if (given.with.empty())
    throw core::BadInput({{{"trocar room", 0, 0},
                           fmt::format("expected a {} after \"{}\", got none",
                                       given.what == "follow" ? "recording" : "programme's file", given.what)}});
  if (given.what == "follow")
    return answer_motion(model, motion_of_recording(model, given.with, given.seconds),
                         std::filesystem::path(given.with).filename().string(), given, json);
  const scene::Programme programme = scene::read_programme(room_path(given.with, "rooms/programmes"), model.room());
  return answer_motion(model, motion_of(model, programme), programme.name, given, json);
}

}  // namespace

void add_room(CLI::App& program, Chosen& chosen) {
  auto given = std::make_shared<RoomWords>();
  CLI::App* c =
      add_command(program, chosen, "room", "An operating room: telemanipulators, their programmes, where to put ports",
                  "trocar room telemanipulated\n"
                  "  trocar room telemanipulated pose --shots pictures\n"
                  "  trocar room telemanipulated programme triangle --out report\n"
                  "  trocar room telemanipulated follow attempt.rec\n"
                  "  trocar room telemanipulated plan --target gallbladder --out report");
  c->add_option("file", given->file, "a room's file, or its name under scenes/rooms")->required();
  c->add_option("what", given->what,
                "show: in a window, with a programme if one is named; pose, programme, follow, plan")
      ->check(CLI::IsMember({"show", "pose", "programme", "follow", "plan"}))
      ->capture_default_str();
  c->add_option("with", given->with,
                "programme, show: its file, or its name under scenes/rooms/programmes; follow: a recording; plan: the "
                "endoscope's port, default: as the room has it");
  c->add_option("--shots", given->shots, "a folder for pictures, drawn without a window");
  c->add_option("--out", given->out, "programme, follow, plan: a folder for a report with pictures");
  c->add_option("--log", given->log, "show: JSON lines of what happens in the window");
  c->add_option("--size", given->size, "of pictures")->capture_default_str();
  c->add_option("--step-ms", given->step_ms, "programme, follow: between the steps that are looked at")
      ->check(number_between(1, 1000, "ms"))
      ->capture_default_str();
  c->add_option("--seconds", given->seconds, "follow: so much of the recording, default all")
      ->check(number_between(0, kLongestRecording, "s"));
  c->add_option("--target", given->target,
                "plan: a target of the room or an organ of its scene, default: the room's first target");
  c->add_option("--grid-mm", given->grid_mm, "plan: between places on the skin")
      ->transform(whole_number(5, 60))
      ->capture_default_str();
  c->add_option("--sets", given->sets, "plan: how many are told")
      ->transform(whole_number(1, 50))
      ->capture_default_str();
  c->add_option("--head-down", given->head_down_deg,
                "pose: how far the table is tilted, in place of what the file says")
      ->check(number_between(-60, 60, "degrees"));
  c->add_option("--left-down", given->left_down_deg, "pose: the same to the side")
      ->check(number_between(-45, 45, "degrees"));
  c->callback([given, &chosen] { chosen.run = [given, &chosen] { return run_room(*given, chosen.json); }; });
}

}  // namespace trocar::app
