// Watches an attempt: what the hands do, whatever the exercise, and through the judge of its kind which steps are done,
// which errors were made, and the score with every component shown. Reads State only, at fixed ticks, so that a replay
// gives the same result; does not allocate while nothing goes wrong.
//
//   Monitor monitor(exercise, model);
//   ... monitor.update(model, state, report);   // after every tick
//   std::puts(monitor.result_json().c_str());
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <trocar/training/exercise/bleeding_judge.hpp>
#include <trocar/training/exercise/sterilisation_judge.hpp>
#include <trocar/training/exercise/watches.hpp>

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
  /// Throws core::BadInput naming all that the scene lacks (strands, organs, instruments, landmarks).
  Monitor(const Exercise& exercise, const sim::Model& model, Mode mode = Mode::assessed);

  /// After every tick.
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report);

  const std::vector<StepStatus>& steps() const { return m_board.steps(); }
  const std::vector<ErrorMade>& errors() const { return m_board.errors(); }
  const std::vector<ToolMetrics>& tools() const { return m_tools; }
  /// Number of the step to be done next; steps().size() when none is left.
  int current() const { return m_judge->current(); }
  bool finished() const { return m_board.finished(); }  ///< every step is done or missed
  double seconds() const { return m_seconds; }          ///< since the first motion of an instrument
  Score score() const { return m_board.score(m_seconds); }
  /// Who judges, by the kind of exercise; null: it is of another kind.
  const SterilisationJudge* sterilisation() const { return m_sterilisation; }
  const BleedingJudge* bleeding() const { return m_bleeding; }

  /// One JSON object: everything above, and the thresholds used.
  std::string result_json() const;

 private:
  void watch_hands(const sim::Model& model, const sim::State& state, const sim::StepReport& report);
  void weigh_on_trocars(const sim::Model& model, const sim::State& state);
  void measure(const sim::Model& model, const sim::State& state);

  std::unique_ptr<const Exercise> m_exercise;  ///< where it is, judge and board look at it
  std::unique_ptr<Scoreboard> m_scoreboard;
  Scoreboard& m_board;
  std::unique_ptr<Judge> m_judge;
  const SterilisationJudge* m_sterilisation = nullptr;
  const BleedingJudge* m_bleeding = nullptr;
  std::vector<ToolMetrics> m_tools;
  Tissues m_tissues;
  PullWatch m_pull;
  TearWatch m_tear;
  PinchWatch m_pinch;
  SightWatch m_sight;
  CollisionWatch m_collision;
  struct TrocarMean {
    double on_wall = 0, by_hand = 0;  ///< [N]
  };
  std::array<TrocarMean, sim::kMaxTools> m_trocar{};
  std::array<Vec3d, sim::kMaxTools> m_tip{};
  std::array<std::string, sim::kMaxTools> m_held_side;  ///< of what each hand holds or held last
  std::uint64_t m_first_motion = 0;
  bool m_moved = false;
  double m_seconds = 0;
};

}  // namespace trocar::training
