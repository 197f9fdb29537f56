// What an exercise comes to, as one number: all that its file says, with what it takes from other exercises and from
// files of common rules. Where a file has changed so that the exercise is judged or shown otherwise, so has this.
#pragma once

#include <cstdint>

#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

/// Layout and comments of the files do not count.
std::uint64_t hash_of(const Exercise& exercise);
/// The same of what an attempt is judged by: without the demonstration and its recorded choices.
std::uint64_t judgement_hash(const Exercise& exercise);

}  // namespace trocar::training
