// What the player writes under its picture: the step at that moment with its hint, and in a demonstration the goal and
// the skill that is performed.
//
//   const Captions captions(recording.result_json, lesson.monitor()->steps());
//   const Caption now = captions.at(tick);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/attempt/reel.hpp>

namespace trocar::attempt {

/// What a demonstration did from a tick on.
struct Doing {
  std::uint64_t tick = 0;
  std::string goal, skill;  ///< "show disc 1", "look at a mark"
};

struct Caption {
  std::string step, hint;  ///< empty: no step is open
  std::string doing;       ///< "show disc 1: look at a mark"; empty: nobody demonstrates
  friend bool operator==(const Caption&, const Caption&) = default;
};

class Captions {
 public:
  /// @param steps  of the exercise, for their hints; none in free practice
  Captions(const std::string& result_json, const training::Steps& steps);

  Caption at(std::uint64_t tick) const;
  bool empty() const { return m_found.steps.empty() && m_doings.empty(); }

 private:
  Findings m_found;
  std::vector<Doing> m_doings;
};

/// As SurgeonSource::describe() writes them; none where the result has none.
std::vector<Doing> doings_of_result(const std::string& result_json);

}  // namespace trocar::attempt
