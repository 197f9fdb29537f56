#include <algorithm>
#include <set>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/core/user_folder.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

using core::environment;

fs::path resolved(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? fs::path() : found;
}

fs::path tree_of(const fs::path& file) {
  const fs::path folder = resolved(file).parent_path();
  for (fs::path above = folder; above.has_relative_path(); above = above.parent_path())
    if (above.filename() == "scenes") return above;
  return folder;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const auto [in_folder, in_file] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return in_folder == folder.end() && in_file != file.end();
}

/// Without regard to $TROCAR_SCENES.
std::optional<fs::path> programs_scenes_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  std::vector<fs::path> candidates{program / "../share/trocar/scenes", program / "../../scenes"};
  if (const fs::path source = TROCAR_SOURCE_DIR; !source.empty()) candidates.push_back(source / "scenes");
  candidates.insert(candidates.end(), {"/usr/local/share/trocar/scenes", "/usr/share/trocar/scenes"});
  for (const fs::path& candidate : candidates)
    if (fs::is_regular_file(candidate / "tissues.json", error)) return fs::weakly_canonical(candidate, error);
  return {};
}

/// `file` in the tree `from`, at the same place in the tree `to`; nothing where it does not lie in `from`.
std::optional<fs::path> same_place(const fs::path& file, const fs::path& from, const fs::path& to) {
  const fs::path whole = resolved(file);
  if (from.empty() || !lies_in(whole, from)) return {};
  return to / whole.lexically_relative(from);
}

}  // namespace

std::optional<fs::path> found_scenes_folder() {
  std::error_code error;
  if (const std::string given = environment("TROCAR_SCENES"); fs::is_directory(given, error)) return given;
  return programs_scenes_folder();
}

std::optional<std::string> name_in_installed_scenes(const fs::path& file) {
  const std::optional<fs::path> scenes = found_scenes_folder();
  const fs::path whole = resolved(file), tree = scenes ? resolved(*scenes) : fs::path();
  if (tree.empty() || !lies_in(whole, tree)) return {};
  return (fs::path("scenes") / whole.lexically_relative(tree)).generic_string();
}

fs::path located(const fs::path& file) {
  std::error_code error;
  if (fs::exists(file, error)) return file;
  const fs::path tree = tree_of(file);
  const std::optional<fs::path> scenes = found_scenes_folder();
  if (!scenes || tree.filename() != "scenes") return file;
  const std::optional<fs::path> there = same_place(file, tree, *scenes);
  return there && fs::exists(*there, error) ? *there : file;
}

fs::path own_scenes_folder() { return core::user_folder() / "scenes"; }

std::optional<fs::path> named_in_scenes(const std::string& name, const char* folder) {
  std::vector<fs::path> trees{own_scenes_folder()};
  if (const std::optional<fs::path> scenes = found_scenes_folder()) trees.push_back(*scenes);
  std::error_code error;
  for (const fs::path& tree : trees)
    if (const fs::path file = tree / folder / (name + ".json"); fs::is_regular_file(file, error)) return file;
  return {};
}

std::vector<std::string> names_in_scenes(const char* folder) {
  std::set<std::string> names;
  std::vector<fs::path> trees{own_scenes_folder()};
  if (const std::optional<fs::path> scenes = found_scenes_folder()) trees.push_back(*scenes);
  std::error_code error;
  for (const fs::path& tree : trees)
    for (const fs::directory_entry& entry : fs::directory_iterator(tree / folder, error))
      if (entry.path().extension() == ".json") names.insert(entry.path().stem().string());
  return {names.begin(), names.end()};
}

fs::path file_or_name(const std::string& given, const char* folder, const char* what) {
  std::error_code error;
  if (fs::exists(given, error)) return given;
  if (const std::optional<fs::path> named = named_in_scenes(given, folder)) return *named;
  if (given.find_first_of("/.") != std::string::npos) return given;  // its reader says that there is no such file
  throw core::BadInput({{{given, 0, 0}, unknown_name(what, given, names_in_scenes(folder))}});
}

Library::Library(const fs::path& first) : m_folders{tree_of(first)} {
  if (const std::optional<fs::path> scenes = found_scenes_folder()) m_folders.push_back(resolved(*scenes));
  const std::string declared = environment("TROCAR_LIBRARY");
  for (std::string_view rest = declared; !rest.empty();) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    if (end > 0) m_folders.push_back(resolved(rest.substr(0, end)));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

bool Library::holds(const fs::path& file) const {
  const fs::path whole = resolved(file);
  return std::any_of(m_folders.begin(), m_folders.end(),
                     [&](const fs::path& folder) { return !folder.empty() && lies_in(whole, folder); });
}

std::vector<fs::path> Library::folders(const char* name) const {
  std::vector<fs::path> folders;
  std::error_code error;
  std::vector<fs::path> trees = m_folders;
  if (const std::optional<fs::path> own = programs_scenes_folder()) trees.push_back(resolved(*own));
  for (const fs::path& tree : trees) {
    const bool again = std::find(folders.begin(), folders.end(), tree / name) != folders.end();
    if (!again && fs::is_directory(tree / name, error)) folders.push_back(tree / name);
  }
  return folders;
}

std::string Library::refusal(const std::string& name) const {
  return tr("expected a file in {} or in a library of TROCAR_LIBRARY, got \"{}\"", m_folders.front().generic_string(),
            name);
}

}  // namespace trocar::scene
