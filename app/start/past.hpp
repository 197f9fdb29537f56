// What the start screen knows of earlier attempts: who was here, how it went. Read from the session store.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <trocar/training/store/store.hpp>

namespace trocar::app {

struct PastAttempt {
  std::int64_t number = 0;
  std::string exercise, title, mode, state, when;  ///< when: for people, local day and time
  std::optional<double> score;
  std::optional<bool> passed;
  double seconds = 0;
  std::string recording;  ///< path; empty: none
};

/// How far a person has come with one exercise.
struct Standing {
  std::optional<double> best, last;  ///< of 100 points, of attempts that count
  bool passed = false;               ///< at least once
  int attempts = 0;                  ///< that count
};
using Standings = std::map<std::string, Standing>;  ///< by the exercise's name

struct Past {
  std::vector<std::string> people;    ///< with attempts, last first; no demonstrations, no guest
  std::vector<PastAttempt> attempts;  ///< of the asked person, newest first
  Standings standings;                ///< of the same person
  std::vector<std::string> notices;   ///< what people should be told about the store
};

/// Never throws: what is wrong is in the notices. @param store null: nothing is known  @param person empty: nameless
Past read_past(const training::Store* store, const std::string& person);

/// Attempts that say something: those that somebody left after a few seconds are left out.
bool worth_listing(const PastAttempt& attempt);

/// "85 of 100, passed", "Free practice", "Ended early": for a list of results.
std::string result_of(const PastAttempt& attempt);

Standings standings_of(const std::vector<PastAttempt>& attempts);

/// The name under which the store keeps attempts without a name.
inline constexpr const char* kNameless = "guest";
/// Names that the store has for programs: nobody may take them.
bool is_reserved_name(const std::string& name);

}  // namespace trocar::app
