// What an act would be worth if it were done now: shown beside the picture while somebody gets to know an exercise, so
// that a faulty clip is seen to be one before it is set. It is the exercise's own rules that are asked, of an event
// that has not happened.
//
//   Outlook outlook(exercise, model);
//   if (auto o = outlook.of(state, steps_done)) for (const auto& f : o->findings) say(f.text, f.fits);
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <trocar/training/exercise/rules.hpp>

namespace trocar::training {

struct Foretold {
  struct Finding {
    std::string text;  ///< "off the cross-section: 12 degrees (at most 15)"
    bool fits = false;
  };
  std::string on;  ///< what lies between the jaws, for people
  std::vector<Finding> findings;
  std::vector<std::string> codes;  ///< of the errors that it would be
  std::vector<int> steps;          ///< that it would complete
  bool good() const { return codes.empty(); }
};

class Outlook {
 public:
  /// Throws core::BadInput where the exercise does not fit the scene.
  Outlook(const Exercise& exercise, const sim::Model& model, std::uint64_t seed = 0);

  /// Of the first hand that is about to do something that can be foreseen. States may be skipped, but not go back.
  /// @param done  which steps are (missing ones are not)
  std::optional<Foretold> of(const sim::Model& model, const sim::State& state, std::span<const bool> done = {});

 private:
  Foretold foretell(const Snapshot& snapshot, int event, const EventInstance& h) const;

  std::unique_ptr<const Exercise> m_exercise;
  std::unique_ptr<Scoreboard> m_board;
  std::unique_ptr<Rules> m_rules;
};

}  // namespace trocar::training
