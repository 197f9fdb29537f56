#include <algorithm>
#include <cctype>
#include <utility>

#include <trocar/core/error.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;
constexpr const char* kPlaceName = "scenes/modelling/place.json";  // found wherever the program is installed

using Renames = std::vector<std::pair<std::string, JsonValue>>;

void rename(const JsonValue& name, const std::string& path, const fs::path& from, const fs::path& to, Renames& out) {
  if (name.kind != JsonValue::Kind::string) return;
  const fs::path file = scene::located(whole_path(from / name.text));
  std::error_code error;
  const bool from_outside = !scene::name_in_installed_scenes(to / "any.json");
  if (const std::optional<std::string> installed = scene::name_in_installed_scenes(file); installed && from_outside) {
    out.emplace_back(path, scene::json_text(*installed));
    return;
  }
  const fs::path relative = fs::relative(file, whole_path(to), error);
  if (!error && !relative.empty()) out.emplace_back(path, scene::json_text(relative.generic_string()));
}

void rename_under(const JsonValue& value, const std::string& path, const fs::path& from, const fs::path& to,
                  Renames& out) {
  for (const scene::JsonMember& m : value.members) {
    const std::string at = scene::json_path(path, m.key);
    if (names_files(m.key) || m.key == "file" || m.key == "$schema") {
      rename(m.value, at, from, to, out);
      for (std::size_t i = 0; i < m.value.items.size(); ++i)
        rename(m.value.items[i], scene::json_path(at, i), from, to, out);
    }
    rename_under(m.value, at, from, to, out);
  }
  for (std::size_t i = 0; i < value.items.size(); ++i)
    rename_under(value.items[i], scene::json_path(path, i), from, to, out);
}

std::string named(const std::string& text) {
  std::string out = scene::to_text(scene::json_text(text));
  out.pop_back();
  return out;
}

}  // namespace

fs::path named_file(const Document& document, const fs::path& folder, const std::string& name) {
  const fs::path near = whole_path(folder / name);
  return document.holds(near) ? near : whole_path(scene::located(near));
}

bool names_files(std::string_view key) {
  static constexpr const char* keys[] = {"tissues", "organs", "instruments", "vessels", "like"};
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* k) { return key == k; });
}

fs::path modelling_place() {
  const std::optional<fs::path> scenes = scene::found_scenes_folder();
  const fs::path place = scenes ? *scenes / "modelling" / "place.json" : fs::path("scenes/modelling/place.json");
  std::error_code error;
  if (!fs::is_regular_file(place, error))
    throw core::BadInput({{{place.generic_string(), 0, 0}, "expected the modelling place, got no such file"}});
  return whole_path(place);
}

std::string text_of_place_with(const std::string& organ_file, const std::string& title) {
  JsonValue text = scene::json_object();
  scene::put(text, "format", scene::json_number(1));
  scene::put(text, "name", scene::json_text("modelling"));
  scene::put(text, "title", scene::json_text(title));
  scene::put(text, "like", scene::json_text(kPlaceName));
  scene::put(text, "organs", scene::json_array({scene::json_text(organ_file)}));
  return scene::to_text(text);
}

fs::path at_home(const Document& document, scene::MemoryFiles& memory) {
  const scene::FileKind kind = scene::kind_of_file(document.root(), &memory);
  if (kind == scene::FileKind::scene) return document.root();
  if (kind != scene::FileKind::organ)
    throw core::BadInput(
        {{{document.root().generic_string(), 1, 1}, "expected a scene or an organ, got a file of another kind"}});
  const fs::path folder = document.root().parent_path();
  const fs::path place = folder / ".modelling-place.json";
  memory[place] = text_of_place_with(document.root().filename().generic_string(), document.root().stem().string());
  return place;
}

Document begun(const fs::path& file, bool organ, const std::string& wanted) {
  std::string name = wanted.empty() ? "mine" : wanted.substr(0, 64);  // as files name things
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  std::string text = "{\n  \"format\": 1,\n  \"name\": " + named(name);
  if (organ) return Document::fresh(file, text + ",\n  \"solids\": []\n}\n");
  text += ",\n  \"title\": " + named(wanted.empty() ? name : wanted) + ",\n  \"like\": " + named(kPlaceName) +
          ",\n  \"organs\": [\n    {\n      \"solids\": []\n    }\n  ]\n}\n";
  return Document::fresh(file, text);
}

std::string renamed_from(const std::string& text, const JsonValue& root, const fs::path& from, const fs::path& to) {
  Renames renames;
  rename_under(root, "", from, to, renames);
  return scene::json_set_all(text, std::move(renames));
}

JsonValue renamed_value(const std::string& key, const JsonValue& value, const fs::path& from, const fs::path& to) {
  JsonValue one = scene::json_object();
  scene::put(one, key, value);
  std::vector<core::Fault> ignored;
  return scene::parse_json(renamed_from(scene::to_text(one), one, from, to), "", ignored).root.members.at(0).value;
}

}  // namespace trocar::modeller
