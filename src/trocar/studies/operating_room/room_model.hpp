// An operating room with its mechanisms built: where table, people and arms stand at a tilt, how arms reach, how near
// what stands there comes to each other. All in the patient's frame unless said otherwise; "the room" is that frame
// while the table is level, in which gravity is (0, 0, -9.81) and the floor does not move.
//
//   const RoomModel model(scene::read_room("scenes/rooms/telemanipulated.json"));
//   RoomPose pose = model.start();
//   const Reached r = model.lead(pose, 0, {.tip = {-0.05, 0.11, -0.1}});
//   for (const Near& n : model.nearest(pose)) say(n.first, n.second, n.distance);
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/scene/operating_room/room.hpp>
#include <trocar/studies/shape_distance.hpp>

namespace trocar::studies {

using kinematics::Frame;

/// A part that stands in the room: what it is drawn and measured as.
struct RoomPart {
  PlacedShape shape;
  std::string name;  ///< "left: rail", "nurse"
  int arm = -1;      ///< whose it is, or -1
  bool shaft = false, stand = false;
  int link = -1;  ///< of the arm's mechanism
};

/// A part of an arm of which only what is out of the body counts.
struct ArmModel {
  const scene::RoomArm* described = nullptr;
  kinematics::Mechanism mechanism;
  int tip = 0, shaft = 0;            ///< into frames
  Vec3d port;                        ///< [m]
  Frame dock;                        ///< its fixed frame as it was docked
  Vec3d hub;                         ///< where its stand carries it, in its fixed frame [m]
  Mat3d straight = {};               ///< tip's axes of jaws that point along an instrument's
  std::vector<int> wrist;            ///< (independent coordinates) that move what is behind the shaft only
  std::vector<int> jaws;             ///< and of them those that do not move the tip
  std::vector<unsigned char> inner;  ///< (bodies) behind the shaft: always in the body
  std::vector<int> body_link;        ///< (bodies) of Mechanism::links
};

/// Where an arm's tip shall be.
struct ArmGoal {
  Vec3d tip;                       ///< [m]
  bool aims = false;               ///< its axes, too
  Mat3d axes = Mat3d::identity();  ///< as kinematics::TipFrame has them: opening, normal, back along the jaws
};
/// Axes of jaws that point along `towards`, turned by `roll` about it.
Mat3d jaw_axes(Vec3d towards, double roll) noexcept;

struct RoomPose {
  scene::RoomTilt tilt;
  std::vector<std::vector<double>> u;    ///< (arms) independent coordinates
  std::vector<kinematics::Pose> frames;  ///< (arms) of their mechanisms
  std::vector<Vec3d> tips;               ///< (instruments) that hands hold; fewer: where the room has them [m]
};

/// What became of leading an arm.
struct Reached {
  bool reached = false, within_limits = false;
  bool straight = false;  ///< with its wrist as it began
  double missed = 0;      ///< tip to goal, of the nearest pose that was found [m]
  double loop_gap = 0;    ///< of the mechanism's own closures [m]
  double port_gap = 0;    ///< shaft to port [m]
  std::string limit;      ///< coordinate beyond its limits
};

struct Near {
  std::string first, second;
  int arm = -1, other = -1;  ///< of arms
  double distance = 0;       ///< [m], below 0: in each other
  Vec3d from, to;            ///< where they are nearest, on the middle line of the first and at the second [m]
  Vec3d where() const noexcept { return 0.5 * (from + to); }
};

/// Where a shaft is beside a port [m].
double port_gap(const Frame& shaft, Vec3d port) noexcept;

class RoomModel {
 public:
  /// @throws std::invalid_argument with what cannot be built
  explicit RoomModel(scene::Room room);
  RoomModel(const RoomModel&) = delete;
  RoomModel& operator=(const RoomModel&) = delete;

  const scene::Room& room() const noexcept { return m_room; }
  const geometry::Figure& figure() const noexcept { return m_figure; }
  const std::vector<ArmModel>& arms() const noexcept { return m_arms; }
  int arm(const std::string& name) const;

  double top() const noexcept { return m_figure.back(); }                ///< z of what the patient lies on
  double floor() const noexcept { return top() - m_room.table.height; }  ///< z of the floor, in the room
  Frame table_frame(const scene::RoomTilt& tilt) const noexcept;         ///< patient's frame in the room
  Vec3d gravity(const scene::RoomTilt& tilt) const noexcept;             ///< in the patient's frame [m/s^2]
  /// Is the table within what it can?
  bool can_tilt(const scene::RoomTilt& tilt) const noexcept;

  RoomPose start() const;
  /// Sets frames of what u says.
  void place(RoomPose& pose) const;
  /// How much further an arm's base is from its column than its set-up joints carry it; 0 or less: it is not [m].
  double beyond_set_up(int arm) const noexcept;
  /// An arm's fixed frame in the patient's.
  Frame base(int arm, const scene::RoomTilt& tilt) const noexcept;
  Frame tip(const RoomPose& pose, int arm) const noexcept;
  Frame shaft(const RoomPose& pose, int arm) const noexcept;

  /// Leads an arm to a goal from where it stands; where it cannot get there it stays. A goal that does not aim keeps
  /// the wrist as it began where that reaches.
  Reached lead(RoomPose& pose, int arm, const ArmGoal& goal) const;
  /// Leads it along what the goal leaves free to where it stands clearer of everything. @return clearance [m]
  double clear(RoomPose& pose, int arm, const ArmGoal& goal, int tries = 24) const;

  /// Everything that stands there, in the patient's frame.
  std::vector<RoomPart> arm_parts(const RoomPose& pose, int arm) const;
  std::vector<RoomPart> other_parts(const RoomPose& pose) const;  ///< table, people, instruments, monitors
  /// Of every arm to the patient and to every other thing or arm, the nearest pair of parts each, nearest first.
  std::vector<Near> nearest(const RoomPose& pose) const;
  std::vector<Near> nearest(const RoomPose& pose, int arm, const std::vector<RoomPart>& others) const;

  /// A person's limbs, their hands at what they hold. In the room.
  struct Body {
    std::vector<geometry::Limb> limbs;  ///< legs, trunk, head, then two of each arm
    Vec3d facing;
    Vec3d shoulder[2], elbow[2], hand[2];
    double beyond_reach = 0;  ///< how far what they hold is beyond their reach [m]
  };
  Body person(int index, const RoomPose& pose) const;
  /// Tip of an instrument that a hand holds, and where that hand is [m].
  Vec3d tip_of(const RoomPose& pose, int instrument) const noexcept;
  Vec3d handle(const RoomPose& pose, int instrument) const noexcept;
  PlacedShape screen(const scene::RoomMonitor& monitor) const noexcept;  ///< in the room

 private:
  /// A column and a beam that carry an arm, in the room where it stands on the floor.
  struct Stand {
    Vec3d foot, head, hub;
  };
  Stand stand_of(const ArmModel& arm) const noexcept;
  void build_arm(const scene::RoomArm& described);
  scene::Room m_room;
  geometry::Figure m_figure;
  std::vector<ArmModel> m_arms;
};

/// Moves a shape by a frame.
PlacedShape moved(const Frame& by, PlacedShape shape) noexcept;

}  // namespace trocar::studies
