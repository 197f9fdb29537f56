#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/dynamics/dynamics.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/kinematics/loops/close.hpp>
#include <trocar/kinematics/loops/conditions.hpp>
#include <trocar/kinematics/loops/mobility.hpp>

#include "../count_allocations.hpp"
#include "linkages.hpp"

namespace trocar::kinematics {
namespace {

/// K1 cos(rocker) - K2 cos(crank) + K3 - cos(crank - rocker), both angles from the ground line. [Freudenstein 1955]
double freudenstein(double a, double b, double c, double d, double crank, double rocker) {
  const double k1 = d / a, k2 = d / c, k3 = (a * a - b * b + c * c + d * d) / (2 * a * c);
  return k1 * portable::cos(rocker) - k2 * portable::cos(crank) + k3 - portable::cos(crank - rocker);
}

TEST(Loops, SlopesOfEveryKindOfClosureAreDifferencesOfResiduals) {
  core::Random random(11);
  for (const unsigned directions : {unsigned(kT), unsigned(kT | kRx | kRy), unsigned(kTx | kTy | kR), unsigned(kTy),
                                    unsigned(kTx | kRz), unsigned(kT | kR)}) {
    MechanismDescription d = four_bar(0.02, 0.05, 0.04, 0.06, 0.3, -0.2, 1.2);
    d.links[1].joint.kind = JointKind::spherical;
    d.links[1].joint.start = {0.1, 0.2, -0.2};
    d.links[0].joint.kind = JointKind::cylindrical;
    d.links[0].joint.start = {0.3, 0.01};
    d.actuators.clear();
    d.closures[0].directions = directions;
    const Mechanism m = build(d);
    Pose pose(m);
    std::vector<double> u = m.start_u();
    const int rows = m.rows, n = m.u_count();
    std::vector<double> j(std::size_t(rows * n)), up(static_cast<std::size_t>(rows)),
        down(static_cast<std::size_t>(rows));
    const bool rigid = (directions & kR) == kR;  // exact only without a turn between the frames
    if (rigid) {
      for (double& x : u) x = 0;
      forward(m, u, pose);
      EXPECT_LT(length(turn_between(place(m.closures[0].a, pose).r, place(m.closures[0].b, pose).r)), 1e-12);
    }
    forward(m, u, pose);
    slopes(m, m.closures, pose, j.data(), rows);
    for (int k = 0; k < n; ++k) {
      const double h = 1e-6, was = u[std::size_t(k)];
      u[std::size_t(k)] = was + h;
      forward(m, u, pose);
      residuals(m.closures, pose, up.data());
      u[std::size_t(k)] = was - h;
      forward(m, u, pose);
      residuals(m.closures, pose, down.data());
      u[std::size_t(k)] = was;
      for (int i = 0; i < rows; ++i)
        EXPECT_NEAR(j[std::size_t(k * rows + i)], (up[std::size_t(i)] - down[std::size_t(i)]) / (2 * h), 1e-9)
            << directions << " " << i << " " << k;
    }
  }
}

TEST(Loops, AFourBarMeetsFreudensteinsEquationAllRound) {
  // crank-rocker: the shortest and the longest together are shorter than the others [Grashof 1883]
  const double a = 0.020, b = 0.050, c = 0.045, d = 0.055;
  const Mechanism m = build(four_bar(a, b, c, d, 0.3, 0.5, 1.5));
  LoopWork work(m);
  hold(work, {0});
  std::vector<double> u = m.start_u();
  ASSERT_TRUE(close(m, u, work).closed());
  const Branch branch = branch_at(m, u, work);
  for (int k = 1; k <= 72; ++k) {
    const MoveReport moved = move(m, u, {{0, 0.3 + k * portable::two_pi / 72}}, branch, work);
    ASSERT_TRUE(moved.arrived()) << k << ": " << words(m, moved);
    EXPECT_LT(moved.last.metres, 1e-12);
    EXPECT_NEAR(freudenstein(a, b, c, d, u[0], u[2]), 0, 1e-10) << k;
    EXPECT_GT(branch_share(m, branch, work), 0);
  }
  EXPECT_EQ(work.free.size(), 2u);
}

TEST(Loops, GrashofsRuleSaysWhetherACrankTurnsRound) {
  core::Random random(12);
  int round = 0, not_round = 0;
  for (int n = 0; n < 60; ++n) {
    double l[4];
    for (double& x : l) x = random.uniform(0.02, 0.06);
    const auto [a, b, c, d] = l;
    const double shortest = std::min({a, b, c, d}), longest = std::max({a, b, c, d}), sum = a + b + c + d;
    const double margin = sum - 2 * (shortest + longest);
    if (std::fabs(margin) < 0.002) continue;  // too near a change point to ask
    const bool turns = margin > 0 && (shortest == a || shortest == d);
    Mechanism m = build(four_bar(a, b, c, d, 0, 0, 0));
    LoopWork work(m);
    // A pose that closes: where a triangle of crank and ground leaves one of coupler and rocker.
    double crank = -1;
    for (int k = 0; k < 64 && crank < 0; ++k) {
      const double q = portable::two_pi * k / 64, gap2 = a * a + d * d - 2 * a * d * portable::cos(q);
      if (gap2 < (b + c) * (b + c) * 0.96 && gap2 > (b - c) * (b - c) * 1.04) crank = q;
    }
    if (crank < 0) continue;
    hold(work, {0});
    std::vector<double> u;
    bool closed = false;
    for (int k = 0; k < 12 && !closed; ++k) {
      u = {crank, 0.5 * k, 0.55 * k + 1};
      closed = close(m, u, work).closed();
    }
    ASSERT_TRUE(closed);
    const Branch branch = branch_at(m, u, work);
    const MoveReport moved = move(m, u, {{0, crank + portable::two_pi}}, branch, work);
    EXPECT_EQ(moved.arrived(), turns) << a << " " << b << " " << c << " " << d << ": " << words(m, moved);
    EXPECT_EQ(moved.singular, !turns) << words(m, moved);
    (turns ? round : not_round)++;
  }
  EXPECT_GT(round, 4);
  EXPECT_GT(not_round, 20);
}

TEST(Loops, AParallelogramToldOfItsChangePointDoesNotFoldOver) {
  const Mechanism m = build(four_bar(0.02, 0.05, 0.02, 0.05, 1, -1, 1));
  LoopWork work(m);
  hold(work, {0});
  std::vector<double> u = m.start_u();
  ASSERT_TRUE(close(m, u, work).closed());
  const MoveReport moved = move(m, u, {{0, 4.0}}, branch_at(m, u, work), work);
  EXPECT_FALSE(moved.arrived());
  EXPECT_TRUE(moved.singular);
  EXPECT_NEAR(u[0], portable::pi, 2e-3) << "all links on one line";
  EXPECT_NE(words(m, moved).find("singular"), std::string::npos);
  std::vector<double> flat{portable::pi, -portable::pi, portable::pi};
  LoopOptions options;
  options.rank = 2;
  const LoopReport there = close(m, flat, work, options);
  EXPECT_EQ(there.status, LoopStatus::singular) << words(m, there);
}

TEST(Loops, OutOfReachSaysByHowMuch) {
  const Mechanism m = build(four_bar(0.02, 0.03, 0.02, 0.08, 0, 0, portable::pi));
  LoopWork work(m);
  hold(work, {0});
  std::vector<double> u = m.start_u();
  u[1] = 0.1;
  const LoopReport report = close(m, u, work);
  EXPECT_EQ(report.status, LoopStatus::out_of_reach);
  EXPECT_NEAR(report.metres, 0.01, 1e-4) << "20 + 30 + 20 mm do not span 80";
  EXPECT_NE(words(m, report).find("out of reach"), std::string::npos);
}

TEST(Loops, ASliderCrankIsWhereItsFormulaSays) {
  const double crank = 0.02, rod = 0.07, offset = 0.005;
  MechanismDescription d;
  d.name = "slider_crank";
  d.links = {link_of("crank", "ground", JointKind::revolute, {}, {0, 0, 1}, 0.4),
             link_of("rod", "crank", JointKind::revolute, at(crank)),
             link_of("slider", "ground", JointKind::prismatic, at(0, offset), {1, 0, 0}, 0.08)};
  d.closures = {{"pin", kT | kRx | kRy, {"", "rod", at(rod)}, {"", "slider", {}}}};
  const Mechanism m = build(d);
  LoopWork work(m);
  hold(work, {0});
  std::vector<double> u = m.start_u();
  for (int k = 0; k < 90; ++k) {
    u[0] = 0.4 + k * portable::two_pi / 90;
    const LoopReport report = close(m, u, work);
    ASSERT_TRUE(report.closed()) << words(m, report);
    const double y = offset - crank * portable::sin(u[0]);
    EXPECT_NEAR(u[2], crank * portable::cos(u[0]) + std::sqrt(rod * rod - y * y), 1e-13);
  }
}

TEST(Loops, BricardsLoopHasOneFreedomThatNoCountFinds) {
  const Mechanism m = build(bricard(0.05));
  std::vector<double> u(5, portable::pi / 2 - 0.1);
  const Mobility found = mobility(m, u);
  EXPECT_EQ(found.mobility, 1) << words(found);
  EXPECT_EQ(found.counted, 0) << "five hinges left, five conditions";
  EXPECT_TRUE(found.over_constrained());
  EXPECT_GT(found.smallest, 1e4 * found.largest_none) << "a gap, not a guess";
  EXPECT_NE(words(found).find("over-constrained but consistent"), std::string::npos);
}

TEST(Loops, BricardsLoopMovesClosedAlongItsFreedom) {
  const Mechanism m = build(bricard(0.05));
  LoopWork work(m);
  std::vector<double> u(5, portable::pi / 2 - 0.1);
  ASSERT_TRUE(close(m, u, work).closed());
  hold(work, {0});
  const double from = u[0];
  const MoveReport moved = move(m, u, {{0, from + 0.5}}, branch_at(m, u, work), work);
  EXPECT_TRUE(moved.arrived()) << words(m, moved);
  EXPECT_LT(moved.last.metres, 1e-12);
  EXPECT_LT(moved.last.radians, 1e-12);
  EXPECT_EQ(moved.last.rank, 4);
  EXPECT_EQ(moved.last.redundant(), 1);
  for (int k = 2; k < 5; ++k) EXPECT_NEAR(u[std::size_t(k)], u[std::size_t(k - 2)], 1e-9) << "hinges go by threes";
  // cos a + cos b + cos a cos b = 0 of neighbouring hinges
  EXPECT_NEAR(portable::cos(u[0]) + portable::cos(u[1]) + portable::cos(u[0]) * portable::cos(u[1]), 0, 1e-9);
}

TEST(Loops, ClosingAllocatesNothing) {
  const Mechanism m = build(four_bar(0.020, 0.050, 0.045, 0.055, 0.3, 0.5, 1.5));
  LoopWork work(m);
  hold(work, {0});
  std::vector<double> u = m.start_u();
  Mechanism changed = m;
  std::vector<double> p = m.parameter_values;
  const long before = g_allocations;
  for (int k = 0; k < 20; ++k) {
    p[0] = 0.02 + 1e-5 * k;
    changed.assign(p);
    close(changed, u, work);
  }
  EXPECT_EQ(g_allocations - before, 0);
}

TEST(Loops, ReachingAndAStepOfDynamicsAllocateNothingEither) {
  MechanismDescription d = four_bar(0.020, 0.050, 0.045, 0.055, 0.3, 0.5, 1.5);
  d.frames = {{"knee", "rocker", at(0.045)}};
  for (Link& l : d.links) l.mass = 0.01, l.centre = {0.01, 0, 0}, l.inertia = {1e-6, 1e-6, 1e-6, 0, 0, 0};
  const Mechanism m = build(d);
  InverseWork reaching(m, 6);
  DynamicsWork moving(m);
  MotionState s{m.start_u(), std::vector<double>(3, 0.0)};
  std::vector<double> u = m.start_u();
  const long before = g_allocations;
  const Closure goal = reach(m.frames[0], {Mat3d::identity(), {0.05, 0.044, 0}}, kTx);
  const bool reached = inverse(m, {&goal, 1}, u, reaching).reached();
  MotionStatus status = project(m, s, moving);
  for (int k = 0; k < 5 && status == MotionStatus::good; ++k) status = step(m, {}, 1e-4, s, moving);
  EXPECT_EQ(g_allocations - before, 0);
  EXPECT_TRUE(reached);
  EXPECT_EQ(status, MotionStatus::good);
}

TEST(Loops, ClosingGivesTheSameBitsFromTheSamePose) {
  const Mechanism m = build(bricard(0.05));
  LoopWork one(m), other(m);
  std::vector<double> u(5, 1.4), v(5, 1.4);
  close(m, u, one);
  for (double& x : other.slope) x = std::nan("");
  for (double& x : other.r) x = std::nan("");
  close(m, v, other);
  EXPECT_EQ(u, v);
}

}  // namespace
}  // namespace trocar::kinematics
