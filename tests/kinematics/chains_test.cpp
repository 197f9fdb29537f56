#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/chains/mechanism.hpp>

#include "linkages.hpp"

namespace trocar::kinematics {
namespace {

/// One of everything that joints can be, turned and moved anyhow.
MechanismDescription zoo() {
  MechanismDescription d;
  d.name = "zoo";
  const JointKind kinds[] = {JointKind::revolute,  JointKind::cylindrical, JointKind::universal, JointKind::fixed,
                             JointKind::spherical, JointKind::planar,      JointKind::helical,   JointKind::prismatic};
  core::Random random(5);
  std::string parent = "ground";
  for (const JointKind kind : kinds) {
    const auto r = [&] { return random.uniform(-1, 1); };
    Link l = link_of("l" + std::to_string(int(kind)), parent, kind,
                     at(0.1 * r(), 0.1 * r(), 0.1 * r(), {r(), r(), r()}), {r(), r(), r()});
    l.joint.pitch = {0.02};
    l.joint.start.clear();
    parent = l.name;
    d.links.push_back(l);
  }
  return d;
}
std::vector<double> random_u(const Mechanism& m, core::Random& random) {
  std::vector<double> u(std::size_t(m.u_count()));
  for (double& x : u) x = random.uniform(-1, 1);
  return u;
}

TEST(Chains, TwoLinksOfAPlanarArmAreWhereTrigonometrySays) {
  MechanismDescription d;
  d.links = {link_of("upper", "ground", JointKind::revolute, {}),
             link_of("fore", "upper", JointKind::revolute, at(0.3))};
  d.frames = {{"tip", "fore", at(0.2)}};
  const Mechanism m = build(d);
  Pose pose(m);
  const double q1 = 0.4, q2 = 0.9;
  forward(m, std::vector<double>{q1, q2}, pose);
  const Vec3d tip = place(m.frames[0], pose).p;
  EXPECT_NEAR(tip.x, 0.3 * portable::cos(q1) + 0.2 * portable::cos(q1 + q2), 1e-15);
  EXPECT_NEAR(tip.y, 0.3 * portable::sin(q1) + 0.2 * portable::sin(q1 + q2), 1e-15);
  EXPECT_EQ(tip.z, 0);
}

TEST(Chains, JacobiansOfEveryKindOfJointAreDifferencesOfForward) {
  const Mechanism m = build(zoo());
  EXPECT_EQ(m.u_count(), 1 + 2 + 2 + 3 + 3 + 1 + 1);  // a screw's slide follows its turn
  core::Random random(6);
  const int tip = int(m.bodies.size()) - 1;
  for (int round = 0; round < 10; ++round) {
    std::vector<double> u = random_u(m, random);
    Pose pose(m), up(m), down(m);
    forward(m, u, pose);
    std::vector<Twist> j(u.size());
    const Vec3d point = pose.frames[std::size_t(tip)] * Vec3d{0.03, -0.02, 0.05};
    jacobian(m, pose, tip, point, j);
    for (std::size_t k = 0; k < u.size(); ++k) {
      const double h = 1e-6, was = u[k];
      u[k] = was + h;
      forward(m, u, up);
      u[k] = was - h;
      forward(m, u, down);
      u[k] = was;
      const Frame a = down.frames[std::size_t(tip)], b = up.frames[std::size_t(tip)];
      const Vec3d move = (b * Vec3d{0.03, -0.02, 0.05} - a * Vec3d{0.03, -0.02, 0.05}) / (2 * h);
      const Vec3d turn = turn_between(a.r, b.r) / (2 * h);
      EXPECT_LT(length(move - j[k].move), 1e-9) << m.coordinates[std::size_t(m.independent[k])];
      EXPECT_LT(length(turn - j[k].turn), 1e-8) << m.coordinates[std::size_t(m.independent[k])];
    }
  }
}

TEST(Chains, VelocitiesAreTheJacobianTimesTheSpeeds) {
  const Mechanism m = build(zoo());
  core::Random random(7);
  const std::vector<double> u = random_u(m, random), du = random_u(m, random);
  Pose pose(m);
  forward(m, u, pose);
  std::vector<double> dq(m.coordinates.size());
  std::vector<Twist> all(m.bodies.size()), j(u.size());
  velocities(m, pose, du, dq, all);
  for (std::size_t body = 1; body < m.bodies.size(); ++body) {
    jacobian(m, pose, int(body), pose.frames[body].p, j);
    Twist sum;
    for (std::size_t k = 0; k < u.size(); ++k) sum.turn += du[k] * j[k].turn, sum.move += du[k] * j[k].move;
    EXPECT_LT(length(sum.turn - all[body].turn), 1e-14);
    EXPECT_LT(length(sum.move - all[body].move), 1e-14);
  }
}

TEST(Chains, AScrewMovesByItsPitchInATurn) {
  MechanismDescription d;
  Link screw = link_of("screw", "ground", JointKind::helical, {}, {0, 0, 1});
  screw.joint.pitch = {0.008};
  d.links = {screw};
  const Mechanism m = build(d);
  Pose pose(m);
  forward(m, std::vector<double>{portable::two_pi}, pose);
  EXPECT_NEAR(pose.frames.back().p.z, 0.008, 1e-15);
}

TEST(Chains, CouplingsAddUpThroughEachOther) {
  // a wheel drives b at -1/2, c goes with b and the wheel: a differential
  MechanismDescription d;
  d.motors = {{"wheel", Measure::angle, {}, {}}};
  d.links = {link_of("b", "ground", JointKind::revolute, {}), link_of("c", "b", JointKind::revolute, at(0.1))};
  d.couplings = {{"c", {0.1}, {{"b", {3}}, {"wheel", {0.25}}}}, {"b", {0.2}, {{"wheel", {-0.5}}}}};
  const Mechanism m = build(d);
  ASSERT_EQ(m.u_count(), 1);
  Pose pose(m);
  forward(m, std::vector<double>{0.8}, pose);
  const double b = 0.2 - 0.4;
  EXPECT_NEAR(pose.q[std::size_t(m.coordinate("b"))], b, 1e-15);
  EXPECT_NEAR(pose.q[std::size_t(m.coordinate("c"))], 0.1 + 3 * b + 0.2, 1e-15);
}

TEST(Chains, EveryDimensionIsAParameterAndMovesWhatItSays) {
  const Mechanism m = build(four_bar(0.02, 0.05, 0.04, 0.06, 0.3, 0, 0));
  std::vector<double> p = m.parameter_values;
  ASSERT_GE(m.parameter("a"), 0);
  ASSERT_GE(m.parameter("coupler.at.z"), 0) << "a number in the description is one, too";
  p[std::size_t(m.parameter("a"))] = 0.025;
  p[std::size_t(m.parameter("coupler.at.z"))] = 0.001;
  const Mechanism other = m.with(p);
  Pose pose(other);
  forward(other, std::vector<double>{0, 0, 0}, pose);
  EXPECT_EQ(pose.frames[std::size_t(other.link_body[std::size_t(other.link("coupler"))])].p, (Vec3d{0.025, 0, 0.001}));
  Mechanism back = other;
  back.assign(m.parameter_values);
  for (std::size_t i = 0; i < m.places.size(); ++i) {
    EXPECT_EQ(back.places[i].p, m.places[i].p);
    for (int j = 0; j < 3; ++j) EXPECT_EQ(back.places[i].r.column(j), m.places[i].r.column(j));
  }
}

TEST(Chains, FaultsOfADescriptionAreAllTold) {
  MechanismDescription d = four_bar(0.02, 0.05, 0.04, 0.06, 0.3, 0, 0);
  d.links[1].parent = "cranck";
  d.links[2].name = "crank";
  d.links[0].joint.limits = {1, -1};
  d.couplings = {{"nothing", {}, {}}};
  d.closures[0].directions = 0;
  std::vector<std::string> told;
  for (const MechanismFault& f : check(d)) told.push_back(f.field);
  for (const char* field : {"parent", "name", "limits", "coordinate", "directions"})
    EXPECT_TRUE(std::find(told.begin(), told.end(), field) != told.end()) << field;
  EXPECT_THROW(build(d), std::invalid_argument);
  MechanismDescription circle = four_bar(0.02, 0.05, 0.04, 0.06, 0.3, 0, 0);
  circle.links[0].parent = "coupler";
  circle.actuators.clear();
  circle.couplings = {{"crank", {}, {{"rocker", {1}}}}, {"rocker", {}, {{"crank", {1}}}}};
  int circles = 0;
  for (const MechanismFault& f : check(circle)) circles += f.message.find("cycle") != f.message.npos;
  EXPECT_EQ(circles, 4) << "two links, two couplings";
}

}  // namespace
}  // namespace trocar::kinematics
