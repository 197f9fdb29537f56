// A mechanism that can be moved: a tree of bodies, each of which turns about or slides along one axis of its parent,
// and the conditions that close loops between them. Const once built, and shared; where it stands is a Pose.
//
//   const Mechanism m = build(description);            // std::invalid_argument where check() has faults
//   Pose pose(m);
//   forward(m, u, pose);                               // u: the independent coordinates [rad, m]
//   const Frame tip = place(m, m.frames[k], pose);
//
// Joints of several freedoms are built of bodies without mass, one a freedom. Coordinates q are all of them; those that
// couplings make of others are not independent: q = E u + e.
//
// A design study changes parameters, not the structure:
//
//   std::vector<double> p = m.parameter_values;
//   p[m.parameter("crank")] += 1e-5;
//   Mechanism other = m.with(p);    // or, without an allocation, m_copy.assign(p)
//
// Everything here is arithmetic in a fixed order, without allocation after build(), and noexcept.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/kinematics/chains/description.hpp>
#include <trocar/kinematics/chains/frame.hpp>

namespace trocar::kinematics {

inline constexpr double kNoLimit = 1e5;  ///< a limit beyond this is none [rad, m]

enum class Motion : unsigned char { none, turn, slide };

struct Body {
  int parent = -1;  ///< a smaller number
  Motion motion = Motion::none;
  int coordinate = -1;     ///< into q
  Vec3d axis = {0, 0, 1};  ///< unit, in the body's own axes and in those of its joint
  int dimensions = -1;     ///< first of six: at x, y, z, turn x, y, z; -1: where its parent is
  bool dh = false;
  double mass = 0;
  Vec3d centre = {};
  Mat3d inertia = {};  ///< about the centre, in the body's axes
};

/// A frame that is fixed on a body.
struct BodyFrame {
  int body = 0;
  int dimensions = -1;  ///< as of a Body; -1: given by `local` alone
  bool dh = false;
  Frame local = {};
};

/// One condition of a closure: the second frame's part along an axis of the first is none (`along`), an axis of one is
/// square to an axis of the other (`square`), or there is no turn about it (`twist`).
struct Condition {
  enum class Kind : unsigned char { along, square, twist } kind = Kind::along;
  unsigned char i = 0, k = 0;  ///< axis of the first frame; of the second (square)
};

struct Closure {
  BodyFrame a, b;
  unsigned directions = kT;
  std::array<Condition, 6> conditions = {};
  int count = 0;
};
/// Sets the conditions of these directions.
void set_directions(Closure& closure, unsigned directions) noexcept;

struct BodyShape {
  int body = 0, dimensions = 0;  ///< nine: from, to, and radius or turn
  ShapeKind kind = ShapeKind::capsule;
  Vec3d from, to;  ///< in the body's frame; of a box: its middle, its edges
  double radius = 0;
  Mat3d turn = Mat3d::identity();
};

struct BodySpring {
  BodyFrame a, b;
  double stiffness = 0, damping = 0, rest = 0;
};

struct Drive {
  std::string name;
  int independent = 0;  ///< into u
  int dimensions = 0;   ///< two: at_0, at_1
  double at_0 = 0, at_1 = 0;
  double value(double handle) const noexcept { return at_0 + handle * (at_1 - at_0); }
};

struct Mechanism {
  std::string name;
  std::vector<std::string> links;  ///< "ground", then as described
  std::vector<int> link_body;      ///< (links)
  std::vector<Body> bodies;        ///< parents first; 0 is the ground, which is the frame of reference
  std::vector<Frame> places;       ///< (bodies) of each joint in its parent's frame

  std::vector<std::string> coordinates;  ///< of q
  std::vector<Measure> measures;         ///< (q) length or angle
  std::vector<double> low, high, start;  ///< (q); without limits: beyond kNoLimit
  std::vector<int> independent;          ///< (u) into q
  std::vector<int> dependents;           ///< other coordinates, in an order in which each needs earlier ones only
  struct Share {
    int of = 0;          ///< into q
    int dimension = -1;  ///< of its ratio
    double factor = 1;   ///< times that dimension: a screw's pitch is of a whole turn
  };
  std::vector<int> share_start;       ///< (q + 1) into shares
  std::vector<Share> shares;          ///< of a dependent coordinate, as described
  std::vector<int> offset_dimension;  ///< (q) or -1
  // q = E u + e, made of the above: row i of E is expand[expand_start[i] .. expand_start[i + 1])
  struct Entry {
    int u = 0;
    double ratio = 1;
  };
  std::vector<int> expand_start;
  std::vector<Entry> expand;
  std::vector<double> offset;  ///< e

  std::vector<Drive> drives;
  std::vector<std::string> frame_names, closure_names, spring_names;
  std::vector<BodyFrame> frames;
  std::vector<Closure> closures;
  std::vector<BodySpring> springs;
  std::vector<BodyShape> shapes;
  Vec3d gravity;

  int named_parameters = 0;              ///< of the description: the first of them
  std::vector<Parameter> parameters;     ///< as described, then a dimension each that has none: "rod.at.x"
  std::vector<double> parameter_values;  ///< (parameters)
  struct Term {
    int parameter = 0;
    double factor = 1;
  };
  std::vector<double> base, dimensions;  ///< (dimensions) without parameters; with
  std::vector<int> term_start;           ///< (dimensions + 1)
  std::vector<Term> terms;

  double length = 1;  ///< what metres are measured by beside radians: the largest place or travel [m]
  int rows = 0;       ///< conditions of all closures

  int u_count() const noexcept { return int(independent.size()); }
  int q_count() const noexcept { return int(coordinates.size()); }
  /// Indices by name, or -1.
  int link(std::string_view name) const noexcept;
  int coordinate(std::string_view name) const noexcept;
  int independent_of(std::string_view coordinate_name) const noexcept;  ///< into u
  int parameter(std::string_view name) const noexcept;
  int frame(std::string_view name) const noexcept;
  int drive(std::string_view name) const noexcept;
  double scale(int u) const noexcept;  ///< 1 of angles, `length` of slides

  /// u as described: the start of every independent coordinate.
  std::vector<double> start_u() const;
  /// The same mechanism with other parameters. @param values (parameters) [m, rad, 1]
  Mechanism with(std::span<const double> values) const;
  /// Takes other parameters itself; what is made of them follows. No allocation.
  void assign(std::span<const double> values) noexcept;
};

/// @throws std::invalid_argument with the first of check()'s faults
Mechanism build(const MechanismDescription& description);

/// Where a mechanism stands.
struct Pose {
  explicit Pose(const Mechanism& m);
  std::vector<double> q;      ///< all coordinates
  std::vector<Frame> frames;  ///< (bodies) in the ground's
  std::vector<Vec3d> axes;    ///< (bodies) of joints, in the ground's axes
};

/// Forward kinematics. @param u (u_count) [rad, m]
void forward(const Mechanism& m, std::span<const double> u, Pose& pose) noexcept;

inline Frame place(const BodyFrame& f, const Pose& pose) noexcept { return pose.frames[std::size_t(f.body)] * f.local; }

/// Turning speed and speed of a point.
struct Twist {
  Vec3d turn, move;  ///< [rad/s], [m/s]; of a Jacobian: per unit of a coordinate
};
/// The twist of a body, taken at a point of space, that each independent coordinate's speed gives. @param out (u_count)
void jacobian(const Mechanism& m, const Pose& pose, int body, Vec3d point, std::span<Twist> out) noexcept;
/// All bodies' twists, taken at their frames' origins, at speeds `du` of the independent coordinates.
/// @param dq (q_count) scratch: the speeds of all coordinates  @param out (bodies)
void velocities(const Mechanism& m, const Pose& pose, std::span<const double> du, std::span<double> dq,
                std::span<Twist> out) noexcept;
/// dq = E du
void expand_speeds(const Mechanism& m, std::span<const double> du, std::span<double> dq) noexcept;

/// The first coordinate beyond its limits by more than `slack` [rad, m], or -1.
int beyond_limits(const Mechanism& m, std::span<const double> q, double slack = 1e-9) noexcept;

}  // namespace trocar::kinematics
