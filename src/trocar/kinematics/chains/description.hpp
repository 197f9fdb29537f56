// A mechanism as somebody describes it: links that joints hang on each other, loops that are closed between them, what
// is coupled and what is driven. Editable, with names; build() makes a Mechanism of it.
//
// Every dimension is a Quantity: a number and multiples of named parameters. A design study changes parameters, so it
// can change any dimension: numbers without a parameter become parameters of their own ("rod.at.x").
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::kinematics {

enum class Measure : unsigned char { length, angle, ratio };  ///< metres, radians, number

struct Parameter {
  std::string name;
  Measure measure = Measure::length;
  double value = 0;
  double low = 0, high = 0;  ///< within which a study may change it; both 0: it may not
  double tolerance = 0;      ///< plus or minus, as made; 0: not said
};

/// constant + sum of factor * parameter
struct Quantity {
  struct Term {
    int parameter = 0;
    double factor = 1;
    bool operator==(const Term&) const = default;
  };
  double constant = 0;
  std::vector<Term> terms = {};
  bool operator==(const Quantity&) const = default;
};
using Quantities = std::array<Quantity, 3>;

/// Where a frame is in another one: moved to `at`, then turned by `turn` about the fixed x, y, z axes. Or by the four
/// numbers of the modified Denavit-Hartenberg convention [Craig 1989]: Rot_x(alpha) Move_x(a) Rot_z(theta) Move_z(d),
/// which then stand in turn[0], at[0], turn[2], at[2].
struct Placement {
  bool dh = false;
  Quantities at = {}, turn = {};
};

enum class JointKind : unsigned char {
  fixed,
  revolute,     ///< turns about its axis
  prismatic,    ///< slides along it
  cylindrical,  ///< both: coordinates .angle, .slide
  helical,      ///< both, coupled by a pitch: .angle; .slide follows
  universal,    ///< about x, then the turned y: .about_x, .about_y
  spherical,    ///< about x, the turned y, the turned z: .about_x, .about_y, .about_z; singular at about_y = 90 degrees
  planar        ///< along x and y, about z: .along_x, .along_y, .about_z
};

struct Joint {
  JointKind kind = JointKind::fixed;
  std::string name;                   ///< of its coordinate, or what their names begin with; empty: the link's
  Vec3d axis = {0, 0, 1};             ///< in its own frame; of kinds that have one
  Placement place;                    ///< of its frame in the parent's
  Quantity pitch;                     ///< of a screw: slide in a whole turn [m]
  std::vector<double> limits, start;  ///< low and high, value, of each coordinate in the order above [rad, m]
};

enum class ShapeKind : unsigned char { capsule, cylinder, box };
struct Shape {
  ShapeKind kind = ShapeKind::capsule;
  Quantities from = {}, to = {};  ///< ends of the middle line; of a box: its middle; its edges
  Quantities turn = {};           ///< of a box
  Quantity radius;                ///< not of a box
};

struct Link {
  std::string name, parent = "ground";
  Joint joint;
  double mass = 0;                     ///< [kg]
  Vec3d centre = {};                   ///< of mass, in the link's frame [m]
  std::array<double, 6> inertia = {};  ///< xx yy zz xy xz yz about the centre, in the link's axes [kg m^2]
  std::vector<Shape> shapes = {};
};

/// A coordinate without a joint: a wheel or a drum that others are coupled to.
struct Motor {
  std::string name;
  Measure measure = Measure::angle;
  std::vector<double> limits, start;
};

/// coordinate = offset + sum of ratio * other coordinate: cables, gears, levers.
struct Coupling {
  struct Term {
    std::string of;
    Quantity ratio;
  };
  std::string coordinate;
  Quantity offset;
  std::vector<Term> terms = {};
};

/// A driven coordinate, from `at_0` where the drive is at 0 to `at_1` where it is at 1.
struct Actuator {
  std::string name, coordinate;
  Quantity at_0, at_1;
};

/// A named frame on a link: a tip, a remote centre.
struct NamedFrame {
  std::string name, link = "ground";
  Placement place;
};

/// Directions of a closure, those of its first frame.
enum Directions : unsigned {
  kTx = 1,
  kTy = 2,
  kTz = 4,
  kRx = 8,
  kRy = 16,
  kRz = 32,
  kT = kTx | kTy | kTz,
  kR = kRx | kRy | kRz
};

/// The second frame may not move against the first in these directions.
struct LoopClosure {
  std::string name;
  unsigned directions = kT;
  NamedFrame a, b;  ///< (names unused)
};

/// A spring and damper between two points.
struct PointSpring {
  std::string name;
  NamedFrame a, b;                              ///< (names unused; only where they are)
  double stiffness = 0, damping = 0, rest = 0;  ///< [N/m], [N s/m], [m]
};

struct MechanismDescription {
  std::string name, title;
  std::vector<Parameter> parameters;
  std::vector<Link> links;
  std::vector<Motor> motors;
  std::vector<Coupling> couplings;
  std::vector<Actuator> actuators;
  std::vector<NamedFrame> frames;
  std::vector<LoopClosure> closures;
  std::vector<PointSpring> springs;
  Vec3d gravity = {0, 0, -9.81};
};

/// What is not sound: where, and "expected ..., got ...".
struct MechanismFault {
  enum class Part : unsigned char { mechanism, parameter, link, motor, coupling, actuator, frame, closure, spring };
  Part part = Part::mechanism;
  int index = 0, item = -1;  ///< of the part; of what is in it (a term of a coupling)
  std::string field;         ///< as it is called here: "parent"
  std::string message;
};

inline constexpr int kMostLinks = 200, kMostCoordinates = 100, kMostClosures = 50, kMostDimensions = 20'000;

/// All that keeps a description from being built; empty: nothing does.
std::vector<MechanismFault> check(const MechanismDescription& description);

}  // namespace trocar::kinematics
