// trocar list: what is there to train on and with.
#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/scene/files/reader.hpp>

#include "commands/command.hpp"

namespace trocar::app {
namespace {

void print_lines(const char* heading, const Json& entries) {
  fmt::print("{}\n", heading);
  for (const Json& e : entries) fmt::print("  {:32} {}\n", e["name"].get<std::string>(), e["title"].get<std::string>());
}

int list(bool json) {
  const std::filesystem::path scenes = attempt::scenes_folder();
  Json result{{"scenes_folder", scenes.string()},
              {"exercises", Json::array()},
              {"scenes", Json::array()},
              {"instruments", Json::array()}};
  for (const attempt::ExerciseEntry& e : attempt::list_exercises(scenes))
    result["exercises"].push_back({{"name", e.name}, {"title", e.title}, {"path", e.path.string()}});
  for (const scene::SceneEntry& s : scene::list_scenes(scenes))
    result["scenes"].push_back({{"name", s.name}, {"title", s.title}, {"path", s.path.string()}});
  for (const scene::InstrumentEntry& i : scene::list_instruments(scenes / "instruments"))
    result["instruments"].push_back(
        {{"name", i.name}, {"title", i.title}, {"kind", i.kind}, {"path", i.path.string()}});
  if (json) {
    print(result);
  } else {
    print_lines("Exercises (trocar train NAME)", result["exercises"]);
    print_lines("Scenes (trocar train NAME: without a task)", result["scenes"]);
    print_lines("Instruments", result["instruments"]);
  }
  return core::kDone;
}

}  // namespace

void add_list(CLI::App& program, Chosen& chosen) {
  CLI::App* command =
      add_command(program, chosen, "list", "List exercises, scenes and instruments", "trocar list --json");
  command->callback([&chosen] { chosen.run = [&chosen] { return list(chosen.json); }; });
}

}  // namespace trocar::app
