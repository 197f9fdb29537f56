// The order in which exercises are learned: groups, what comes next for a person, search, and the few words that a
// tile says. Nothing here draws.
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/paths.hpp>

#include "start/past.hpp"

namespace trocar::app {

struct Group {
  std::string name;            ///< one of training::kGroups; empty: exercises that name none
  std::string title;           ///< for people
  std::vector<int> exercises;  ///< indices into the list, in learning order
  int tasks = 0, passed = 0;   ///< exercises with a score; those that the person has passed
};

/// The groups that have an exercise, in the order of training::kGroups; those without a group before free practice.
/// @param wanted  only exercises that match these words; see matches()
std::vector<Group> groups_of(const std::vector<attempt::ExerciseEntry>& exercises, const Standings& standings,
                             const std::string& wanted = "");

/// The first exercise in learning order that has a score and was not passed; -1: there is none.
int next_for(const std::vector<attempt::ExerciseEntry>& exercises, const Standings& standings);

/// Every word is in the title, summary, group or name; capitals do not matter.
bool matches(const attempt::ExerciseEntry& exercise, const std::string& words);

const char* title_of_group(const std::string& group);
const char* title_of_level(int level);                         ///< "Beginner"; empty for bare scenes
std::string duration_text(double seconds);                     ///< "about 1 minute", "about 4 minutes"
std::string title_of(const attempt::ExerciseEntry& exercise);  ///< its name where it has no title

}  // namespace trocar::app
