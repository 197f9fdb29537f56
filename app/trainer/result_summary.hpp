// What the result window shows of an attempt, in words: points with their maximum, what cost points and what would have
// been better, how earlier attempts went, what to train next. Pure; result.hpp draws it.
//
//   ResultSummary s = summarise(session.result(false), read_standing(...));
//   s.next = next_training(list_exercises(scenes_folder()), "basics/camera-0", s.passed);
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/paths.hpp>
#include <trocar/core/json.hpp>
#include <trocar/training/store/standing.hpp>

namespace trocar::app {

struct ResultSummary {
  enum class Verdict { simulation_failed, no_score, ended_early, passed, not_passed };
  Verdict verdict = Verdict::no_score;
  std::string failure;   ///< of the simulation
  std::string score;     ///< "70.6 of 100 points (pass mark 80)"; empty: none
  std::string duration;  ///< "Duration 0:11"
  double pass_mark = 80;

  struct Part {
    std::string name, points;  ///< "Quality", "41.2 of 60 points"
    double share = 0;          ///< reached of the maximum, 0..1
  };
  std::vector<Part> parts;

  /// Errors of one kind.
  struct Cost {
    std::string text;    ///< "The lens touched a peg"
    std::string when;    ///< "3 times, first at 0:12"
    std::string points;  ///< "-15 points"
    std::string better;  ///< "Better: draw the endoscope back"
    double lost = 0;
    bool fails = false;  ///< the attempt, whatever its points
  };
  std::vector<Cost> costs;  ///< most points first

  struct Step {
    std::string name;
    bool done = false;
  };
  std::vector<Step> steps;
  std::vector<std::string> paths;  ///< "Endoscope: 1234 mm"

  training::Standing standing;  ///< with this attempt, if it is stored
  std::string earlier;          ///< "Previous 62, best 83, median 66 points (5 attempts)"; empty: the first
  std::string advice;           ///< what to train; empty: nothing to say
  std::string next;             ///< the exercise that follows; empty: none
};

/// @param result  Session::result()
/// @param standing  of the same person at this exercise, this attempt included
ResultSummary summarise(const Json& result, const training::Standing& standing);

/// The one that follows `name` in the order of the files where it was passed, else the same again.
std::string next_training(const std::vector<attempt::ExerciseEntry>& exercises, const std::string& name, bool passed);

}  // namespace trocar::app
