// A motion of a room's arms and table, gone through step by step: whatever leads it, a programme written before or the
// hands of an attempt. Every step is asked whether arms reach, within limits and speeds, keep their ports, and stand
// clear of each other, the patient, the table and people. Steps are a fixed time apart, and also at every pose of a
// programme, in the middle of each move, where least jerk is fastest, and at sixteenths of a move that is short.
//
//   const MotionReport r = go_through(model, motion_of(model, programme), {});
//   for (const MotionFault& f : r.faults) say(f.from, f.to, f.words);
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <trocar/studies/operating_room/room_model.hpp>

namespace trocar::studies {

struct RoomMotion {
  double length = 0;       ///< [s]
  std::vector<int> moves;  ///< arms that it leads; others stand
  std::function<ArmGoal(int arm, double at)> goal;
  std::function<scene::RoomTilt(double at)> tilt;
  std::function<std::vector<Vec3d>(double at)> tips;  ///< RoomPose::tips; empty: what hands hold stays
  std::vector<std::vector<double>> poses_at;          ///< (arms, or none) when a programme's poses are [s]
  std::vector<double> tilts_at;                       ///< and its tilts of the table
};
/// From pose to pose with least jerk, at rest in each [Flash & Hogan 1985].
RoomMotion motion_of(const RoomModel& model, const scene::Programme& programme);
/// Share of the way after a share of the time: 10 t^3 - 15 t^4 + 6 t^5.
double least_jerk(double t) noexcept;

enum class MotionFaultKind : unsigned char { reach, limit, speed, port, collision, tilt };
const char* word_of(MotionFaultKind kind);

struct MotionFault {
  MotionFaultKind kind = MotionFaultKind::reach;
  int arm = -1;
  std::string with;         ///< of collisions: whom; of speeds and limits: which coordinate
  double from = 0, to = 0;  ///< [s]
  double worst = 0;         ///< missed [m], gap [m], share of the speed that is allowed, clearance [m]
  double worst_at = 0;      ///< [s]
  Vec3d where;              ///< of the tip, or between the parts [m]
  std::string words;
};

struct MotionStep {
  double at = 0;
  RoomPose pose;
  struct Arm {
    Reached reached;
    double speed = 0;      ///< largest share of what is allowed
    double clearance = 0;  ///< [m] to whatever is nearest
    std::string nearest;
  };
  std::vector<Arm> arms;
};

struct MotionOptions {
  double step = 0.02;        ///< [s]
  double keep_port = 1e-4;   ///< [m] a shaft may be beside its port
  double clear_from = 0.02;  ///< nearer than this, an arm that can goes aside [m]; 0: never
  int kept_every = 5;        ///< steps, of those that the report keeps; those with a new fault are kept, too
  bool stops = false;        ///< at the first fault
};

struct MotionReport {
  std::vector<MotionFault> faults;  ///< in order of their begin
  std::vector<MotionStep> steps;
  int count = 0;
  double length = 0;
  double port_gap = 0, loop_gap = 0, least_clearance = 0, most_speed = 0;  ///< over the whole motion
  double least_at = 0;
  std::string least_pair;
  bool good() const noexcept { return faults.empty(); }
};

MotionReport go_through(const RoomModel& model, const RoomMotion& motion, const MotionOptions& options);

/// The kept step that is nearest to a time; there is at least one.
const MotionStep& step_at(const MotionReport& report, double at) noexcept;

}  // namespace trocar::studies
