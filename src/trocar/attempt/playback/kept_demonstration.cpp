#include <fstream>
#include <vector>

#include <fmt/format.h>

#include <trocar/attempt/paths.hpp>
#include <trocar/attempt/playback/kept_demonstration.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/core/text.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/exercise/exercise_hash.hpp>

namespace trocar::attempt {

namespace fs = std::filesystem;

namespace {

/// The skills that perform it are part of the program, so another build may perform otherwise.
std::uint64_t program_hash() {
  static const std::uint64_t hash = [] {
    std::ifstream program("/proc/self/exe", std::ios::binary);
    core::Hasher hasher;
    std::vector<char> block(std::size_t(1) << 20);
    while (program.read(block.data(), std::streamsize(block.size())), program.gcount() > 0)
      hasher.add_bytes(block.data(), std::size_t(program.gcount()));
    return hasher.value();
  }();
  return hash;
}

/// Exercise and anatomy: "basics-camera-0-7-".
std::string stem(const Lesson& lesson) {
  std::string name;
  for (const char c : lesson.name)
    name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '-';
  constexpr std::size_t kMost = 80;
  if (name.size() > kMost) name = name.substr(name.size() - kMost);
  return fmt::format("{}-{}-", name, lesson.seed);
}

}  // namespace

std::uint64_t demonstration_key(const Lesson& lesson) {
  core::Hasher hasher;
  hasher.add(lesson.model.hash);
  hasher.add(lesson.seed);
  hasher.add(lesson.exercise ? training::hash_of(*lesson.exercise) : std::uint64_t(0));
  hasher.add(program_hash());
  return hasher.value();
}

fs::path demonstration_path(const Lesson& lesson) {
  return data_folder() / "demonstrations" / (stem(lesson) + core::hex(demonstration_key(lesson)) + ".rec");
}

std::optional<fs::path> kept_demonstration(const Lesson& lesson) {
  const fs::path file = demonstration_path(lesson);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  try {
    const sim::Recording recording = sim::read_recording(file.string());
    if (recording.complete && recording.header.model_hash == lesson.model.hash) return file;
  } catch (const std::exception&) {
    // damaged: it is recorded again
  }
  return std::nullopt;
}

void keep_demonstration(const Lesson& lesson, const fs::path& recorded) {
  const fs::path file = demonstration_path(lesson);
  std::error_code error;
  fs::rename(recorded, file, error);
  if (error) throw core::EnvironmentLacks(tr("cannot store the demonstration {}: {}", file.string(), error.message()));
  const std::string begins = stem(lesson);
  constexpr std::size_t kRest = 16 + 4;  // hash and ending
  for (const fs::directory_entry& other : fs::directory_iterator(file.parent_path(), error)) {
    const std::string name = other.path().filename().string();
    std::error_code ignored;
    const bool outdated = name.size() == begins.size() + kRest, left_over = name.ends_with(".part");
    if (other.path() != file && name.starts_with(begins) && (outdated || left_over)) fs::remove(other.path(), ignored);
  }
}

}  // namespace trocar::attempt
