#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>

#include "linkages.hpp"

namespace trocar::kinematics {
namespace {

constexpr double kPi = portable::pi;

/// Seven hinges in turn about z and y, 0.7 m long, and a shaft of 0.4 m with two more at its end.
MechanismDescription redundant_arm() {
  MechanismDescription d;
  d.name = "redundant_arm";
  const double along[] = {0.16, 0.14, 0.2, 0.1, 0.2, 0.1, 0.1};
  std::string parent = "ground";
  for (int k = 0; k < 7; ++k) {
    Link l = link_of("j" + std::to_string(k + 1), parent, JointKind::revolute, at(0, 0, along[k]),
                     k % 2 ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, k % 2 ? 0.6 : 0.1);
    l.joint.limits = {k % 2 ? -2.1 : -2.9, k % 2 ? 2.1 : 2.9};
    d.links.push_back(l);
    parent = l.name;
  }
  Link pitch = link_of("pitch", parent, JointKind::revolute, at(0, 0, 0.4), {1, 0, 0});
  Link yaw = link_of("yaw", "pitch", JointKind::revolute, at(0, 0, 0.009), {0, 1, 0});
  pitch.joint.limits = yaw.joint.limits = {-1.4, 1.4};
  d.links.push_back(pitch);
  d.links.push_back(yaw);
  d.frames = {{"tip", "yaw", at(0, 0, 0.01)}, {"shaft", "j7", {}}};
  return d;
}

double apart(const Frame& a, const Frame& b) { return length(a.p - b.p) + length(turn_between(a.r, b.r)); }

TEST(Inverse, ReachesWhereForwardCameFromAndKeepsTheRemoteCentre) {
  const Mechanism m = build(redundant_arm());
  InverseWork work(m, 8);
  core::Random random(21);
  Pose pose(m);
  int one_attempt = 0;
  const int rounds = 300;
  for (int k = 0; k < rounds; ++k) {
    std::vector<double> u(std::size_t(m.u_count()));
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = random.uniform(0.9 * m.low[i], 0.9 * m.high[i]);
    forward(m, u, pose);
    const Frame wanted = place(m.frames[0], pose), shaft = place(m.frames[1], pose);
    const Vec3d port = shaft * Vec3d{0, 0, 0.25};
    const Closure goals[] = {reach(m.frames[0], wanted), through(m.frames[1], port)};
    std::vector<double> v = m.start_u();
    const InverseReport report = inverse(m, goals, v, work);
    ASSERT_TRUE(report.reached()) << k << ": " << words(m, report);
    forward(m, v, pose);
    EXPECT_LT(apart(place(m.frames[0], pose), wanted), 1e-9);
    const Frame now = place(m.frames[1], pose);
    EXPECT_LT(length(cross(port - now.p, now.r.column(2))), 1e-10) << "the shaft goes through the port";
    EXPECT_LT(beyond_limits(m, pose.q), 0);
    one_attempt += report.attempts == 1;
  }
  EXPECT_GT(one_attempt, rounds / 3);
}

TEST(Inverse, WhatTheGoalsLeaveFreeMovesCoordinatesWithinLimits) {
  // Three links in a plane for a point: one freedom to spare. Started beyond the elbow's limit it moves back.
  MechanismDescription d;
  d.links = {link_of("a", "ground", JointKind::revolute, {}, {0, 0, 1}, 0.2),
             link_of("b", "a", JointKind::revolute, at(0.1), {0, 0, 1}, 0.3),
             link_of("c", "b", JointKind::revolute, at(0.1), {0, 0, 1}, 0.4)};
  d.frames = {{"tip", "c", at(0.1)}};
  d.links[1].joint.limits = {0.35, 2};
  const Mechanism m = build(d);
  InverseWork work(m, 3);
  const Closure goal = reach(m.frames[0], {Mat3d::identity(), {0.25, 0.1, 0}}, kTx | kTy);
  std::vector<double> u{0.1, 0.2, 0.5};
  const InverseReport report = inverse(m, {&goal, 1}, u, work);
  EXPECT_TRUE(report.reached()) << words(m, report);
  EXPECT_EQ(report.last.idle(), 1);
  EXPECT_GE(u[1], 0.35 - 1e-9);
}

TEST(Inverse, SaysWhatIsOutOfReachAndHowFar) {
  MechanismDescription d;
  d.links = {link_of("a", "ground", JointKind::revolute, {}), link_of("b", "a", JointKind::revolute, at(0.1))};
  d.frames = {{"tip", "b", at(0.1)}};
  const Mechanism m = build(d);
  InverseWork work(m, 3);
  const Closure goal = reach(m.frames[0], {Mat3d::identity(), {0.18, 0.24, 0}}, kTx | kTy);
  std::vector<double> u{0.3, 0.5};
  const InverseReport report = inverse(m, {&goal, 1}, u, work);
  EXPECT_FALSE(report.reached());
  EXPECT_NEAR(report.last.metres, 0.1, 1e-5) << "0.3 m away, 0.2 m long";
  EXPECT_NE(words(m, report).find("out of reach"), std::string::npos);
}

TEST(Inverse, AnAngleBeyondItsLimitsIsTurnedRound) {
  MechanismDescription d;
  d.links = {link_of("a", "ground", JointKind::revolute, {})};
  d.links[0].joint.limits = {kPi, 3 * kPi};
  d.frames = {{"tip", "a", at(0.1)}};
  const Mechanism m = build(d);
  InverseWork work(m, 3);
  const Closure goal =
      reach(m.frames[0], {Mat3d::identity(), {0.1 * portable::cos(0.5), 0.1 * portable::sin(0.5), 0}}, kTx | kTy);
  std::vector<double> u{4};
  const InverseReport report = inverse(m, {&goal, 1}, u, work);
  EXPECT_TRUE(report.reached()) << words(m, report);
  EXPECT_NEAR(u[0], 0.5 + 2 * kPi, 1e-9);
}

}  // namespace
}  // namespace trocar::kinematics
