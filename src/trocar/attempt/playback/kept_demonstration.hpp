// Demonstrations that have been recorded on this machine, each in a file named by what it depends on: the Model, the
// exercise with its rules, and the program. Where one of them has changed the name is another one, so that an outdated
// demonstration is never found.
//
//   const auto file = kept_demonstration(lesson);      // nothing: none has been recorded yet
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {

/// What a demonstration depends on, as one hash.
std::uint64_t demonstration_key(const Lesson& lesson);

/// Where the demonstration of this exercise with this anatomy is kept: in data_folder()/demonstrations.
std::filesystem::path demonstration_path(const Lesson& lesson);

/// The file, if it is there and whole.
std::optional<std::filesystem::path> kept_demonstration(const Lesson& lesson);

/// Gives a finished recording its final name, at once, and removes those of the same exercise and anatomy that are
/// outdated or were never finished.  @throws core::EnvironmentLacks
void keep_demonstration(const Lesson& lesson, const std::filesystem::path& recorded);

}  // namespace trocar::attempt
