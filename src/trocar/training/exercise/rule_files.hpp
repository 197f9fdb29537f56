// Reads what exercise files and files of common rules have alike: limits, sets, errors. A file that is read after
// another may make its limits and errors stricter; what would loosen them is a fault.
#pragma once

#include <vector>

#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {

class RuleFiles {
 public:
  RuleFiles(Exercise& exercise, Faults& faults) : m_exercise(exercise), m_faults(faults) {}

  /// Who says what: one file, or an exercise and those that it is like.
  struct Said {
    std::vector<const scene::JsonObject*> limits;  ///< each limit is as the first that names it has it
    const scene::JsonObject& sets;
    const scene::JsonObject& errors;
  };
  /// @param own  the exercise's, after all common ones
  void read(const Said& by, bool own);

 private:
  void limits(const std::vector<const scene::JsonObject*>& files, bool own);
  void limit(const scene::JsonMember& member, const std::string& path, bool own);
  void sets(const scene::JsonObject& file, const std::string& path);
  void errors(const scene::JsonObject& file, const std::string& path, bool own);
  void make_stricter(Penalty& common, const scene::JsonObject& error, const std::string& path);

  Exercise& m_exercise;
  Faults& m_faults;
  std::size_t m_common_limits = 0, m_common_errors = 0;
};

}  // namespace trocar::training
