#include "commands/checks/check_exercise.hpp"

#include <chrono>
#include <optional>
#include <set>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/demonstration.hpp>

#include "commands/checks/check_scene.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

/// The scene, where it can be read; its own faults are appended.
std::optional<sim::Model> scene_of(const training::Exercise& exercise, training::Faults& faults) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(exercise.scene, error)) {
    faults.push_back({{exercise.file.string(), 0, 0},
                      tr("expected a scene, got \"{}\", which is not a file", exercise.scene.string())});
    return std::nullopt;
  }
  try {
    return scene::compile(scene::read_scene(exercise.scene));
  } catch (const core::BadInput& bad) {
    faults.insert(faults.end(), bad.faults().begin(), bad.faults().end());
    return std::nullopt;
  }
}

/// What judging takes of a tick in which nothing happens, on this machine and one core [s].
double judged_tick(const training::Exercise& exercise, const sim::Model& model) {
  constexpr int kTicks = 4000;
  training::Monitor monitor(exercise, model);
  sim::State state = sim::initial_state(model);
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < kTicks; ++i) {
    ++state.tick;
    monitor.update(model, state, {});
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / kTicks;
}

Json describe(const training::Exercise& e, const sim::Model& model) {
  const training::Monitor monitor(e, model);
  Json out{{"exercise", e.name},     {"title", e.title},        {"scene", e.scene.string()},
           {"steps", Json::array()}, {"errors", Json::array()}, {"limits", Json::array()},
           {"facts", Json::array()}, {"events", Json::array()}, {"later", e.later.size()}};
  for (const training::StepStatus& s : monitor.steps()) {
    Json step{{"step", s.task}, {"name", s.name}};
    if (!s.side.empty()) step["of"] = s.side;
    if (s.optional) step["optional"] = true;
    out["steps"].push_back(std::move(step));
  }
  for (const training::Penalty& p : e.penalties)
    out["errors"].push_back({{"code", p.code}, {"name", p.name}, {"points", p.points}, {"fails", p.fail}});
  for (const training::Limit& l : e.limits)
    out["limits"].push_back({{"name", l.name}, {"value", l.shown()}, {"source", l.source}});
  const auto count = [](Json& list, std::string_view name) {
    for (Json& known : list)
      if (known["name"] == name) return void(known["watched"] = known["watched"].get<int>() + 1);
    list.push_back({{"name", name}, {"watched", 1}});
  };
  for (const auto& w : monitor.rules().facts().all()) count(out["facts"], w.fact->name);
  for (const auto& w : monitor.rules().events().all()) count(out["events"], w.event->name);
  out["demonstrated"] = !e.demonstration.file.empty();
  out["judged_tick_us"] = 1e6 * judged_tick(e, model);
  return out;
}

void print_names(const char* what, const Json& list, const char* key) {
  std::string line;
  for (const Json& item : list) {
    std::string word = item[key].get<std::string>();
    if (const int n = item.value("watched", 1); n > 1) word += fmt::format(" x{}", n);
    line += (line.empty() ? "" : ", ") + word;
  }
  fmt::print("  {} ({}): {}\n", what, list.size(), line);
}

}  // namespace

Json describe_exercise(const std::filesystem::path& path) {
  training::Faults faults;
  const training::Exercise exercise = training::read_exercise(path, faults);
  // A file without a scene to look into has nothing more to tell.
  const bool named = !exercise.scene.empty() && exercise.scene != path.parent_path() / "";
  const std::optional<sim::Model> model = named ? scene_of(exercise, faults) : std::nullopt;
  if (model) training::check_in_scene(exercise, *model, faults);
  if (faults.empty()) training::check_demonstration(exercise, model ? &*model : nullptr, faults);
  if (!faults.empty() || !model) throw core::BadInput(std::move(faults));
  return describe(exercise, *model);
}

bool is_rules_file(const scene::JsonValue& root) {
  const auto has = [&](const char* key) { return root.find(key) != nullptr; };
  if (!has("title") || has("name") || has("scene")) return false;
  return has("errors") || has("steps") || has("limits") || has("sets");
}

Json describe_rules(const fs::path& path) {
  Json out{{"file", path.string()}, {"kind", "rules"}, {"taken_by", Json::array()}};
  training::Faults faults;
  std::set<std::string> told;
  for (const attempt::ExerciseEntry& e : attempt::list_exercises(attempt::scenes_folder())) {
    if (!lists_file(e.path, "includes", path)) continue;
    out["taken_by"].push_back({{"name", e.name}});
    training::Faults all;
    training::read_exercise(e.path, all);
    for (core::Fault& fault : all) {
      std::error_code error;
      if (!fs::equivalent(fault.at.file, path, error)) continue;
      fault.at.file = path.string();
      if (told.insert(core::to_string(fault)).second) faults.push_back(std::move(fault));
    }
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  if (out["taken_by"].empty()) out["verdict"] = "not looked into";
  return out;
}

void print_rules(const Json& r) {
  if (r["taken_by"].empty()) fmt::print("  {}\n", tr("No exercise includes these rules. Only their JSON was checked."));
  if (!r["taken_by"].empty()) print_names(tr("exercises include them"), r["taken_by"], "name");
}

void print_exercise(const Json& r) {
  print_names("steps", r["steps"], "name");
  print_names("errors", r["errors"], "code");
  print_names("limits", r["limits"], "name");
  print_names("facts", r["facts"], "name");
  print_names("events", r["events"], "name");
  fmt::print("  {}\n", r["demonstrated"].get<bool>() ? tr("It has a demonstration.") : tr("It has no demonstration."));
  fmt::print("  {}\n", tr("The judge takes {:.1f} us of each tick (1000 us) on this machine.",
                          r["judged_tick_us"].get<double>()));
}

}  // namespace trocar::app
