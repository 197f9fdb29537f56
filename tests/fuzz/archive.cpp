#include "archive.hpp"

namespace trocar::fuzz {

scene::MemoryFiles unpacked(std::string_view archive) {
  scene::MemoryFiles files;
  std::string name = kMainFile, text;
  while (!archive.empty()) {
    const std::size_t end = archive.find('\n');
    const std::string_view line = archive.substr(0, end == archive.npos ? archive.size() : end + 1);
    archive.remove_prefix(line.size());
    if (line.substr(0, 4) != "=== ") {
      text += line;
      continue;
    }
    files.emplace(name, std::move(text));
    name = line.substr(4, line.size() - 4 - (line.back() == '\n'));
    text.clear();
  }
  files.emplace(name, std::move(text));
  return files;
}

std::string packed(const scene::MemoryFiles& files) {
  const auto main = files.find(kMainFile);
  std::string archive = main == files.end() ? "" : main->second;
  for (const auto& [name, text] : files) {
    if (name == kMainFile) continue;
    if (!archive.empty() && archive.back() != '\n') archive += '\n';
    archive += "=== " + name.generic_string() + '\n' + text;
  }
  return archive;
}

}  // namespace trocar::fuzz
