#include <system_error>

#include <trocar/core/files.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::scene {

const std::string* MemoryFiles::text_of(const std::filesystem::path& path) const {
  std::error_code error;
  const auto found = find(over_disk ? std::filesystem::weakly_canonical(path, error) : path);
  return found == end() ? nullptr : &found->second;
}

JsonDocument load_json(const std::filesystem::path& path, std::vector<core::Fault>& faults, const MemoryFiles* memory,
                       const JsonLimits& limits) {
  JsonDocument document{path.generic_string(), {}};
  document.root.kind = JsonValue::Kind::broken;
  if (const std::string* text = memory ? memory->text_of(path) : nullptr)
    return parse_json(*text, document.file, faults, limits);
  if (!MemoryFiles::disk_too(memory)) {
    tell(faults, {{document.file, 0, 0}, "expected a file, got none of this name"});
    return document;
  }
  try {
    return parse_json(core::read_file(path, kMaxJsonBytes), document.file, faults, limits);
  } catch (const core::BadInput& e) {
    tell(faults, e.faults().front());
    return document;
  }
}

}  // namespace trocar::scene
