#include "start/catalogue.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include <trocar/core/letters.hpp>
#include <trocar/core/text.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::app {
namespace {

std::vector<std::string> names_of_groups() {
  std::vector<std::string> names(std::begin(training::kGroups), std::end(training::kGroups));
  names.insert(names.end() - 1, "");  // before free practice
  return names;
}

Group group_of(const std::string& name, const std::vector<attempt::ExerciseEntry>& exercises,
               const Standings& standings, const std::string& wanted) {
  Group group{name, title_of_group(name), {}};
  for (std::size_t i = 0; i < exercises.size(); ++i) {
    const attempt::ExerciseEntry& e = exercises[i];
    if (e.group != name || !matches(e, wanted)) continue;
    group.exercises.push_back(int(i));
    if (!e.task) continue;
    ++group.tasks;
    const auto standing = standings.find(e.name);
    group.passed += standing != standings.end() && standing->second.passed;
  }
  return group;
}

}  // namespace

std::vector<Group> groups_of(const std::vector<attempt::ExerciseEntry>& exercises, const Standings& standings,
                             const std::string& wanted) {
  std::vector<Group> groups;
  for (const std::string& name : names_of_groups())
    if (Group group = group_of(name, exercises, standings, wanted); !group.exercises.empty())
      groups.push_back(std::move(group));
  return groups;
}

int next_for(const std::vector<attempt::ExerciseEntry>& exercises, const Standings& standings) {
  for (const Group& group : groups_of(exercises, standings))
    for (const int i : group.exercises) {
      const auto standing = standings.find(exercises[std::size_t(i)].name);
      if (exercises[std::size_t(i)].task && (standing == standings.end() || !standing->second.passed)) return i;
    }
  return -1;
}

bool matches(const attempt::ExerciseEntry& e, const std::string& words) {
  const std::string text =
      core::in_small_letters(e.title + " " + e.summary + " " + title_of_group(e.group) + " " + e.name);
  std::istringstream each(core::in_small_letters(words));
  for (std::string word; each >> word;)
    if (text.find(word) == std::string::npos) return false;
  return true;
}

const char* title_of_group(const std::string& group) {
  if (group == "basics") return tr("Basics");
  if (group == "suturing") return tr("Suturing");
  if (group == "gynaecology") return tr("Gynaecology");
  if (group == "gallbladder") return tr("Gallbladder");
  if (group == "bowel") return tr("Bowel and appendix");
  if (group == "free practice") return tr("Free practice");
  return tr("Other exercises");
}

const char* title_of_level(int level) {
  return level <= 0 ? "" : level == 1 ? tr("Beginner") : level == 2 ? tr("Intermediate") : tr("Advanced");
}

std::string duration_text(double seconds) {
  const double minutes = std::max(1.0, std::round(seconds / 60));
  return minutes < 2 ? tr("about 1 minute") : tr("about {:.0f} minutes", minutes);
}

std::string title_of(const attempt::ExerciseEntry& e) { return e.title.empty() ? e.name : e.title; }

}  // namespace trocar::app
