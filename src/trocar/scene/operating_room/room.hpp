// An operating room as somebody describes it: the patient on a table that tilts, ports, instruments as they stand out
// of the body, people at their places, monitors, and telemanipulators: mechanisms that carry instruments through ports.
// Editable, with names, in metres and radians. The frame is the patient's (umbilicus, left, head, front), which tilts
// with the table; things on the floor are described where they stand while the table is level.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/geometry/figure/figure.hpp>
#include <trocar/kinematics/chains/description.hpp>

namespace trocar::scene {

struct RoomTilt {
  double head_down = 0;  ///< [rad] below 0: head up
  double left_down = 0;  ///< [rad] below 0: right side down
};

struct RoomTable {
  double width = 0.54, thickness = 0.07;
  double height = 0.80;  ///< of what the patient lies on, above the floor, while level [m]
  RoomTilt tilt;         ///< at the start
  double head_down_most = 0.5236, head_up_most = 0.5236, side_most = 0.3491;  ///< [rad]
  double drop = 0.25;                                                         ///< of the tilt's axes below its top [m]
  double fastest = 0.0524;                                                    ///< of its tilt [rad/s]
};

struct RoomPort {
  std::string name;
  Vec3d position;
  double diameter = 0.005;
  core::Location at;
};

/// An instrument in a port, held by a hand: a straight shaft from its tip to its handle.
struct RoomInstrument {
  std::string name, port, held_by;
  Vec3d tip;
  double length = 0.310, radius = 0.0025;  ///< tip to handle [m]
  bool camera = false;
  core::Location at;
};

enum class StaffRole : unsigned char { surgeon, assistant, camera_holder, scrub_nurse, anaesthetist };
struct RoomPerson {
  std::string name;
  StaffRole role = StaffRole::surgeon;
  double x = 0, y = 0;    ///< on the floor [m]
  double step = 0;        ///< of what they stand on [m]
  double stature = 1.75;  ///< [m]
  double reach = 0.72;    ///< shoulder to grip [m]
  core::Location at;
};

struct RoomMonitor {
  std::string name;
  Vec3d at_place;          ///< middle of the screen [m]
  double diagonal = 0.66;  ///< [m]
  core::Location at;
};

/// A mechanism that carries an instrument. Its fixed frame has its origin in its remote centre, z outwards along the
/// shaft in the middle of its range and y towards its base.
struct RoomArm {
  std::string name, file, port;
  bool on_table = false;  ///< else on the floor: it does not tilt with the table
  Vec3d out, base;        ///< where its z and y point, any length; `out` zero: as the skin does at its port
  double x = 0, y = 0;    ///< where its stand is [m]
  double set_up = 1.0;    ///< how far from its column set-up joints carry its base [m]
  std::string tip = "tip", shaft = "shaft";  ///< frames of the mechanism
  double fastest_turn = 2.0;                 ///< [rad/s] of a coordinate
  double fastest_slide = 0.2;                ///< [m/s]
  core::Location at, file_at;
  kinematics::MechanismDescription mechanism;  ///< of the file, once it is read
};

/// What is worked at: a box.
struct RoomTarget {
  std::string name;
  Vec3d low, high;
  core::Location at;
};

struct Room {
  std::string name, title, file, scene;
  geometry::FigureSizes patient;
  RoomTable table;
  std::vector<RoomPort> ports;
  std::vector<RoomInstrument> instruments;
  std::vector<RoomPerson> staff;
  std::vector<RoomMonitor> monitors;
  std::vector<RoomArm> arms;
  std::vector<RoomTarget> targets;
  double margin = 0.005;  ///< nearer than this counts as a collision [m]

  int port(const std::string& port_name) const;
};

/// Motions of arms and of the table over time.
struct Programme {
  struct Pose {
    double at = 0;      ///< [s]
    Vec3d tip;          ///< in the patient's frame [m]
    bool aims = false;  ///< else the jaws are where they come to be
    Vec3d towards;      ///< of the jaws, any length; zero: along the shaft
    double roll = 0;    ///< [rad]
  };
  struct Move {
    std::string arm;
    std::vector<Pose> poses;  ///< in time
    core::Location at;
  };
  struct Tilt {
    double at = 0;
    RoomTilt tilt;
  };
  std::string name, title, file;
  std::vector<Move> moves;
  std::vector<Tilt> tilts;
  double length() const;  ///< [s]
};

inline constexpr int kMostArms = 6, kMostPeople = 12, kMostPorts = 16;
inline constexpr double kLongestProgramme = 600;  ///< [s]

const char* word_of(StaffRole role);

}  // namespace trocar::scene
