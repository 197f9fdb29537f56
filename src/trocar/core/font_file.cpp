#include <filesystem>
#include <system_error>

#include <trocar/core/font_file.hpp>

namespace trocar::core {

std::string font_file(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {program / "../share/trocar/fonts", fs::path("/usr/share/fonts/truetype/dejavu"),
                                 fs::path("/usr/share/fonts/dejavu-sans-fonts"), fs::path("/usr/share/fonts/TTF"),
                                 fs::path("/usr/share/fonts/dejavu")})
    if (fs::is_regular_file(folder / name, error)) return (folder / name).string();
  return {};
}

}  // namespace trocar::core
