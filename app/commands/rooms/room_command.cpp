// trocar room: an operating room: how it stands, motions of its arms, plans of its ports, seen from outside.
#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
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
                           given.what == "follow" ? tr("expected a recording after \"follow\", got none")
                                                  : tr("expected a programme after \"programme\", got none")}});
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
      add_command(program, chosen, "room", tr("Show an operating room, move its telemanipulators, plan its ports"),
                  "trocar room telemanipulated\n"
                  "  trocar room telemanipulated pose --shots pictures\n"
                  "  trocar room telemanipulated programme triangle --out report\n"
                  "  trocar room telemanipulated follow attempt.rec\n"
                  "  trocar room telemanipulated plan --target gallbladder --out report");
  const char* motion = tr("Motion (programme, follow)");
  const char* ports = tr("Ports (plan)");
  const char* table = tr("Table (pose)");
  c->add_option("file", given->file, tr("a room's file, or a name that `trocar list rooms` shows"))->required();
  c->add_option("what", given->what,
                tr("show: open a window, with a programme where one is named; pose, programme, follow or plan"))
      ->check(CLI::IsMember({"show", "pose", "programme", "follow", "plan"}))
      ->capture_default_str();
  c->add_option("with", given->with,
                tr("programme, show: a programme's file, or a name that `trocar list programmes` shows; follow: a "
                   "recording; plan: the endoscope's port, default: the room's"));
  c->add_option("--shots", given->shots, tr("folder for pictures, drawn without a window"));
  c->add_option("--out", given->out, tr("programme, follow, plan: folder for a report with pictures"));
  c->add_option("--log", given->log, tr("show: write events of the window as JSON lines to this file"));
  c->add_option("--size", given->size, tr("WIDTHxHEIGHT of pictures"))->capture_default_str();
  c->add_option("--step-ms", given->step_ms, tr("time between steps [ms]"))
      ->check(number_between(1, 1000, "ms"))
      ->capture_default_str()
      ->group(motion);
  c->add_option("--seconds", given->seconds, tr("follow: length of the part of the recording [s]; default: all"))
      ->check(number_between(0, kLongestRecording, "s"))
      ->group(motion);
  c->add_option("--target", given->target,
                tr("a target of the room, or an organ of its scene; default: the room's first target"))
      ->group(ports);
  c->add_option("--grid-mm", given->grid_mm, tr("distance between places on the skin [mm]"))
      ->transform(whole_number(5, 60))
      ->capture_default_str()
      ->group(ports);
  c->add_option("--sets", given->sets, tr("number of plans that are shown"))
      ->transform(whole_number(1, 50))
      ->capture_default_str()
      ->group(ports);
  c->add_option("--head-down", given->head_down_deg, tr("tilt of the table, head down [deg]; default: the file's"))
      ->check(number_between(-60, 60, "degrees"))
      ->group(table);
  c->add_option("--left-down", given->left_down_deg, tr("tilt of the table, left side down [deg]; default: the file's"))
      ->check(number_between(-45, 45, "degrees"))
      ->group(table);
  c->callback([given, &chosen] { chosen.run = [given, &chosen] { return run_room(*given, chosen.json); }; });
}

}  // namespace trocar::app
