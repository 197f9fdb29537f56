// trocar list: what there is to train on and with.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/attempt/listing.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/shape.hpp>

#include "commands/command.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

struct ListChoice {
  std::string kind;
  bool names = false;
};

/// A kind of thing: its word on the command line and key in JSON, its heading, its folder below `scenes`.
struct ListedKind {
  const char *word, *heading, *folder;
};
constexpr ListedKind kListed[] = {
    {"exercises", "Exercises (trocar train NAME)", ""},
    {"scenes", "Scenes (trocar train NAME: without a task)", ""},
    {"instruments", "Instruments", "instruments"},
    {"mechanisms", "Mechanisms (trocar mechanism NAME)", "mechanisms"},
    {"rooms", "Operating rooms (trocar room NAME)", "rooms"},
    {"programmes", "Programmes of arms (trocar room ROOM programme NAME)", "rooms/programmes"},
    {"materials", "Materials (the key \"look\" of a body)", "looks"},
    {"vessels", "Vessel trees (the key \"vessels\" of a scene)", "vessels"},
    {"inputs", "Maps of devices and trackers (--map, --tracker)", "inputs"},
};

/// Exercises that can be begun; a fault of another one is printed.
Json exercises(const fs::path& scenes) {
  Json list = Json::array();
  for (const attempt::ExerciseEntry& e : attempt::list_exercises(scenes)) {
    const std::vector<core::Fault> faults = attempt::faults_of(e);
    for (const core::Fault& fault : faults)
      fmt::print(stderr, "{}\n", tr("not listed: {}: {}", e.name, core::to_string(fault)));
    if (faults.empty()) list.push_back({{"name", e.name}, {"title", e.title}, {"path", e.path.string()}});
  }
  return list;
}

Json scenes_in(const fs::path& scenes) {
  Json list = Json::array();
  for (const scene::SceneEntry& s : attempt::list_all_scenes(scenes))
    list.push_back({{"name", s.name}, {"title", s.title}, {"path", s.path.string()}});
  return list;
}

/// The files of a folder, the user's own before those of the program.
Json files_in(const char* folder) {
  Json list = Json::array();
  for (const std::string& name : scene::names_in_scenes(folder)) {
    const fs::path path = scene::named_in_scenes(name, folder).value_or(fs::path());
    std::vector<core::Fault> faults;
    const scene::JsonDocument document = scene::load_json(path, faults);
    for (const core::Fault& fault : faults)
      fmt::print(stderr, "{}\n", tr("not listed: {}: {}", name, core::to_string(fault)));
    if (!faults.empty()) continue;
    Json entry{{"name", name}, {"title", ""}, {"path", path.string()}};
    for (const char* key : {"title", "kind"})
      if (const scene::JsonMember* m = document.root.find(key)) entry[key] = core::printable(m->value.text);
    list.push_back(std::move(entry));
  }
  return list;
}

Json entries_of(const ListedKind& kind, const fs::path& scenes) {
  const std::string_view word = kind.word;
  if (word == "exercises") return exercises(scenes);
  if (word == "scenes") return scenes_in(scenes);
  return files_in(kind.folder);
}

void print_entries(const ListedKind& kind, const Json& entries) {
  fmt::print("{}\n", tr(kind.heading));
  for (const Json& e : entries) {
    const std::string title = e["title"].get<std::string>();
    fmt::print("{}\n", title.empty() ? fmt::format("  {}", e["name"].get<std::string>())
                                     : fmt::format("  {:32} {}", e["name"].get<std::string>(), title));
  }
}

void check_kind(const std::string& word) {
  std::vector<std::string> known;
  for (const ListedKind& kind : kListed) known.emplace_back(kind.word);
  if (!word.empty() && std::find(known.begin(), known.end(), word) == known.end())
    throw core::BadInput({{{"list", 0, 0}, scene::unknown_name("kind", word, known)}});
}

int list(const ListChoice& o, bool json) {
  check_kind(o.kind);
  const fs::path scenes = attempt::scenes_folder();
  Json result{{"scenes_folder", scenes.string()}, {"own_scenes_folder", scene::own_scenes_folder().string()}};
  for (const ListedKind& kind : kListed) {
    if (!o.kind.empty() && o.kind != kind.word) continue;
    result[kind.word] = entries_of(kind, scenes);
    if (json) continue;
    if (!o.names) print_entries(kind, result[kind.word]);
    for (const Json& e : result[kind.word])
      if (o.names) fmt::print("{}\n", e["name"].get<std::string>());
  }
  if (json) print(result);
  return core::kDone;
}

}  // namespace

void add_list(CLI::App& program, Chosen& chosen) {
  auto o = std::make_shared<ListChoice>();
  CLI::App* c = add_command(program, chosen, "list", tr("List exercises, scenes, instruments and what else there is"),
                            "trocar list\n  trocar list mechanisms\n  trocar list --json");
  c->add_option("kind", o->kind,
                tr("exercises, scenes, instruments, mechanisms, rooms, programmes, materials, vessels or inputs; "
                   "default: all"));
  c->add_flag("--names", o->names, tr("only names, one a line"));
  c->callback([o, &chosen] { chosen.run = [o, &chosen] { return list(*o, chosen.json); }; });
}

}  // namespace trocar::app
