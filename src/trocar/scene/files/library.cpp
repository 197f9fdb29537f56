#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <trocar/scene/files/library.hpp>

namespace trocar::scene {

namespace fs = std::filesystem;

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

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
  for (const fs::path& candidate :
       {program / "../../scenes", program / "../share/trocar/scenes", fs::path(TROCAR_SOURCE_DIR) / "scenes"})
    if (fs::is_directory(candidate, error)) return fs::weakly_canonical(candidate, error);
  return {};
}

}  // namespace

std::optional<fs::path> found_scenes_folder() {
  std::error_code error;
  if (const std::string given = environment("TROCAR_SCENES"); fs::is_directory(given, error)) return given;
  return programs_scenes_folder();
}

std::optional<fs::path> in_installed_scenes(const fs::path& name) {
  const std::optional<fs::path> scenes = found_scenes_folder();
  if (!scenes) return {};
  fs::path tail;
  bool within = false;
  for (const fs::path& step : name) {
    if (within) tail /= step;
    if (step == "scenes") within = true, tail.clear();
  }
  std::error_code error;
  const fs::path found = resolved(*scenes / tail);
  if (tail.empty() || !lies_in(found, resolved(*scenes)) || !fs::is_regular_file(found, error)) return {};
  return found;
}

std::optional<std::string> name_in_installed_scenes(const fs::path& file) {
  const std::optional<fs::path> scenes = found_scenes_folder();
  const fs::path whole = resolved(file), tree = scenes ? resolved(*scenes) : fs::path();
  if (tree.empty() || !lies_in(whole, tree)) return {};
  return (fs::path("scenes") / whole.lexically_relative(tree)).generic_string();
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
  return fmt::format("expected a file in {} or in a library of TROCAR_LIBRARY, got \"{}\"",
                     m_folders.front().generic_string(), name);
}

}  // namespace trocar::scene
