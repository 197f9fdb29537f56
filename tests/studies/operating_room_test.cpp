#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/studies/operating_room/motion.hpp>
#include <trocar/studies/operating_room/ports.hpp>

namespace trocar::studies {
namespace {

const RoomModel& shipped() {
  static const RoomModel model(scene::read_room(TROCAR_SOURCE_DIR "/scenes/rooms/telemanipulated.json"));
  return model;
}
scene::Programme programme(const std::string& name) {
  return scene::read_programme(TROCAR_SOURCE_DIR "/scenes/rooms/programmes/" + name + ".json", shipped().room());
}
bool has(const MotionReport& r, MotionFaultKind kind) {
  return std::any_of(r.faults.begin(), r.faults.end(), [&](const MotionFault& f) { return f.kind == kind; });
}
std::string told(const MotionReport& r) {
  std::string all;
  for (const MotionFault& f : r.faults) all += std::to_string(f.from) + " " + f.words + "\n";
  return all;
}

TEST(OperatingRoom, TableTiltTurnsGravityInThePatient) {
  const RoomModel& m = shipped();
  const Vec3d level = m.gravity({});
  EXPECT_NEAR(level.z, -9.81, 1e-12);
  const Vec3d down = m.gravity({0.3, 0});  // head down: what is loose falls to the head
  EXPECT_NEAR(down.y, 9.81 * std::sin(0.3), 1e-9);
  EXPECT_NEAR(down.z, -9.81 * std::cos(0.3), 1e-9);
  const Vec3d left = m.gravity({0, 0.2});  // left side down
  EXPECT_NEAR(left.x, 9.81 * std::sin(0.2), 1e-9);
}

TEST(OperatingRoom, ADockedArmTurnsAboutItsPort) {
  const RoomModel& m = shipped();
  const RoomPose pose = m.start();
  for (int a = 0; a < int(m.arms().size()); ++a) {
    EXPECT_LT(port_gap(m.shaft(pose, a), m.arms()[std::size_t(a)].port), 1e-9);
    EXPECT_LT(m.figure().distance(m.tip(pose, a).p), 0) << "the tip is in the patient";
    EXPECT_GT(m.figure().distance(m.base(a, pose.tilt) * m.arms()[std::size_t(a)].hub), 0);
  }
}

TEST(OperatingRoom, AnArmOnTheFloorLosesItsPortWhereTheTableTiltsAndOneOnTheTableDoesNot) {
  scene::Room room = shipped().room();
  room.arms[1].on_table = false;
  const RoomModel m(room);
  RoomPose pose = m.start();
  EXPECT_LT(port_gap(m.shaft(pose, 1), m.arms()[1].port), 1e-9);
  pose.tilt.head_down += 0.1;
  EXPECT_LT(port_gap(m.shaft(pose, 0), m.arms()[0].port), 1e-9);
  EXPECT_GT(port_gap(m.shaft(pose, 1), m.arms()[1].port), 0.01);
}

TEST(OperatingRoom, JawAxesPointWhereTheyAreToldAndRollAboutIt) {
  for (const Vec3d d : {Vec3d{0, 0, -1}, Vec3d{0.3, 0.5, -0.6}, Vec3d{-0.2, 0.9, 0.1}}) {
    const Mat3d a = jaw_axes(d, 0.4), b = jaw_axes(d, 0.9);
    EXPECT_NEAR(length(-a.column(2) - d / length(d)), 0, 1e-12);
    EXPECT_NEAR(dot(a.column(0), b.column(0)), std::cos(0.5), 1e-12);
  }
}

TEST(OperatingRoom, AProgrammeKeepsItsPortsToATenthOfAMillimetreAndLoopsToTenToTheMinusTen) {
  const MotionReport r = go_through(shipped(), motion_of(shipped(), programme("triangle")), {});
  EXPECT_TRUE(r.good()) << told(r);
  EXPECT_EQ(r.count, 503) << "501 steps of 20 ms, and two middles of moves between them";
  EXPECT_LE(r.port_gap, 1e-4);
  EXPECT_LE(r.loop_gap, 1e-10);
  EXPECT_LE(r.most_speed, 1);
  EXPECT_GE(r.least_clearance, shipped().room().margin);
  for (const MotionStep& s : r.steps)
    for (const MotionStep::Arm& a : s.arms) EXPECT_LT(a.reached.missed, 1e-9) << s.at;
}

TEST(OperatingRoom, TipsAreWhereTheProgrammeSaysAtItsPosesAndHalfWayBetween) {
  const RoomMotion motion = motion_of(shipped(), programme("triangle"));
  EXPECT_NEAR(length(motion.goal(1, 2).tip - Vec3d{-0.045, 0.108, -0.105}), 0, 1e-15);
  EXPECT_NEAR(length(motion.goal(1, 1).tip - Vec3d{-0.0375, 0.1065, -0.0875}), 0, 1e-15);
  EXPECT_DOUBLE_EQ(least_jerk(0.5), 0.5);
  const double h = 1e-4;  // at rest in each pose
  EXPECT_LT(length(motion.goal(1, 2 + h).tip - motion.goal(1, 2).tip) / h, 1e-6);
}

TEST(OperatingRoom, AProgrammeThroughThePatientIsRefusedFromWhenItTouches) {
  const MotionReport r = go_through(shipped(), motion_of(shipped(), programme("too_far")), {});
  ASSERT_TRUE(has(r, MotionFaultKind::collision)) << told(r);
  const auto f = std::find_if(r.faults.begin(), r.faults.end(),
                              [](const MotionFault& x) { return x.kind == MotionFaultKind::collision; });
  EXPECT_GT(f->from, 2.2);
  EXPECT_LT(f->from, 6);
  // just before it the arm stood clear, at it it does not
  MotionOptions until;
  until.kept_every = 1;
  const MotionReport all = go_through(shipped(), motion_of(shipped(), programme("too_far")), until);
  for (const MotionStep& s : all.steps) {
    double least = 1;
    for (const MotionStep::Arm& a : s.arms) least = std::min(least, a.clearance);
    if (s.at < f->from - 1e-9) {
      EXPECT_GE(least, shipped().room().margin) << s.at;
    } else if (s.at < f->from + 1e-9) {
      EXPECT_LT(least, shipped().room().margin);
    }
  }
  EXPECT_TRUE(has(r, MotionFaultKind::speed)) << told(r);
}

/// The left arm's poses of "triangle", with some put in between, or all of it in less time.
scene::Programme leaping(const std::vector<scene::Programme::Pose>& put_in, double faster = 1) {
  scene::Programme p = programme("triangle");
  std::vector<scene::Programme::Pose>& poses = p.moves[0].poses;
  poses.insert(poses.begin() + 1, put_in.begin(), put_in.end());
  for (scene::Programme::Move& m : p.moves)
    for (scene::Programme::Pose& pose : m.poses) pose.at /= faster;
  return p;
}

TEST(OperatingRoom, ALeapBetweenTwoStepsIsSeen) {
  const Vec3d there{-0.062, 0.108, -0.098}, away{-0.5, -0.5, -0.5};
  const MotionReport far = go_through(
      shipped(),
      motion_of(shipped(),
                leaping({{1.005, there, true, {}, 0}, {1.01, away, true, {}, 0}, {1.015, there, true, {}, 0}})),
      {});
  EXPECT_FALSE(far.good());
  EXPECT_TRUE(has(far, MotionFaultKind::reach) || has(far, MotionFaultKind::limit)) << told(far);
  EXPECT_TRUE(has(far, MotionFaultKind::speed)) << told(far);
  // Within reach, there and back between two steps.
  const Vec3d near = there + Vec3d{0.004, 0, 0};
  const MotionReport twitch = go_through(
      shipped(),
      motion_of(shipped(),
                leaping({{1.005, there, true, {}, 0}, {1.006, near, true, {}, 0}, {1.007, there, true, {}, 0}})),
      {});
  ASSERT_TRUE(has(twitch, MotionFaultKind::speed)) << told(twitch);
  EXPECT_NE(told(twitch).find("1.006"), std::string::npos) << told(twitch);
  EXPECT_NE(told(twitch).find(" s needs "), std::string::npos) << told(twitch);
}

TEST(OperatingRoom, PosesCloserThanArmsCanMoveCannotBeDoneHoweverShortTheyAre) {
  for (const double faster : {100.0, 1e6}) {
    const MotionReport r = go_through(shipped(), motion_of(shipped(), leaping({}, faster)), {});
    EXPECT_TRUE(has(r, MotionFaultKind::speed)) << faster << told(r);
    EXPECT_GT(r.most_speed, 10) << faster;
  }
}

TEST(OperatingRoom, TheGreatestSpeedOfAShortMoveIsFoundWithinAPercentOfAFineLook) {
  const scene::Programme quick = leaping({}, 20);  // moves of 75 to 150 ms
  MotionOptions fine;
  fine.step = 5e-4;
  const double looked = go_through(shipped(), motion_of(shipped(), quick), {}).most_speed;
  const double finely = go_through(shipped(), motion_of(shipped(), quick), fine).most_speed;
  EXPECT_NEAR(looked, finely, 0.02 * finely);
}

TEST(OperatingRoom, ATableThatTiltsFasterThanItCanIsTold) {
  scene::Programme p = programme("triangle");
  const scene::RoomTilt from = shipped().room().table.tilt;
  p.tilts = {{0, from}, {4, {from.head_down + 0.05, from.left_down}}};
  EXPECT_FALSE(has(go_through(shipped(), motion_of(shipped(), p), {}), MotionFaultKind::speed));
  p.tilts[1].at = 0.01;
  const MotionReport r = go_through(shipped(), motion_of(shipped(), p), {});
  ASSERT_TRUE(has(r, MotionFaultKind::speed)) << told(r);
  EXPECT_NE(told(r).find("the table would move at"), std::string::npos) << told(r);
}

TEST(OperatingRoom, ATableThatTiltsFurtherThanItCanIsToldWhen) {
  scene::Programme p = programme("triangle");
  p.tilts = {{0, shipped().room().table.tilt}, {4, {-0.7, 0}}};
  const MotionReport r = go_through(shipped(), motion_of(shipped(), p), {});
  ASSERT_TRUE(has(r, MotionFaultKind::tilt));
  for (const MotionFault& f : r.faults)
    if (f.kind == MotionFaultKind::tilt) {
      EXPECT_GT(f.from, 1);
      EXPECT_LT(f.from, 4);
    }
}

TEST(OperatingRoom, WhatIsOutOfReachIsToldWithHowFarItMisses) {
  scene::Programme p = programme("triangle");
  p.moves.erase(p.moves.begin());
  p.moves[0].poses = {{0, {-0.03, 0.105, -0.07}, false, {}, 0}, {2, {-0.02, 0.125, -0.48}, false, {}, 0}};
  const MotionReport r = go_through(shipped(), motion_of(shipped(), p), {});
  ASSERT_TRUE(has(r, MotionFaultKind::reach) || has(r, MotionFaultKind::limit)) << told(r);
}

TEST(OperatingRoom, ARedundantArmGoesAsideAlongWhatItsGoalLeavesFree) {
  const RoomModel& m = shipped();
  RoomPose pose = m.start();
  const int arm = m.arm("left");
  ArmGoal goal{{-0.062, 0.108, -0.098}, true, {}};
  goal.axes = jaw_axes(goal.tip - m.arms()[std::size_t(arm)].port, 0);
  ASSERT_TRUE(m.lead(pose, arm, goal).reached);
  const auto least = [&] {
    double d = 1e9;
    for (const Near& n : m.nearest(pose))
      if (n.arm == arm || n.other == arm) d = std::min(d, n.distance);
    return d;
  };
  const double before = least();
  EXPECT_NEAR(m.clear(pose, arm, goal, 0), before, 1e-12);
  const double after = m.clear(pose, arm, goal, 40);
  EXPECT_NEAR(after, least(), 1e-12);
  EXPECT_GT(after, before + 0.003);
  EXPECT_LT(length(m.tip(pose, arm).p - goal.tip), 1e-9);
  EXPECT_LT(port_gap(m.shaft(pose, arm), m.arms()[std::size_t(arm)].port), 1e-9);
}

TEST(OperatingRoom, TheSameMotionComesOutTheSame) {
  const RoomMotion motion = motion_of(shipped(), programme("triangle"));
  MotionOptions coarse;
  coarse.step = 0.1;
  const MotionReport a = go_through(shipped(), motion, coarse), b = go_through(shipped(), motion, coarse);
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t k = 0; k < a.steps.size(); ++k) EXPECT_EQ(a.steps[k].pose.u, b.steps[k].pose.u);
}

PortPlanOptions gallbladder() {
  PortPlanOptions o;
  o.low = shipped().room().targets[0].low;
  o.high = shipped().room().targets[0].high;
  o.scope = "umbilical";
  return o;
}

TEST(PortPlanning, PrefersPairsWhoseManipulationAngleIsSixtyDegrees) {
  const PortPlan plan = plan_ports(shipped(), gallbladder());
  ASSERT_EQ(plan.pairs.size(), 5u);
  for (const PortPair& p : plan.pairs) {
    EXPECT_GT(p.manipulation, 40 * portable::pi / 180);
    EXPECT_LT(p.manipulation, 80 * portable::pi / 180);
    EXPECT_LT(plan.candidates[std::size_t(p.left)].azimuth, 0);
    EXPECT_GT(plan.candidates[std::size_t(p.right)].azimuth, 0);
    EXPECT_GT(p.clearance, 0);
    EXPECT_GT(p.patient_clearance, 0);
  }
}

TEST(PortPlanning, APairOfSixtyDegreesIsWorthMoreThanOneOfThirtyOrOfNinety) {
  const PortPlanOptions o = gallbladder();
  const Vec3d target = 0.5 * (o.low + o.high), scope{0, -0.01, 0};
  const auto pair = [&](double angle) {  // both at 60 degrees of elevation, whatever is asked of the skin
    PortCandidate c[2];
    for (int k = 0; k < 2; ++k) {
      c[k].alone = 1;
      c[k].azimuth = k == 0 ? -angle / 2 : angle / 2;
      const double s = (k == 0 ? -1 : 1) * std::sin(angle / 2);
      c[k].place = target + 0.13 * Vec3d{s, 0, std::sqrt(1 - s * s)};
    }
    return judge_pair(shipped(), o, scope, c[0], c[1]);
  };
  const auto degrees = [](double d) { return d * portable::pi / 180; };
  EXPECT_NEAR(pair(degrees(60)).manipulation, degrees(60), 1e-9);
  EXPECT_GT(pair(degrees(60)).score, 1.5 * pair(degrees(30)).score);
  EXPECT_GT(pair(degrees(60)).score, 1.5 * pair(degrees(90)).score);
}

TEST(PortPlanning, APortFromWhichTheTargetIsTooDeepOrTooSlantReachesNothing) {
  const PortPlanOptions o = gallbladder();
  EXPECT_EQ(judge_port(shipped(), o, {}, {0.13, -0.13, shipped().figure().front(0.13, -0.13)}).reach, 0);
  EXPECT_GT(judge_port(shipped(), o, {}, {-0.06, 0.08, shipped().figure().front(-0.06, 0.08)}).reach, 0.9);
}

TEST(PortPlanning, ArmsThatAreDockedAtTheBestSetReachTheTarget) {
  const PortPlan plan = plan_ports(shipped(), gallbladder());
  EXPECT_TRUE(plan.pairs[0].with_arms);
  EXPECT_GT(plan.pairs[0].arms_reach, 0.8);
  EXPECT_GT(plan.pairs[0].arms_clearance, 0);
  for (std::size_t k = 1; k < plan.pairs.size(); ++k) EXPECT_GE(plan.pairs[k - 1].rank, plan.pairs[k].rank);
}

/// A closed box.
InTheWay box(const std::string& name, Vec3d low, Vec3d high) {
  InTheWay organ{name, {}};
  for (int k = 0; k < 8; ++k)
    organ.mesh.positions.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  organ.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                          {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return organ;
}

TEST(WaysIn, SayHowMuchOfAWayIsInsideAndNothingOfWhatSurroundsItsEnd) {
  const InTheWay organ = box("liver", {-0.01, -0.01, -0.02}, {0.01, 0.012, 0.02});
  EXPECT_NEAR(way_through(organ.mesh, {0.001, 0.002, 0.1}, {0.001, 0.002, -0.1}), 0.04, 1e-12);
  EXPECT_NEAR(way_through(organ.mesh, {-0.1, 0.003, 0.001}, {0.1, 0.003, 0.001}), 0.02, 1e-12);
  EXPECT_EQ(way_through(organ.mesh, {0.001, 0.002, 0.1}, {0.001, 0.002, 0}), 0) << "it ends in there";
  EXPECT_EQ(way_through(organ.mesh, {0.02, 0, 0.1}, {0.02, 0, -0.1}), 0) << "past it";
  const WaysIn ways = ways_in({organ}, {0, 0, 0.1}, {{0, 0, -0.1}, {0.05, 0, -0.1}, {0.001, 0, -0.1}, {0.06, 0, 0}});
  EXPECT_EQ(ways.blocked, 0.5);
  EXPECT_EQ(ways.first, "liver");
  EXPECT_GT(ways.longest, 0.039);
}

TEST(PortPlanning, APortFromWhichAllWaysGoThroughAnOrganIsWorthATenth) {
  PortPlanOptions o = gallbladder();
  const Vec3d place{-0.06, 0.08, shipped().figure().front(-0.06, 0.08)}, middle = 0.5 * (o.low + o.high);
  const PortCandidate free = judge_port(shipped(), o, {}, place);
  EXPECT_EQ(free.ways.blocked, 0);
  const Vec3d between = 0.5 * (place + middle);
  o.organs = {box("omentum", between - Vec3d{0.05, 0.05, 0.005}, between + Vec3d{0.05, 0.05, 0.005})};
  const PortCandidate blocked = judge_port(shipped(), o, {}, place);
  EXPECT_EQ(blocked.ways.blocked, 1);
  EXPECT_EQ(blocked.ways.first, "omentum");
  EXPECT_NEAR(blocked.alone, 0.1 * free.alone, 1e-12);
}

TEST(PortPlanning, PrefersPortsWithAFreeWayToThoseWhoseWayIsBlocked) {
  PortPlanOptions o = gallbladder();
  o.set_up = false;
  const PortPlan before = plan_ports(shipped(), o);
  const Vec3d place = before.candidates[std::size_t(before.pairs[0].left)].place;
  const Vec3d between = place + 0.4 * (before.target - place);
  o.organs = {box("omentum", between - Vec3d{0.03, 0.03, 0.005}, between + Vec3d{0.03, 0.03, 0.005})};
  const PortPlan after = plan_ports(shipped(), o);
  EXPECT_GT(length(after.candidates[std::size_t(after.pairs[0].left)].place - place), 0.01);
  EXPECT_LT(after.candidates[std::size_t(after.pairs[0].left)].ways.blocked, 0.5);
}

TEST(PortPlanning, BasesThatAreTurnedAboutTheirPortsReachNoLessThanThoseThatAreNot) {
  PortPlanOptions o = gallbladder();
  o.set_up = false;
  const PortPlan fixed = plan_ports(shipped(), o);
  o.set_up = true;
  const PortPlan turned = plan_ports(shipped(), o);
  EXPECT_GE(turned.pairs[0].rank, fixed.pairs[0].rank);
  int gained = 0;
  for (const PortPair& p : turned.pairs) gained += p.turned[0] != 0 || p.turned[1] != 0;
  for (const PortPair& p : fixed.pairs) EXPECT_EQ(p.turned[0], 0);
  std::printf("    %d of %zu sets with a base turned; rank %.3f, without %.3f\n", gained, turned.pairs.size(),
              turned.pairs[0].rank, fixed.pairs[0].rank);
}

TEST(OperatingRoom, ABaseFartherFromItsColumnThanSetUpJointsReachIsTold) {
  scene::Room room = shipped().room();
  for (int a = 0; a < 2; ++a) EXPECT_LE(shipped().beyond_set_up(a), 0) << a;
  room.arms[0].x -= 2;
  EXPECT_GT(RoomModel(room).beyond_set_up(0), 0.5);
}

TEST(OperatingRoom, AHandThatCannotReachItsInstrumentIsTold) {
  scene::Room room = shipped().room();
  const RoomModel near(room);
  EXPECT_EQ(near.person(0, near.start()).beyond_reach, 0);
  room.staff[0].x = 1.6;
  const RoomModel far(room);
  EXPECT_GT(far.person(0, far.start()).beyond_reach, 0.5);
}

}  // namespace
}  // namespace trocar::studies
