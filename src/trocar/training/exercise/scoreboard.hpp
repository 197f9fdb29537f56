// The account of an attempt, whatever the exercise: which steps are done, which errors were made, what that is worth.
//
//   Scoreboard board(exercise, Mode::assessed);
//   const int cut = board.add_step({"Left: Cut", hint, "cut", "left"}, 3, false);
//   board.at(tick);  board.done(cut);  board.make_error(*exercise.penalty("A1.6"), "left", where);
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/rules/step_status.hpp>

namespace trocar::training {

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

enum class Mode { assessed, familiarisation };

class Scoreboard {
 public:
  /// @param exercise  outlives the board
  Scoreboard(const Exercise& exercise, Mode mode);

  /// @param weight  in the score's quality  @return its number
  int add_step(StepStatus step, double weight);

  /// Now it is this tick: what is told from here on happened in it.
  void at(std::uint64_t tick) { m_now = tick; }
  double now() const;  ///< [s]

  void done(int step);    ///< unless it is already, or was missed
  void missed(int step);  ///< unless it was done
  void undone(int step);  ///< if it was done
  void make_error(const Penalty& penalty, const std::string& side, Vec3d where, std::string detail = {});

  const std::vector<StepStatus>& steps() const { return m_steps; }
  const std::vector<ErrorMade>& errors() const { return m_errors; }
  const StepStatus& step(int i) const { return m_steps[size_t(i)]; }
  bool open(int i) const { return !step(i).done && !step(i).missed; }
  bool finished() const;  ///< every step but the optional ones is done or missed
  Mode mode() const { return m_mode; }
  /// @param seconds  that the attempt took
  Score score(double seconds) const;

 private:
  const Exercise& m_exercise;
  Mode m_mode;
  std::vector<StepStatus> m_steps;
  std::vector<double> m_weight;  ///< (steps) in the score's quality
  std::vector<ErrorMade> m_errors;
  std::uint64_t m_now = 0;
};

}  // namespace trocar::training
