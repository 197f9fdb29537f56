// Watches an attempt: which steps are done, which errors were made, and the score with every component shown. Reads
// State only, at fixed ticks, so that a replay gives the same result; does not allocate while nothing goes wrong.
//
//   Monitor monitor(exercise, model);
//   ... monitor.update(model, state, report);   // after every tick
//   std::puts(monitor.result_json().c_str());
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/sim/step.hpp>
#include <trocar/training/exercise.hpp>
#include <trocar/training/following.hpp>
#include <trocar/training/lumen_check.hpp>
#include <trocar/training/watches.hpp>

namespace trocar::training {

struct StepStatus {
  std::string name, hint;
  std::string task;  ///< "survey", "identify" ...
  std::string side;  ///< "left", "right"; empty for what belongs to both
  bool done = false;
  bool missed = false;  ///< can no longer be done
  double at = 0;        ///< when it was done or missed [s]
};

struct ErrorMade {
  std::string code, name, meaning, hint, detail, side;
  double points = 0;
  bool fail = false;
  double at = 0;  ///< when [s]
  Vec3d where;    ///< [m]
};

struct Score {
  double total = 0, quality = 0, time = 0;  ///< total 0..100, components 0..1
  double penalties = 0;
  bool scored = true;   ///< false: familiarisation, nothing here counts
  bool failed = false;  ///< by an error that fails the attempt
  bool passed = false;
};

struct ToolMetrics {
  std::string name;        ///< of the hand
  double path = 0;         ///< of the tip [m]
  double max_pull = 0;     ///< [N]
  double max_on_wall = 0;  ///< what the abdominal wall bore at the trocar, mean over about 50 ms [N]
  double max_by_hand = 0;  ///< what the hand applied at the handle, likewise [N]
};

/// What is known of one side; for results and for whoever shows them.
struct SideFacts {
  struct Clip {
    double s = 0, theta = 0, cover = 0, closing = 0;  ///< [m] [rad] - [s]
    int tips_visible = 0;
    bool counts = false;  ///< rightly set in a place of a clip: a pair may be made with it
    bool good = false;    ///< made no error
    double at = 0;        ///< when [s]
  };
  struct Cut {
    double s = 0, fraction = 0, beyond = 0;  ///< [m] - [m]
    bool good = false;
    double at = 0;
  };
  std::array<Clip, interactions::kMaxClips> clips{};
  std::array<Cut, interactions::kMaxCuts> cuts{};
  int clip_count = 0, cut_count = 0;
  std::array<double, 2> pair{-1, -1};              ///< where the first and the second clip are [m], below 0: not yet
  double straightness = 0, best_straightness = 0;  ///< of the isthmus: now, and the best while presented
  Range pull{0, 0};                                ///< on this tube while held; both 0: never held
  bool held = false;
};

enum class Mode { assessed, familiarisation };

class Monitor {
 public:
  /// Throws core::BadInput naming all that the scene lacks (strands, organs, instruments, landmarks).
  Monitor(const Exercise& exercise, const sim::Model& model, Mode mode = Mode::assessed);

  /// After every tick.
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report);

  const std::vector<StepStatus>& steps() const { return m_steps; }
  const std::vector<ErrorMade>& errors() const { return m_errors; }
  const std::vector<ToolMetrics>& tools() const { return m_tools; }
  /// Number of the step to be done next, on the side that is being worked on; steps().size() when none is left.
  int current() const;
  bool finished() const;                        ///< every step is done or missed
  double seconds() const { return m_seconds; }  ///< since the first motion of an instrument
  const SideFacts& facts(int side) const { return m_sides[size_t(side)].facts; }
  bool occluded(int side) const { return m_sides[size_t(side)].lumen.occluded(); }
  bool occluded() const;  ///< no way through any of the tubes
  Score score() const;

  /// One JSON object: everything above, and the thresholds used.
  std::string result_json() const;

 private:
  /// A side as indices, and how far it has come.
  struct SideWatch {
    int tube = -1, mesosalpinx = -1;  ///< strand; membrane, or -1
    int ovary_target = -1, trace_target = -1;
    double isthmus = 0, ampulla = 0;  ///< where each ends [m]
    Following following;
    LumenCheck lumen;
    SideFacts facts;
    bool blamed = false;  ///< not identified: once a side
    bool severed = false;
  };

  void measure(const sim::Model& model, const sim::State& state);
  void measure_side(SideWatch& side, const sim::Model& model, const sim::State& state);
  void watch_steps(const sim::Model& model, const sim::State& state);
  void watch_errors(const sim::Model& model, const sim::State& state, const sim::StepReport& report);
  void judge_clip(const sim::Model& model, const sim::State& state, const interactions::Clip& clip);
  void place_clip(SideWatch& side, int index, double s, Vec3d where);
  void judge_cut(const sim::Model& model, const sim::State& state, const interactions::Cut& cut);
  void touch_side(SideWatch& side, Vec3d where);
  void make_error(const char* code, int side, Vec3d where, std::string detail = {});
  bool presented(const SideWatch& side, const sim::Model& model, const sim::State& state) const;
  StepStatus& step(int side, Task task) { return m_steps[size_t(step_index(side, task))]; }
  int step_index(int side, Task task) const { return task == Task::survey ? 0 : side * (kTasks - 1) + int(task); }
  int side_of(int tube) const;
  int side_of_fold(int membrane) const;
  int side_of_hold(std::int32_t body) const;  ///< of a tube or its mesosalpinx; -1 for what belongs to no side
  void judge_snip(const sim::Model& model, const sim::State& state, const interactions::Cut& cut);
  /// Does this hand hold the side's tube beyond the isthmus, or its mesosalpinx?
  bool holds(const SideWatch& side, const sim::Model& model, const sim::State& state, size_t hand) const;
  void done(int side, Task task);
  void missed(int side, Task task);
  /// Completes a step when `condition` has held for `hold` seconds; asked once a sample.
  void latch(int side, Task task, bool condition, double hold);
  std::string named(const std::string& body) const;  ///< what people call it

  Exercise m_exercise;
  Mode m_mode;
  std::vector<StepStatus> m_steps;
  std::vector<ErrorMade> m_errors;
  std::vector<ToolMetrics> m_tools;
  std::vector<SideWatch> m_sides;
  Tissues m_tissues;
  PullWatch m_pull;
  TearWatch m_tear;
  struct TrocarMean {
    double on_wall = 0, by_hand = 0;  ///< [N]
  };
  std::array<TrocarMean, sim::kMaxTools> m_trocar{};
  PinchWatch m_pinch;
  SightWatch m_sight;
  CollisionWatch m_collision;
  std::array<Vec3d, sim::kMaxTools> m_tip{};
  std::array<int, sim::kMaxTools> m_held_side{};  ///< of what each hand holds or held last
  std::vector<double> m_true_for;                 ///< (steps) how long each step's condition has held [s]
  std::vector<int> m_organs;                      ///< targets of the survey
  std::vector<double> m_seen_for;                 ///< (m_organs) [s]; at least the survey's time once it was reached
  std::uint64_t m_first_motion = 0, m_now = 0;
  bool m_moved = false;
  double m_seconds = 0;
  int m_clips_judged = 0, m_cuts_judged = 0, m_focus = 0;
};

}  // namespace trocar::training
