// What is cut parts, what is clipped stays together, what is laid has its length.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>

#include "figures.hpp"
#include "tying.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

std::vector<Vec3d> level(double length) { return {{0, 0, 0}, {length, 0, 0}}; }

TEST(ThreadParts, ACutThreadFallsApartAndOneThatIsNotHangs) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "silk")->stuff, .length = 0.06});
  for (const bool parted : {false, true}) {
    ThreadState s = laid(m, level(0.06));
    ThreadWork w = make_work(m);
    take_hold(m, s, 0, 0);
    const Hold hold[1] = {};
    if (parted) cut(m, s, 0.03);
    for (int k = 0; k < 250; ++k) advance(m, {.holds = hold}, {}, s, w);
    const double beyond = -s.x[m.nodes - 1].z;
    if (parted)
      EXPECT_GT(beyond, 0.2);  // free fall: 0.3 m
    else
      EXPECT_LT(beyond, 0.061);
  }
}

TEST(ThreadParts, AClipKeepsTwoPlacesTogetherAgainstAPullAndLetsThemGo) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "silk")->stuff, .length = 0.08, .gravity = {0, 0, 0}});
  const double side = 0.02;  // a hairpin: 0.02 and 0.06 lie beside each other
  ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {0.039, 0, 0}, {0.039, 0.002, 0}, {-0.1, 0.002, 0}});
  ThreadWork w = make_work(m);
  const double apart = length(point_at(m, s, side) - point_at(m, s, 0.06));
  tie(m, s, 0, side, 0.06);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  holds[0].x = s.x.front(), holds[1].x = s.x.back();
  HoldReaction pulls[2];
  for (int k = 0; k < 1000; ++k) {
    holds[0].x.y -= 1e-5, holds[1].x.y += 1e-5;
    advance(m, {.holds = holds}, {.holds = pulls}, s, w);
  }
  EXPECT_NEAR(length(point_at(m, s, side) - point_at(m, s, 0.06)), apart, 1e-4);
  untie(s, 0);
  for (int k = 0; k < 500; ++k) advance(m, {.holds = holds}, {}, s, w);
  EXPECT_GT(length(point_at(m, s, side) - point_at(m, s, 0.06)), 2 * apart);
}

TEST(ThreadParts, AThreadIsLaidAtItsLengthAlongAnyPath) {
  const ThreadModel m = build({.stuff = find_thread("4-0", "PDS")->stuff, .length = 0.15});
  const ThreadState s = laid(m, laid_overhand(2, 0.15, 0.01, m.stuff.diameter));
  for (int e = 0; e + 1 < m.nodes; ++e) EXPECT_NEAR(length(s.x[e + 1] - s.x[e]), m.spacing, 1e-12);
}

TEST(ThreadParts, AShaftSweptThroughAThreadTakesItAlong) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "silk")->stuff, .length = 0.1, .most_solves = 6});
  for (const double speed : {0.05, 0.5, 2.0}) {  // the last is faster than a tick can follow
    ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {0, 0, -1}});
    ThreadWork w = make_work(m);
    take_hold(m, s, 0, 0);
    const Hold hold[1] = {};
    Obstacle shaft[1] = {{.present = true, .a = {-0.01, -0.1, -0.05}, .b = {-0.01, 0.1, -0.05}, .radius = 0.0025}};
    std::uint32_t flags = 0;
    for (int k = 0; k < int(0.03 / speed * 1000); ++k) {
      shaft[0].a.x += speed * m.tick, shaft[0].b.x += speed * m.tick;
      flags |= advance(m, {.holds = hold, .obstacles = shaft}, {}, s, w).flags;
    }
    for (int k = 0; k < 50; ++k) advance(m, {.holds = hold, .obstacles = shaft}, {}, s, w);
    EXPECT_GT(point_at(m, s, 0.06).x, shaft[0].a.x) << speed;
    EXPECT_EQ((flags & ThreadReport::kLagging) != 0, speed > 1) << speed;
  }
}

TEST(ThreadParts, AnObstacleDoesNotWaitForAnotherThatIsFarBehind) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "silk")->stuff, .length = 0.1, .most_solves = 6});
  ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {0, 0, -1}});
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0);
  const Hold hold[1] = {};
  Obstacle rods[2] = {{.present = true, .a = {-0.004, -0.1, -0.05}, .b = {-0.004, 0.1, -0.05}, .radius = 0.0025},
                      {.present = true, .a = {0, 1, 0}, .b = {0, 1.1, 0}, .radius = 0.0025}};
  double lag = 0, behind = 0;
  for (int k = 0; k < 200; ++k) {
    rods[0].a.x += 0.05 * m.tick, rods[0].b.x += 0.05 * m.tick;
    rods[1].a.x += 5 * m.tick, rods[1].b.x += 5 * m.tick;
    lag = std::max(lag, advance(m, {.holds = hold, .obstacles = rods}, {}, s, w).lag);
    behind = std::max(behind, length(rods[0].a - s.obstacles[0].a));
  }
  EXPECT_GT(lag, 0.1);
  EXPECT_LT(behind, 1e-4);
}

TEST(ThreadParts, AThreadThatCannotFollowPressesNoHarderThanItIsDrawn) {
  Tying rig({.stuff = find_thread("3-0", "PDS")->stuff, .most_solves = 6});
  rig.begin({1, 1});
  rig.pull();
  core::Random random(3);
  Vec3d jerks[2];
  const ThreadStuff& of = rig.m.stuff;
  double most = 0;
  int short_of = 0;
  for (int k = 0; k < 600; ++k) {
    if (k % 20 == 0)
      for (Vec3d& v : jerks) v = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)};
    for (int h = 0; h < 2; ++h) {
      Vec3d& x = rig.holds[h].x;
      x += rig.m.tick * jerks[h];
      if (length(x) > 0.06) x *= 0.06 / length(x);
    }
    const ThreadReport report = rig.tick();
    short_of += (report.flags & ThreadReport::kLagging) != 0;
    // both ends of what lies round the post, in three pieces at most
    const double pulls = 6 * (report.tension + of.bend * of.yield_curvature / rig.m.spacing);
    most = std::max(most, length(rig.presses[0].force) / pulls);
  }
  EXPECT_GT(short_of, 100);
  EXPECT_LT(most, 1);
  say("a post's press over what pulls, at most", most, "1");
}

TEST(ThreadParts, SizesAreFoundByNameAndTheirFiguresGrowWithTheirDiameter) {
  EXPECT_EQ(find_thread("3-0", "steel"), nullptr);
  EXPECT_EQ(find_thread("9-0", "PDS"), nullptr);
  for (const char* make : {"PDS", "silk", "polyester"}) {
    const ThreadKind* before = nullptr;
    for (const char* size : {"5-0", "4-0", "3-0", "2-0", "0"}) {
      const ThreadKind* kind = find_thread(size, make);
      ASSERT_NE(kind, nullptr) << size << make;
      EXPECT_NO_THROW(build({.stuff = kind->stuff}));
      if (before) {
        EXPECT_GT(kind->stuff.diameter, before->stuff.diameter);
        EXPECT_GT(kind->stuff.stretch, before->stuff.stretch);
        EXPECT_GT(kind->stuff.bend, before->stuff.bend);
        EXPECT_GT(kind->stuff.knotted_break_force, before->stuff.knotted_break_force);
      }
      before = kind;
    }
  }
}

TEST(ThreadParts, BuildingSaysWhatIsUnsound) {
  EXPECT_THROW(build({.stuff = {}}), std::invalid_argument);
  EXPECT_THROW(build({.stuff = find_thread("0", "PDS")->stuff, .length = -1}), std::invalid_argument);
  EXPECT_THROW(build({.stuff = find_thread("0", "PDS")->stuff, .most_solves = 0}), std::invalid_argument);
}

}  // namespace
