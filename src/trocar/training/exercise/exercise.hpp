// An exercise: a scene, what the trainee has to do in it, and the thresholds that decide whether it was done well.
// Thresholds, penalties and what people are told live in the exercise file, each with its origin; nothing here is
// clinical advice.
//
//   const Exercise e = read_exercise("scenes/gynaecology/sterilisation.json");
//   Monitor monitor(e, model);
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <trocar/scene/json/shape.hpp>

namespace trocar::training {

/// A closed interval.
struct Range {
  double low = 0, high = 0;
  bool holds(double v) const { return v >= low && v <= high; }
};

/// What an exercise calls a body of the scene, and what people call it.
struct Named {
  std::string name, title;
  core::Location at;  ///< where the file names it
};

/// What counts as rough or careless, whatever the task: over-forces, blind and colliding instruments.
struct Handling {
  std::vector<Named> delicate, bowel;  ///< bodies that bear less pull; bodies that bear less pinch

  // Thresholds; the exercise's table of them (thresholds.cpp) says what each means.
  double pull_limit = 0, pull_limit_other = 0, pull_excursion = 0;
  double pinch_limit = 0, pinch_impulse = 0;
  double blind_time = 0, blind_speed = 0;
  double collision_speed = 0, insertion_depth = 0;
};

/// What current may do where it should not.
struct EnergyLimits {
  double idle_time = 0;       ///< a pedal may be pressed beside nothing for this long [s]
  double hook_spread = 0;     ///< of dead tissue from a monopolar electrode's edge, at most [m]
  double bipolar_spread = 0;  ///< the same between jaws [m]
};

/// One side of the patient: what has to be clipped and cut there.
struct Side {
  std::string name, title;    ///< "left", "Left"
  std::string tube, ovary;    ///< strand, solid
  std::string mesosalpinx;    ///< the tube's fold; empty: none
  std::string grasper_hand;   ///< port whose hand presents the tube in the demonstration
  std::string scissors_hand;  ///< port whose hand cuts it there
  core::Location tube_at, ovary_at, mesosalpinx_at, grasper_at, scissors_at;
};

/// Tubal sterilisation with two clips and a cut between them on each side.
struct Sterilisation : Handling {
  std::string uterus;
  std::vector<Side> sides;                 ///< 1 or 2
  std::vector<Named> forbidden;            ///< look-alikes; whatever is not a tube is a wrong structure as well
  std::string grasper, applier, scissors;  ///< instruments
  core::Location uterus_at, grasper_at, applier_at, scissors_at;

  double survey_time = 0, organ_share = 0;
  double trace_to = 0, trace_speed = 0, trace_gap = 0, trace_pause = 0, trace_touch = 0;
  Range present_pull;
  double present_straightness = 0;
  Range first_clip, second_clip, clip_distance;
  double clip_angle = 0, clip_oblique = 0, clip_cover = 0, clip_closing = 0, ampulla_from = 0, cornu_to = 0;
  double cut_margin = 0, cut_fraction = 0, cut_depth = 0;
  double check_time = 0;
};

/// One artery bleeds: find it, clip it on its heart's side, clear what has run out, look whether it stays dry.
struct BleedingControl : Handling {
  std::string applier;  ///< instrument
  core::Location applier_at;

  double find_time = 0, check_time = 0;                    ///< [s]
  double clip_cover = 0, clip_closing = 0;                 ///< - [s]
  double stopped_flow = 0, stopped_time = 0;               ///< [m^3/s] [s]
  double pool_left = 0;                                    ///< [m^3]
  double lost_some = 0, lost_much = 0, lost_too_much = 0;  ///< [m^3]
  double control_within = 0, clear_within = 0;             ///< [s]
  EnergyLimits energy;
};
enum class BleedingTask { find, clip, stop, clear, check };
inline constexpr int kBleedingTasks = 5;

/// The steps of a side, in the order in which they are shown; the survey comes before both sides.
enum class Task { survey, identify, present, first_clip, second_clip, cut, check };
inline constexpr int kTasks = 7;

struct TaskText {
  std::string name, title, hint;  ///< "first_clip", "First clip", what to do
  double weight = 1;              ///< in the score's quality
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
  std::vector<std::string> leaves;   ///< steps that the act does not complete (names of TaskText)
};

/// An error that cannot be detected yet.
struct LaterError {
  std::string code, name, needs;
};

struct Exercise {
  enum class Kind { sterilisation, bleeding_control } kind = Kind::sterilisation;
  std::string name, title, summary;
  std::filesystem::path file, scene;
  Sterilisation goal;                                             ///< of a sterilisation
  BleedingControl bleeding;                                       ///< of bleeding control
  std::vector<TaskText> tasks;                                    ///< in the kind's order
  double hold_time = 0.2;                                         ///< a predicate counts when true this long [s]
  double expert_time = 240;                                       ///< [s]
  double longest_time = 900;                                      ///< [s]
  double quality_share = 60, time_share = 25, motion_share = 15;  ///< of the score, before renormalising
  double pass_mark = 80;
  std::vector<Penalty> penalties;
  std::vector<LaterError> later;
  std::vector<std::string> threshold_sources;  ///< parallel to thresholds(kind)

  const Penalty* penalty(const std::string& code) const;
  const TaskText& text(Task task) const { return tasks[size_t(task)]; }
  const TaskText& text(BleedingTask task) const { return tasks[size_t(task)]; }
  const Handling& handling() const {
    return kind == Kind::sterilisation ? static_cast<const Handling&>(goal) : bleeding;
  }
};

/// A row of a kind's table of thresholds: its key in the file, unit and bounds there, and the number that it sets.
struct ThresholdRow {
  const char* key;
  double unit;  ///< of the file's number in SI
  double low, high;
  double& (*value)(Exercise&);
  Range& (*range)(Exercise&);  ///< one of the two is null
  const char* meaning;
};
std::span<const ThresholdRow> thresholds(Exercise::Kind kind);

/// What a file of that kind may say.
const scene::Shape& sterilisation_shape();
const scene::Shape& bleeding_control_shape();

/// Throws core::BadInput with every fault. Whether the scene has what the exercise names is checked by Monitor. With
/// `memory` the file is looked up there instead of on the disk.
Exercise read_exercise(const std::filesystem::path& path, const scene::MemoryFiles* memory = nullptr);

}  // namespace trocar::training
