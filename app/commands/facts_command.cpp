// trocar facts: the facts and events of exercise files, and which of them a scene has.
#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/events/catalogue.hpp>
#include <trocar/training/exercise/exercise.hpp>

#include "commands/command.hpp"

namespace trocar::app {
namespace {

/// @param name  of a scene or of an exercise, whose scene is meant; or a file of either
sim::Model compiled(const std::string& name) {
  std::filesystem::path file = attempt::find_exercise(name, attempt::scenes_folder());
  if (attempt::is_exercise(file)) file = training::read_exercise(file).scene;
  return scene::compile(scene::read_scene(file));
}

std::string bounds(const Json& number) {
  if (!number.contains("from")) return {};
  return fmt::format(", {:g} to {:g}", number["from"].get<double>(), number["to"].get<double>());
}

void print_arguments(const Json& list) {
  for (const Json& a : list)
    fmt::print("      {:16} {}{}: {}{}\n", a["name"].get<std::string>(), a["type"].get<std::string>(), bounds(a),
               tr(a["meaning"].get_ref<const std::string&>().c_str()), a.contains("optional") ? tr(" (optional)") : "");
}

void print_kinds(const char* heading, const Json& kinds) {
  fmt::print("{}\n", heading);
  for (const Json& k : kinds) {
    fmt::print(
        "  {:24} {}{}{}\n", k["name"].get<std::string>(),
        k.contains("type") ? "[" + k["type"].get<std::string>() + bounds(k) + "] " : std::string(),
        tr(k["meaning"].get_ref<const std::string&>().c_str()),
        k.contains("lacks") ? tr(" (not in this scene: it needs {})", k["lacks"].get<std::string>()) : std::string());
    print_arguments(k["arguments"]);
    if (k.contains("attributes")) print_arguments(k["attributes"]);
  }
}

void print_names(const Json& names) {
  for (const auto& [kind, list] : names.items()) {
    std::string all;
    for (const Json& name : list) all += (all.empty() ? "" : ", ") + name.get<std::string>();
    fmt::print("{:8} {}\n", kind, all.empty() ? "none" : all);
  }
}

int show_facts(const std::string& scene, bool json) {
  Json result;
  if (scene.empty()) {
    result = training::catalogue();
  } else {
    const sim::Model model = compiled(scene);
    result = training::catalogue(&model);
  }
  if (json) {
    print(result);
    return core::kDone;
  }
  print_kinds("Facts", result["facts"]);
  print_kinds("Events", result["events"]);
  if (result.contains("names")) print_names(result["names"]);
  return core::kDone;
}

}  // namespace

void add_facts(CLI::App& program, Chosen& chosen) {
  CLI::App* command =
      add_command(program, chosen, "facts", tr("List the facts and events that an exercise file can use"),
                  "trocar facts gynaecology");
  auto scene = std::make_shared<std::string>();
  command->add_option("scene", *scene,
                      tr("a scene or an exercise: its names, and which facts and events it has; default: all"));
  command->callback([&chosen, scene] { chosen.run = [&chosen, scene] { return show_facts(*scene, chosen.json); }; });
}

}  // namespace trocar::app
