#include <cstdlib>

#include <trocar/core/user_folder.hpp>

namespace trocar::core {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

fs::path user_folder() {
  if (const std::string given = environment("TROCAR_DATA"); !given.empty()) return given;
  if (const std::string data = environment("XDG_DATA_HOME"); !data.empty()) return fs::path(data) / "trocar";
  const std::string home = environment("HOME");
  return fs::path(home.empty() ? "." : home) / ".local/share/trocar";
}

}  // namespace trocar::core
