// Watches an attempt: which steps are done, which errors were made, time and path length, and the score with every
// component shown. Reads State only, at fixed ticks, so that a replay gives the same result.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <trocar/sim/step.hpp>
#include <trocar/training/exercise.hpp>

namespace trocar::training {

struct StepStatus {
  std::string name, hint;
  bool done = false;
  double at = 0;  ///< when [s]
};

struct ErrorMade {
  std::string code, meaning;
  double points = 0;
  bool fail = false;
  double at = 0;  ///< when [s]
};

struct Score {
  double total = 0, quality = 0, time = 0;  ///< total 0..100, components 0..1
  double penalties = 0;
  bool failed = false;  ///< by an error that fails the attempt
  bool passed = false;
};

struct ToolMetrics {
  std::string name;
  double path = 0;      ///< of the tip [m]
  double max_pull = 0;  ///< [N]
};

class Monitor {
 public:
  /// Throws core::BadInput naming what the scene lacks (strand, instruments).
  Monitor(const Exercise& exercise, const sim::Model& model);

  /// After every tick.
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report);

  const std::vector<StepStatus>& steps() const { return m_steps; }
  const std::vector<ErrorMade>& errors() const { return m_errors; }
  const std::vector<ToolMetrics>& tools() const { return m_tools; }
  /// Number of the first step not done yet; steps().size() when all are.
  int current() const;
  bool finished() const { return current() == int(m_steps.size()); }
  double seconds() const { return m_seconds; }  ///< since the first motion of an instrument
  double isthmus_straightness() const { return m_straightness; }
  bool occluded() const { return m_occluded; }  ///< no way through the tube any more
  Score score() const;

  /// One JSON object: everything above.
  std::string result_json() const;

 private:
  void measure(const sim::Model& model, const sim::State& state);
  void watch_steps(const sim::State& state);
  void watch_errors(const sim::State& state, const sim::StepReport& report);
  void judge_clip(const interactions::Clip& clip);
  void judge_cut(const sim::State& state, const interactions::Cut& cut);
  void check_lumen(const sim::Model& model, const sim::State& state);
  void make_error(const std::string& code);
  void complete(int step, bool condition, bool latched);

  Exercise m_exercise;
  std::vector<StepStatus> m_steps;
  std::vector<ErrorMade> m_errors;
  std::vector<ToolMetrics> m_tools;
  std::vector<Vec3d> m_last_tip;
  std::array<double, 8> m_true_for{};  ///< how long each step's condition has held [s]
  int m_tube = -1, m_grasper = -1;
  double m_isthmus = 0.025;  ///< its end [m]
  double m_tube_arc = 0;
  std::uint64_t m_first_motion = 0, m_now = 0;
  bool m_moved = false, m_over_force = false, m_occluded = false;
  double m_seconds = 0, m_straightness = 0, m_over_for = 0;
  int m_clips_judged = 0, m_cuts_judged = 0;
  double m_first_clip = -1, m_second_clip = -1;
};

}  // namespace trocar::training
