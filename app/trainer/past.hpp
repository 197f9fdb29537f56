// What the start screen knows of earlier attempts: who was here, how it went. Read from the session store.
#pragma once

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
};

struct Past {
  std::vector<std::string> trainees;  ///< last first
  std::vector<PastAttempt> attempts;  ///< of the asked trainee, newest first
  std::vector<std::string> notices;   ///< what people should be told about the store
};

/// Never throws: what is wrong stands in the notices. @param store null: nothing is known  @param trainee empty: guests
Past read_past(const training::Store* store, const std::string& trainee);

}  // namespace trocar::app
