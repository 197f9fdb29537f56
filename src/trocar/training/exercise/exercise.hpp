// An exercise: a scene, what the trainee has to do in it, and the limits that decide whether it was done well. All of
// it is in its file: steps, errors and details are composed of registered facts and events (rules/). Nothing here is
// clinical advice.
//
//   const Exercise e = read_exercise("scenes/basics/camera.json");
//   Monitor monitor(e, model);
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <trocar/scene/json/shape.hpp>
#include <trocar/training/rules/limits.hpp>
#include <trocar/training/rules/names.hpp>

namespace trocar::training {

/// More of one exercise are a fault.
inline constexpr int kMaxSteps = 64;  ///< with one an element of their sets
inline constexpr int kMaxSets = 32;
inline constexpr int kMaxErrors = 512;  ///< with one an element of their sets
inline constexpr std::size_t kMaxLimits = 256;
inline constexpr std::size_t kMaxIncludes = 16;
/// Of all its files together: a shipped one has at most 2,500. More are refused before anything else is asked.
inline constexpr int kMaxExerciseValues = 100'000;
inline constexpr std::size_t kLongestExerciseText = 4096;  ///< [bytes]

/// Where a list for people shows an exercise, in the order of the list.
inline constexpr const char* kGroups[] = {"basics", "suturing", "gynaecology", "gallbladder", "bowel", "free practice"};
inline constexpr int kMostLevel = 3;  ///< 1 beginner, 2 intermediate, 3 advanced

/// A part of a file, kept as it stands there.
struct Part {
  scene::JsonValue value;
  std::string file;
};

struct StepText {
  std::string name, title, hint;  ///< "first_clip", "First clip", what to do; with {placeholders}
  std::string for_each;           ///< set; empty: once
  double weight = 1;              ///< in the score's quality
  bool optional = false;
  Part part;
};

/// An error: what it costs, and what else follows from it.
struct Penalty {
  std::string code;  ///< "E1", "A1.3" ...
  std::string name;  ///< "lumen open"
  double points = 0;
  bool fail = false;
  std::string meaning, hint, source;
  std::vector<std::string> implies;  ///< codes that always come with it
  std::vector<std::string> may;      ///< codes that can come with it
  std::vector<std::string> leaves;   ///< steps that the act does not complete
  std::vector<std::string> misses;   ///< steps that it closes
  std::string for_each;              ///< set; empty: once
  Part part;                         ///< says when it is made
  Part at;                           ///< mark where it is shown, of conditions; null: none
};

/// An error that cannot be detected yet.
struct LaterError {
  std::string code, name, needs;
};

/// The perturbation that a demonstration uses from one of its decision points on, counted from 0.
struct Choice {
  int at = 0, perturbation = 0;
};
using Choices = std::vector<Choice>;
inline constexpr int kMostChoice = 99999, kMostPerturbation = 99999;
inline constexpr std::uint64_t kLargestRehearsedSeed = (std::uint64_t(1) << 53) - 1;  ///< that a number of JSON holds

/// Choices with which it succeeded in a rehearsal.
struct RecordedChoices {
  std::uint64_t seed = 0;  ///< of the anatomy
  Choices choices;         ///< elsewhere it continues as it is written
};

struct Exercise {
  std::string name, title, summary;
  std::filesystem::path file, scene;
  int order = 1000;                                               ///< of lists of exercises: those with less come first
  double hold_time = 0.2;                                         ///< a condition counts when true this long [s]
  double expert_time = 240;                                       ///< [s]
  double longest_time = 900;                                      ///< [s]
  double quality_share = 60, time_share = 25, motion_share = 15;  ///< of the score, before renormalising
  double pass_mark = 80;
  Limits limits;  ///< of common rules first
  std::vector<std::pair<std::string, Part>> sets;
  std::vector<StepText> steps;
  std::vector<Penalty> penalties;  ///< of common rules first
  std::vector<Part> details;       ///< facts that the result tells
  Part demonstration;              ///< null without a demonstration
  std::vector<RecordedChoices> recorded_choices;
  std::vector<LaterError> later;
  std::string group;  ///< one of kGroups; empty: none
  int level = 1;      ///< to kMostLevel

  const RecordedChoices* recorded_choices_for(std::uint64_t seed) const;  ///< null: there are none
  const Penalty* penalty(const std::string& code) const;
  const StepText* step(const std::string& name) const;
  /// Of a single number, in SI; what the exercise does not have is `otherwise`.
  double limit(const std::string& name, double otherwise) const;
  /// Names as a scene gives them. @param model  null: sets that are patterns wait for it
  Names names(const sim::Model* model, std::uint64_t seed, Faults& faults) const;
};

/// What a file of an exercise may say, and a file of common rules that exercises include.
const scene::Shape& exercise_shape();
const scene::Shape& common_rules_shape();

/// Every fault is appended, those too that steps and errors have; what only the scene can tell is left to
/// check_in_scene(). With `memory` files are looked up there instead of on the disk. @return what could be read
Exercise read_exercise(const std::filesystem::path& path, Faults& faults, const scene::MemoryFiles* memory = nullptr);
/// What the exercise names and asks for, and the scene has not. Faults that are there already are not told again.
void check_in_scene(const Exercise& exercise, const sim::Model& model, Faults& faults);

/// Throws core::BadInput with every fault. What only the scene can tell is checked by Monitor. With `memory` the file
/// is looked up there instead of on the disk.
Exercise read_exercise(const std::filesystem::path& path, const scene::MemoryFiles* memory = nullptr);

}  // namespace trocar::training
