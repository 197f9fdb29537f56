#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/dynamics/dynamics.hpp>
#include <trocar/kinematics/loops/conditions.hpp>

#include "linkages.hpp"

namespace trocar::kinematics {
namespace {

Link body(Link l, double mass, Vec3d centre, double inertia) {
  l.mass = mass;
  l.centre = centre;
  l.inertia = {inertia, inertia, inertia, 0, 0, 0};
  return l;
}

TEST(Dynamics, ADoublePendulumFollowsItsEquationsOfMotion) {
  const double l1 = 0.3, l2 = 0.2, m1 = 1.2, m2 = 0.7, g = 9.81;  // point masses at the ends, in the x-z plane
  MechanismDescription d;
  d.links = {body(link_of("a", "ground", JointKind::revolute, {}, {0, -1, 0}), m1, {0, 0, -l1}, 0),
             body(link_of("b", "a", JointKind::revolute, at(0, 0, -l1), {0, -1, 0}), m2, {0, 0, -l2}, 0)};
  const Mechanism m = build(d);
  DynamicsWork work(m);
  const double t1 = 0.7, t2 = 1.9, w1 = 2.1, w2 = -3.3;  // angles from the vertical
  ASSERT_EQ(accelerate(m, {}, {{t1, t2 - t1}, {w1, w2 - w1}}, work), MotionStatus::good);
  const double delta = t1 - t2, c = portable::cos(delta), s = portable::sin(delta);
  // (m1+m2) l1 a1 + m2 l2 c a2 = -m2 l2 s w2^2 - (m1+m2) g sin t1;  l1 c a1 + l2 a2 = l1 s w1^2 - g sin t2
  const double r1 = -m2 * l2 * s * w2 * w2 - (m1 + m2) * g * portable::sin(t1);
  const double r2 = l1 * s * w1 * w1 - g * portable::sin(t2);
  const double det = (m1 + m2) * l1 * l2 - m2 * l2 * c * l1 * c;
  const double a1 = (r1 * l2 - m2 * l2 * c * r2) / det, a2 = ((m1 + m2) * l1 * r2 - l1 * c * r1) / det;
  EXPECT_NEAR(work.acceleration[0], a1, 1e-11);
  EXPECT_NEAR(work.acceleration[1], a2 - a1, 1e-11);
}

TEST(Dynamics, ADoublePendulumKeepsItsEnergyToTheOrderOfTheIntegrator) {
  MechanismDescription d;
  d.links = {body(link_of("a", "ground", JointKind::revolute, {}, {0, -1, 0}), 1, {0, 0, -0.3}, 0.001),
             body(link_of("b", "a", JointKind::revolute, at(0, 0, -0.3), {0, -1, 0}), 0.5, {0, 0, -0.2}, 0.001)};
  const Mechanism m = build(d);
  DynamicsWork work(m);
  double drift[2];
  for (int k = 0; k < 2; ++k) {
    MotionState s{{1.5, 0.5}, {0, 0}};
    const double dt = 2e-3 / (1 << k), before = energy(m, s, work).total();
    for (int n = 0; n < 1000 << k; ++n) ASSERT_EQ(step(m, {}, dt, s, work), MotionStatus::good);
    drift[k] = std::fabs(energy(m, s, work).total() - before);
  }
  EXPECT_LT(drift[1], 1e-6);
  EXPECT_LT(drift[1], drift[0] / 12) << "halved steps: a sixteenth or less";
}

TEST(Dynamics, TorquesOfAMotionGiveThatMotion) {
  MechanismDescription d = four_bar(0.020, 0.050, 0.045, 0.055, 0.3, 0.5, 1.5);
  for (Link& l : d.links) l = body(l, 0.02, {0.02, 0, 0}, 1e-5);
  const Mechanism m = build(d);
  DynamicsWork work(m);
  MotionState s{m.start_u(), {3, 0, 0}};
  ASSERT_EQ(project(m, s, work), MotionStatus::good);
  const std::vector<double> wanted{0.05, 0, 0};
  ASSERT_EQ(accelerate(m, wanted, s, work), MotionStatus::good);
  const std::vector<double> acceleration = work.acceleration;
  std::vector<double> torques(3);
  const int driven[] = {0};
  EXPECT_LT(inverse_dynamics(m, s, acceleration, driven, torques, work), 1e-12);
  EXPECT_NEAR(torques[0], 0.05, 1e-12);
}

TEST(Dynamics, BricardsLoopSwingsWithoutDriftOfEnergyOrConditions) {
  MechanismDescription d = bricard(0.1);
  for (Link& l : d.links) {
    l = body(l, 0.1, {0.05, 0, 0}, 1e-4);
    l.joint.start = {portable::pi / 2 - 0.1};
  }
  const Mechanism m = build(d);
  DynamicsWork work(m);
  MotionState s{m.start_u(), std::vector<double>(5, 0.0)};
  ASSERT_EQ(project(m, s, work), MotionStatus::good);
  const double before = energy(m, s, work).total();
  double fastest = 0;
  for (int k = 0; k < 4000; ++k) {
    ASSERT_EQ(step(m, {}, 5e-4, s, work), MotionStatus::good) << k;
    const Energy e = energy(m, s, work);
    fastest = std::max(fastest, e.kinetic);
    ASSERT_NEAR(e.total(), before, 2e-8) << k;
  }
  EXPECT_GT(fastest, 0.01) << "it does swing";
  std::vector<double> r(std::size_t(m.rows));
  residuals(m.closures, work.pose, r.data());
  for (const double x : r) EXPECT_NEAR(x, 0, 1e-12);
}

TEST(Dynamics, ACoordinateWithoutMassIsTold) {
  MechanismDescription d;
  d.links = {link_of("a", "ground", JointKind::revolute, {})};
  const Mechanism m = build(d);
  DynamicsWork work(m);
  MotionState s{{0}, {0}};
  EXPECT_EQ(step(m, {}, 1e-3, s, work), MotionStatus::massless);
}

/// Andrews' squeezing mechanism: seven bodies in a plane, three loops. Dimensions, masses and inertias as in
/// [Hairer & Wanner 1996, VII.7] and in the Test Set for IVP Solvers (problem ANDREWS).
MechanismDescription andrews(const std::vector<double>& start) {
  const double rr = 7e-3, d = 28e-3, ss = 35e-3, e = 2e-2, zt = 4e-2, zf = 2e-2, u = 4e-2;
  const Placement at_a = at(-.06934, -.00227), at_b = at(-.03635, .03273);
  const auto hinge = [&](const char* name, const char* parent, Placement place, double q) {
    return link_of(name, parent, JointKind::revolute, std::move(place), {0, 0, 1}, q);
  };
  MechanismDescription m;
  m.name = "andrews";
  m.gravity = {};
  m.links = {body(hinge("k1", "ground", {}, start[0]), .04325, {92e-5, 0, 0}, 2.194e-6),
             body(hinge("k2", "k1", at(rr), start[1]), .00365, {-115e-4, 0, 0}, 4.410e-7),
             body(hinge("k3", "ground", at_b, start[2]), .02373, {1043e-5, -1874e-5, 0}, 5.255e-6),
             body(hinge("k5", "ground", at_a, start[4]), .07050, {2308e-5, 916e-5, 0}, 1.169e-5),
             body(hinge("k4", "k5", at(zt), start[3]), .00706, {0, -(e - 1421e-5), 0}, 5.667e-7),
             body(hinge("k7", "ground", at_a, start[6]), .05498, {449e-5, -1228e-5, 0}, 1.912e-5),
             body(hinge("k6", "k7", at(0, -u), start[5]), .00706, {zf - 1421e-5, 0, 0}, 5.667e-7)};
  const NamedFrame point{"", "k2", at(-d)};
  m.closures = {{"p3", kTx | kTy, {"", "k3", at(0, -ss)}, point},
                {"p4", kTx | kTy, {"", "k4", at(0, -e)}, point},
                {"p6", kTx | kTy, {"", "k6", at(zf)}, point}};
  m.springs = {{"spring", {"", "k3", at(2e-2, -18e-3)}, {"", "ground", at(.014, .072)}, 4530, 0, 0.07785}};
  return m;
}

// Where it stands and how fast after 0.03 s, as computed with tolerances of 1e-14: reference of the Test Set for IVP
// Solvers (CWI Amsterdam, INdAM Bari), problem ANDREWS. Angles beta, Theta, gamma, Phi, delta, Omega, epsilon.
TEST(Dynamics, AndrewsSqueezingMechanismIsWhereTheTestSetSays) {
  const std::vector<double> start{
      -0.06171389001427645, 0, 0.4552798191630704, 0.2226683901658859, 0.4873649795438426, -0.2226683901658859,
      1.230547444549821};
  const double first[] = {14222.44391995541, -10666.83293996559};
  const double y[] = {15.81077119629904,  -15.75637105984298, 0.04082224013073101, -0.5347301163226948,
                      0.5244099658805304, 0.5347301163226948, 1.048080741042263,   1139.920302151208,
                      -1424.379294994111, 11.03291221937134,  19.29337464421385,   0.5735699284790808,
                      -19.29337464421385, 0.3231791658026955};
  const double end = 0.03;
  const int order[] = {0, 1, 2, 4, 3, 6, 5};  // theirs of ours
  const Mechanism m = build(andrews(start));
  DynamicsWork work(m);
  const std::vector<double> torque{0.033, 0, 0, 0, 0, 0, 0};
  MotionState s{m.start_u(), std::vector<double>(7, 0.0)};
  std::vector<double> r(std::size_t(m.rows));
  ASSERT_EQ(accelerate(m, torque, s, work), MotionStatus::good);
  residuals(m.closures, work.pose, r.data());
  for (const double x : r) EXPECT_NEAR(x, 0, 1e-15);
  for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(work.acceleration[k], first[k], 1e-6);
  const int steps = 15'000;
  for (int k = 0; k < steps; ++k) ASSERT_EQ(step(m, torque, end / steps, s, work), MotionStatus::good) << k;
  for (int k = 0; k < 7; ++k) {
    EXPECT_NEAR(s.u[std::size_t(k)], y[std::size_t(order[k])], 1e-6);
    EXPECT_NEAR(s.du[std::size_t(k)] / y[std::size_t(7 + order[k])], 1, 1e-6);
  }
}

}  // namespace
}  // namespace trocar::kinematics
