// Judges an attempt by an exercise's steps and errors, as its file says them. Reads State only, at fixed ticks; does
// not allocate while nothing happens.
//
// In every tick:
//   1. facts whose memory events change are brought up to date
//   2. for everything that happened, kind by kind in the order in which the file first names them:
//      errors in the order of the file (common rules first); then steps that it completes; then steps that it closes
// Fifty times a second, after that:
//   3. facts with a memory, and events that are noticed by watching (as in 2)
//   4. errors of conditions, in the order of the file
//   5. steps of conditions, in the order in which they are shown: done, else closed, else opened again
//   6. details of the result
#pragma once

#include <array>

#include <nlohmann/json_fwd.hpp>

#include <trocar/training/exercise/details.hpp>
#include <trocar/training/exercise/guide.hpp>
#include <trocar/training/exercise/scoreboard.hpp>
#include <trocar/training/rules/act.hpp>

namespace trocar::training {

/// How long a condition has held without a break.
struct Latch {
  double needs = 0, held = 0;  ///< [s]
  /// @return it has held long enough, now
  bool update(bool holds, double dt) {
    constexpr double kRounding = 1e-9;  // [s] in sums of samples
    held = holds ? held + dt : 0;
    return holds && held >= needs - kRounding;
  }
};

struct StepRule {
  int step = -1;           ///< on the board
  std::vector<int> after;  ///< that must be closed before
  std::vector<int> needs;  ///< that must be done before
  Condition when, missed_when, undone_when;
  Latch done_for, missed_for, undone_for;
  Act on, missed_on;
};

struct ErrorRule {
  const Penalty* penalty = nullptr;
  std::string side;  ///< element of its set; empty: none
  Act on;
  Condition when;
  Latch held;
  bool once = false;  ///< an attempt
  bool told = false;  ///< in this excursion; with `once`, ever
  int mark = -1;      ///< where it is shown
  std::string detail;
  std::vector<int> misses;
};

class Rules {
 public:
  /// Adds the exercise's steps to the board. @param exercise, board  outlive the rules  @param model  null: only checks
  /// what can be reported without a scene  @param faults  gets all that is wrong; with any of them the rules are of no
  /// use
  Rules(const Exercise& exercise, const sim::Model* model, std::uint64_t seed, Scoreboard& board, Faults& faults);
  Rules(const Rules&) = delete;
  Rules& operator=(const Rules&) = delete;

  void tick(const Snapshot& snapshot, const sim::StepReport& report);
  /// @param dt  since the last time [s]
  void sample(const Snapshot& snapshot, double dt);

  /// Brings facts whose memory events change up to date, and judges nothing.
  void look_at(const Snapshot& snapshot) { m_facts.tick(snapshot, {}); }

  /// Number of the step to be shown next; the number of steps when none is left.
  int current() const { return m_guide.current(*this, m_board); }
  /// Do the steps that it comes after or needs let it count?
  bool allowed(int step) const;
  void tell(nlohmann::ordered_json& result) const { m_details.tell(result); }

  const Names& names() const { return m_names; }
  const std::vector<StepRule>& steps() const { return m_steps; }
  const std::vector<ErrorRule>& errors() const { return m_errors; }
  const FactWatches& facts() const { return m_facts; }
  const EventWatches& events() const { return m_events; }
  const Scoreboard& board() const { return m_board; }

 private:
  friend class RulesReader;
  void happened(int event, const EventInstance& h, const Snapshot& snapshot);
  void note_holds(const Snapshot& snapshot);
  const std::string& side_of(const EventInstance& h, const EventKind& kind, const Snapshot& snapshot) const;
  void make(ErrorRule& rule, const std::string& side, Vec3d where, std::string detail);
  void watch_errors(const Snapshot& snapshot, double dt);
  void watch_steps(const Snapshot& snapshot, double dt);
  void miss(const std::vector<int>& steps);

  const Exercise& m_exercise;
  Scoreboard& m_board;
  Names m_names;
  FactWatches m_facts;
  EventWatches m_events;
  std::vector<StepRule> m_steps;  ///< as on the board
  std::vector<ErrorRule> m_errors;
  Guide m_guide;
  Details m_details;
  std::array<const std::string*, sim::kMaxTools> m_held_side{};  ///< of what each hand holds or held last
};

}  // namespace trocar::training
