// An exercise: a scene, what the trainee has to do in it, and the thresholds that decide whether it was done well.
// Thresholds live in the exercise file, each with its origin; nothing here is clinical advice.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/scene/shape.hpp>

namespace trocar::training {

/// A closed interval.
struct Range {
  double low = 0, high = 0;
  bool holds(double v) const { return v >= low && v <= high; }
};

/// Tubal sterilisation with two clips and a cut, one side (first form).
struct Sterilisation {
  std::string tube;                                             ///< strand
  std::string grasper, applier, scissors;                       ///< tools
  core::Location tube_at, grasper_at, applier_at, scissors_at;  ///< where the file names them
  Range present_pull;                                           ///< [N]
  double present_straightness = 0;                              ///< of the isthmus, chord / length
  Range first_clip, second_clip;                                ///< arc length from the uterus [m]
  Range clip_distance;                                          ///< between the two [m]
  double clip_angle = 0;                                        ///< largest theta [rad]
  double clip_cover = 0;                                        ///< smallest cover
  double clip_closing = 0;                                      ///< shortest closing time [s]
  double cut_margin = 0;                                        ///< smallest distance of the cut from a clip [m]
  double cut_fraction = 0;
  double cut_beyond = 0;  ///< deepest cut into the mesosalpinx [m]
  double pull_limit = 0;  ///< over-force [N]
};

struct Penalty {
  std::string code;  ///< "E1", "A1.cover" ...
  double points = 0;
  bool fail = false;
  std::string meaning;
};

struct Exercise {
  std::string name, title;
  std::filesystem::path file, scene;
  Sterilisation goal;
  double hold_time = 0.2;     ///< a predicate counts when true this long [s]
  double expert_time = 240;   ///< [s]
  double longest_time = 900;  ///< [s]
  double pass_mark = 80;
  std::vector<Penalty> penalties;

  const Penalty* penalty(const std::string& code) const;
};

const scene::Shape& exercise_shape();

/// Throws core::BadInput with every fault. Whether the scene has the strand and the tools is checked by bind(). With
/// `memory` the file is looked up there instead of on the disk.
Exercise read_exercise(const std::filesystem::path& path, const scene::MemoryFiles* memory = nullptr);

}  // namespace trocar::training
