#include <algorithm>
#include <iterator>
#include <optional>
#include <set>
#include <system_error>
#include <tuple>

#include <fmt/format.h>

#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/listing.hpp>
#include <trocar/attempt/paths.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/user_folder.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/scene/json/like.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::attempt {

namespace fs = std::filesystem;

namespace {

/// A file of an exercise, and below it those that it is like.
std::vector<scene::JsonDocument> layers_of(fs::path path) {
  constexpr std::size_t kMostLayers = 16;
  std::vector<scene::JsonDocument> layers;
  std::vector<core::Fault> ignored;  // opening the exercise reports them
  while (layers.size() < kMostLayers) {
    layers.push_back(scene::load_json(path, ignored));
    const scene::JsonMember* like = layers.back().root.find(scene::kLike);
    if (!like) break;
    path = scene::located((path.parent_path() / like->value.text).lexically_normal());
  }
  return layers;
}

const scene::JsonValue* said_in(const std::vector<scene::JsonDocument>& layers, const char* key) {
  for (const scene::JsonDocument& layer : layers)
    if (const scene::JsonMember* m = layer.root.find(key)) return &m->value;
  return nullptr;
}

std::string text_in(const std::vector<scene::JsonDocument>& layers, const char* key) {
  const scene::JsonValue* value = said_in(layers, key);
  return value ? core::printable(value->text) : "";
}

/// What is no number, or out of these bounds, is `otherwise`.
double number_in(const std::vector<scene::JsonDocument>& layers, const char* key, double most, double otherwise) {
  const scene::JsonValue* value = said_in(layers, key);
  const bool good = value && value->kind == scene::JsonValue::Kind::number && value->number >= 0;
  return good && value->number <= most ? value->number : otherwise;
}

ExerciseEntry entry_of(const std::string& name, const fs::path& path) {
  constexpr double kMostSeconds = 36000;
  const std::vector<scene::JsonDocument> layers = layers_of(path);
  ExerciseEntry entry{name, text_in(layers, "title"), path};
  if (const scene::JsonMember* scene = layers.front().root.find("scene"))
    entry.scene = scene::located((path.parent_path() / scene->value.text).lexically_normal());
  entry.order = int(number_in(layers, "order", entry.order, entry.order));
  entry.group = text_in(layers, "group");
  const auto known = std::find(std::begin(training::kGroups), std::end(training::kGroups), entry.group);
  if (known == std::end(training::kGroups)) entry.group.clear();
  entry.level = std::max(1, int(number_in(layers, "level", training::kMostLevel, 1)));
  entry.summary = text_in(layers, "summary");
  entry.expert_time = number_in(layers, "expert_s", kMostSeconds, 0);
  entry.longest_time = number_in(layers, "longest_s", kMostSeconds, 0);
  entry.pass_mark = number_in(layers, "pass_mark", 100, 0);
  entry.demonstrated = said_in(layers, "demonstration") != nullptr;
  return entry;
}

std::vector<ExerciseEntry> exercises_in(const fs::path& tree) {
  std::vector<ExerciseEntry> list;
  std::error_code error;
  for (const fs::directory_entry& folder : fs::directory_iterator(tree, error)) {
    std::error_code no_folder;
    for (const fs::directory_entry& file : fs::directory_iterator(folder.path(), no_folder))
      if (file.path().extension() == ".json" && is_exercise(file.path()))
        list.push_back(entry_of(folder.path().filename().string() + "/" + file.path().stem().string(), file.path()));
  }
  return list;
}

}  // namespace

fs::path scenes_folder() {
  std::error_code error;
  if (const std::string given = core::environment("TROCAR_SCENES"); !given.empty() && !fs::is_directory(given, error))
    throw core::EnvironmentLacks(
        tr("TROCAR_SCENES names '{}', which is not a folder. Correct it, or unset it.", given));
  if (const std::optional<fs::path> found = scene::found_scenes_folder()) return *found;
  throw core::EnvironmentLacks(tr("The program's folder of scenes was not found. Set TROCAR_SCENES to it."));
}

std::vector<ExerciseEntry> list_exercises(const fs::path& scenes) {
  std::vector<ExerciseEntry> list;
  std::set<std::string> names;
  for (const fs::path& tree : {scene::own_scenes_folder(), scenes})
    for (ExerciseEntry& entry : exercises_in(tree))
      if (names.insert(entry.name).second) list.push_back(std::move(entry));
  std::sort(list.begin(), list.end(), [](const ExerciseEntry& a, const ExerciseEntry& b) {
    return std::tie(a.order, a.name) < std::tie(b.order, b.name);
  });
  return list;
}

std::vector<scene::SceneEntry> list_all_scenes(const fs::path& scenes) {
  std::vector<scene::SceneEntry> list;
  std::set<std::string> names;
  for (const fs::path& tree : {scene::own_scenes_folder(), scenes})
    for (scene::SceneEntry& entry : scene::list_scenes(tree))
      if (names.insert(entry.name).second) list.push_back(std::move(entry));
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
  return list;
}

std::vector<core::Fault> faults_of(const ExerciseEntry& exercise) {
  std::vector<core::Fault> faults;
  const training::Exercise read = training::read_exercise(exercise.path, faults);
  std::error_code error;
  if (faults.empty() && !fs::is_regular_file(read.scene, error))
    faults.push_back({{exercise.path.string(), 0, 0},
                      tr("expected a scene, got {}, which is not a file", read.scene.generic_string())});
  return faults;
}

std::vector<ExerciseEntry> list_trainings(const fs::path& scenes) {
  std::vector<ExerciseEntry> list = list_exercises(scenes);
  const auto is_used = [&list](const fs::path& scene) {
    return std::any_of(list.begin(), list.end(),
                       [&](const ExerciseEntry& e) { return e.scene == scene.lexically_normal(); });
  };
  for (const scene::SceneEntry& s : list_all_scenes(scenes))
    if (!is_used(s.path)) {
      list.push_back({s.name, s.title, s.path, false});
      list.back().group = "free practice";
    }
  return list;
}

fs::path find_exercise(const std::string& name, const fs::path& scenes) {
  std::error_code error;
  if (fs::is_regular_file(name, error)) return name;
  for (const fs::path& tree : {scene::own_scenes_folder(), scenes})
    for (const fs::path& candidate : {tree / (name + ".json"), tree / name / "scene.json"})
      if (fs::is_regular_file(candidate, error)) return candidate;
  std::vector<std::string> known;
  for (const ExerciseEntry& e : list_exercises(scenes)) known.push_back(e.name);
  for (const scene::SceneEntry& s : list_all_scenes(scenes)) known.push_back(s.name);
  throw core::BadInput({{{name, 0, 0}, scene::unknown_name("file, exercise or scene", name, known)}});
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw core::EnvironmentLacks(tr("cannot create the folder {}: {}", folder.string(), error.message()));
}

fs::path data_folder() { return core::user_folder(); }

fs::path unused(const fs::path& path) {
  fs::path candidate = path;
  for (int i = 2; fs::exists(candidate); ++i) {
    candidate = path;
    candidate.replace_filename(fmt::format("{}-{}{}", path.stem().string(), i, path.extension().string()));
  }
  return candidate;
}

}  // namespace trocar::attempt
