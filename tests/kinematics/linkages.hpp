// Linkages for tests, described in code.
#pragma once

#include <string>
#include <vector>

#include <trocar/kinematics/chains/mechanism.hpp>

namespace trocar::kinematics {

inline Placement at(double x, double y = 0, double z = 0, Vec3d turn = {}) {
  Placement p;
  p.at = {Quantity{x}, Quantity{y}, Quantity{z}};
  p.turn = {Quantity{turn.x}, Quantity{turn.y}, Quantity{turn.z}};
  return p;
}
inline Placement dh(double alpha, double a, double d, double theta) {
  Placement p;
  p.dh = true;
  p.at = {Quantity{a}, Quantity{}, Quantity{d}};
  p.turn = {Quantity{alpha}, Quantity{}, Quantity{theta}};
  return p;
}
inline Link link_of(std::string name, std::string parent, JointKind kind, Placement place, Vec3d axis = {0, 0, 1},
                    double start = 0) {
  Link l;
  l.name = std::move(name);
  l.parent = std::move(parent);
  l.joint.kind = kind;
  l.joint.place = std::move(place);
  l.joint.axis = axis;
  if (kind == JointKind::revolute || kind == JointKind::prismatic) l.joint.start = {start};
  return l;
}

/// In the plane: ground length d along x, crank a, coupler b, rocker c (parameters of these names).
inline MechanismDescription four_bar(double a, double b, double c, double d, double crank, double coupler,
                                     double rocker) {
  MechanismDescription m;
  m.name = "four_bar";
  m.parameters = {
      {"a", Measure::length, a}, {"b", Measure::length, b}, {"c", Measure::length, c}, {"d", Measure::length, d}};
  const auto along = [](int parameter) {
    Placement p;
    p.at[0].terms = {{parameter, 1}};
    return p;
  };
  m.links = {link_of("crank", "ground", JointKind::revolute, {}, {0, 0, 1}, crank),
             link_of("coupler", "crank", JointKind::revolute, along(0), {0, 0, 1}, coupler),
             link_of("rocker", "ground", JointKind::revolute, along(3), {0, 0, 1}, rocker)};
  LoopClosure loop;
  loop.name = "pin";
  loop.directions = kT | kRx | kRy;
  loop.a = {"", "coupler", along(1)};
  loop.b = {"", "rocker", along(2)};
  m.closures = {loop};
  m.actuators = {{"motor", "crank", {0}, {portable::two_pi}}};
  return m;
}

/// Six equal links, axes at right angles [Bricard 1897]: a loop of six hinges that moves although it should not.
inline MechanismDescription bricard(double edge) {
  MechanismDescription m;
  m.name = "bricard";
  // The classical one: a = edge, twists of 90 and 270 degrees in turn, no offsets; closed at joint angles that repeat.
  const double q = portable::pi / 2;
  for (int i = 0; i < 5; ++i) {
    const double twist = i == 0 ? 0 : (i % 2 ? q : -q);
    m.links.push_back(link_of("l" + std::to_string(i + 1), i == 0 ? "ground" : "l" + std::to_string(i),
                              JointKind::revolute, dh(twist, i == 0 ? 0 : edge, 0, 0)));
  }
  LoopClosure loop;
  loop.name = "hinge";
  loop.directions = kT | kRx | kRy;
  loop.a = {"", "l5", dh(q, edge, 0, 0)};
  loop.b = {"", "ground", dh(q, -edge, 0, 0)};
  m.closures = {loop};
  return m;
}

}  // namespace trocar::kinematics
