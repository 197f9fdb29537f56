// Files of JSON that people write, from the disk or from memory: core/json/json_reader.hpp, in which every value and
// every key knows its line and column.
//
//   std::vector<core::Fault> faults;
//   const JsonDocument document = load_json("scenes/tissues.json", faults);
//   if (!faults.empty()) throw core::BadInput(std::move(faults));
//   for (const JsonMember& m : document.root.members) ...
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <trocar/core/json/json_reader.hpp>

namespace trocar::scene {

using core::JsonDocument;
using core::JsonLimits;
using core::JsonMember;
using core::JsonValue;
using core::kMaxFaults;
using core::kMaxJsonDepth;
using core::kMaxJsonKeys;
using core::kMaxJsonValues;
using core::parse_json;
using core::shown;
using core::tell;

inline constexpr std::size_t kMaxJsonBytes = 16u << 20;

/// Texts that stand in for files, by path as given: lets tests feed readers without a disk, and editors read what is
/// not saved yet.
struct MemoryFiles : std::map<std::filesystem::path, std::string> {
  using map::map;
  bool over_disk = false;  ///< what is not here is read from the disk; paths are weakly canonical ones then

  const std::string* text_of(const std::filesystem::path& path) const;  ///< null where it is not here
  /// May files be read from the disk, too? `memory` may be null: then all are.
  static bool disk_too(const MemoryFiles* memory) { return !memory || memory->over_disk; }
};

/// One that cannot be read is a fault at line 0. With `memory` files are looked up there first.
JsonDocument load_json(const std::filesystem::path& path, std::vector<core::Fault>& faults,
                       const MemoryFiles* memory = nullptr, const JsonLimits& limits = {});

}  // namespace trocar::scene
