// Watches an attempt: which steps are done and which errors were made, by the exercise's rules, how the hands moved,
// and the score with every component shown. Reads State only, at fixed ticks, so that a replay gives the same result;
// does not allocate while nothing goes wrong.
//
//   Monitor monitor(exercise, model);
//   ... monitor.update(model, state, report);   // after every tick
//   std::puts(monitor.result_json().c_str());
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/rules.hpp>
#include <trocar/training/exercise/scoreboard.hpp>

namespace trocar::training {

struct ToolMetrics {
  std::string name;        ///< of the hand
  double path = 0;         ///< of the tip [m]
  double max_pull = 0;     ///< [N]
  double max_on_wall = 0;  ///< what the abdominal wall bore at the trocar, mean over about 50 ms [N]
  double max_by_hand = 0;  ///< what the hand applied at the handle, likewise [N]
};

class Monitor {
 public:
  /// Throws core::BadInput naming all that the scene lacks. @param seed  of the anatomy: draws sets "by_seed"
  Monitor(const Exercise& exercise, const sim::Model& model, Mode mode = Mode::assessed, std::uint64_t seed = 0);

  /// After every tick.
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report);

  const std::vector<StepStatus>& steps() const { return m_board->steps(); }
  const std::vector<ErrorMade>& errors() const { return m_board->errors(); }
  const std::vector<ToolMetrics>& tools() const { return m_tools; }
  /// Number of the step to be done next; steps().size() when none is left.
  int current() const { return m_rules->current(); }
  bool finished() const { return m_board->finished(); }  ///< every step is done or missed
  double seconds() const {
    return m_seconds;
  }  ///< since the first motion of an instrument, or of the lens where there is none
  /// Share of the time since the first motion in which the conditions of the step to be done held; NaN: nothing was
  /// watched. Only where there is nothing to control but the endoscope.
  double on_target_share() const;
  Score score() const { return m_board->score(m_seconds); }
  const Rules& rules() const { return *m_rules; }
  const Scoreboard& board() const { return *m_board; }

  /// One JSON object: everything above, and the limits used.
  std::string result_json() const;

 private:
  void weigh_on_trocars(const sim::Model& model, const sim::State& state);
  void measure(const sim::Model& model, const sim::State& state);
  void watch_target(const Snapshot& snapshot);

  std::unique_ptr<const Exercise> m_exercise;  ///< where it is, rules and board look at it
  std::unique_ptr<Scoreboard> m_board;
  std::unique_ptr<Rules> m_rules;
  std::string m_anatomy, m_anatomy_title;  ///< the variant of this patient; empty: the scene has none
  std::vector<ToolMetrics> m_tools;
  struct TrocarMean {
    double on_wall = 0, by_hand = 0;  ///< [N]
  };
  std::array<TrocarMean, sim::kMaxTools> m_trocar{};
  std::array<Vec3d, sim::kMaxTools> m_tip{};
  Vec3d m_lens;
  std::uint64_t m_watched = 0, m_on_target = 0;  ///< samples
  std::uint64_t m_first_motion = 0;
  bool m_moved = false;
  double m_seconds = 0;
};

}  // namespace trocar::training
