// Friction of a thread on posts, in jaws, in tissue: Coulomb's, with a memory.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/suture/thread/thread.hpp>

#include "figures.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

constexpr double kPi = 3.14159265358979;

/// Drawn over a post by `turn` of an angle, its other end held back with `back` [N]. Ratio of the two pulls.
struct OverPost {
  double turn = kPi, friction = 0.2, back = 0.5, radius = 1.72e-3;
  ThreadStuff stuff = find_thread("3-0", "silk")->stuff;
  double speed = 0.01;

  double pull() const {
    const double d = stuff.diameter;
    const ThreadModel m = build({.stuff = stuff, .length = 0.12, .gravity = {0, 0, 0}});
    const double r = radius + 0.5 * d, pitch = 3 * d / (2 * kPi), lead = 0.02;
    std::vector<Vec3d> path{{r, -0.1, 0}};
    for (int i = 0; i <= 400; ++i) {
      const double a = turn * i / 400;
      path.push_back({r * std::cos(a), r * std::sin(a), pitch * a});
    }
    const Vec3d out{-std::sin(turn), std::cos(turn), 0};
    path.push_back(path.back() + 0.1 * out);
    path[0] = path[1] + Vec3d{0, -lead, 0};
    ThreadState s = laid(m, path);
    ThreadWork w = make_work(m);
    const double there = lead + turn * std::sqrt(r * r + pitch * pitch) + 0.01;
    take_hold(m, s, 0, 0.015), take_hold(m, s, 1, there);
    Hold holds[2];
    holds[0] = {.x = point_at(m, s, 0.015), .friction_limit = back};
    holds[1] = {.x = point_at(m, s, there)};
    const Obstacle post[1] = {{true, {0, 0, -0.05}, {0, 0, 0.05}, radius, friction}};
    HoldReaction pulls[2];
    double sum = 0, back_sum = 0;
    for (int k = 0; k < 1000; ++k) {
      holds[1].x += (speed * m.tick) * out;
      advance(m, {.holds = holds, .obstacles = post}, {.holds = pulls}, s, w);
      if (k >= 500) sum += length(pulls[1].force), back_sum += length(pulls[0].force);
    }
    return sum / back_sum;
  }
};

// K4. A thread of elements that turn by 15 degrees each is a polygon, which rubs by 0.8 % more.
TEST(ThreadFriction, APostHoldsAsTheCapstanSays) {
  for (const double turn : {0.5 * kPi, kPi, 2 * kPi, 4 * kPi}) {
    OverPost post{.turn = turn};
    post.stuff.bend = 1e-11, post.stuff.twist = 1e-11, post.stuff.yield_curvature = 0;
    expect_ratio("K4, capstan, turn of " + std::to_string(int(std::lround(turn * 180 / kPi))) + " degrees", post.pull(),
                 std::exp(0.2 * turn), 0.03);
  }
}

// K5. A stiff thread does not lie close to a small post as long as the pull is small: its law is not a power of one.
TEST(ThreadFriction, AStiffThreadsPullGrowsFasterThanInProportionAndInProportionWhenItLiesClose) {
  double pull[4];
  const double back[4] = {0.05, 0.2, 0.8, 3.2};
  for (int i = 0; i < 4; ++i) {
    OverPost post{.turn = kPi, .back = back[i], .radius = 1e-3};
    post.stuff = find_thread("3-0", "PDS")->stuff;
    post.stuff.yield_curvature = 0;
    pull[i] = post.pull();
    say("K5, ratio of pulls at a back pull of " + std::to_string(back[i]) + " N", pull[i], "thin: 1.87");
  }
  const auto exponent = [&](int i) { return 1 + std::log(pull[i + 1] / pull[i]) / std::log(back[i + 1] / back[i]); };
  expect_between("K5, exponent of the pull, small pulls", exponent(0), 1.03, 1.5);
  expect_between("K5, exponent of the pull, large pulls", exponent(2), 0.98, 1.03);
}

TEST(ThreadFriction, JawsLetSlipBeyondTheirLimitAndNotBefore) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.1, .gravity = {0, 0, 0}});
  ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}});
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0.02), take_hold(m, s, 1, 0.08);
  Hold holds[2];
  holds[0] = {.x = {0.02, 0, 0}, .friction_limit = 2};
  holds[1] = {.x = {0.08, 0, 0}};
  HoldReaction pulls[2];
  double slipped = 0;
  for (int k = 0; k < 150; ++k) {  // 1.5 mm stretch it by 2.5 %: 1.5 N
    holds[1].x.x += 1e-5;
    advance(m, {.holds = holds}, {.holds = pulls}, s, w);
    slipped += pulls[0].slipped;
  }
  EXPECT_NEAR(pulls[0].force.x, 1.5, 0.1);
  EXPECT_LT(std::fabs(slipped), 1e-9);
  for (int k = 0; k < 500; ++k) {
    holds[1].x.x += 1e-5;
    advance(m, {.holds = holds}, {.holds = pulls}, s, w);
    slipped += pulls[0].slipped;
  }
  expect_ratio("jaws of 2 N: pull while thread slips through", pulls[0].force.x, 2, 0.03);
  expect_ratio("what slipped [m]", slipped, 6.5e-3 - 0.06 * 2 / 60, 0.1);
  EXPECT_NEAR(s.holds[0].s, 0.02 - slipped, 1e-9);
}

/// Thread drawn round a corner in tissue: tensions on both sides.
TEST(ThreadFriction, InTissueTensionsKeepToTheCapstanAndTheDrag) {
  const ThreadStuff stuff = find_thread("3-0", "silk")->stuff;
  const ThreadModel m = build({.stuff = stuff, .length = 0.12, .gravity = {0, 0, 0}});
  ThreadState s = laid(m, std::vector<Vec3d>{{-0.03, 0, 0}, {0, 0, 0}, {0, 1, 0}});
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0.02), take_hold(m, s, 1, 0.05);
  open_passage(m, s, 0, 0.03);
  Hold holds[2];
  const double back = 0.3, drag = 0.05;
  holds[0] = {.x = point_at(m, s, 0.02), .friction_limit = back};
  holds[1] = {.x = point_at(m, s, 0.05)};
  Passage passage[1] = {{.x = {0, 0, 0}, .stiffness = 2000, .drag = drag}};
  HoldReaction pulls[2];
  PassageReaction through[1];
  double sum = 0, slipped = 0;
  for (int k = 0; k < 1500; ++k) {
    holds[1].x.y += 1e-5;
    advance(m, {.holds = holds, .passages = passage}, {.holds = pulls, .passages = through}, s, w);
    if (k >= 1000) sum += length(pulls[1].force) / 500, slipped += through[0].slipped;
  }
  const double expected = back * std::exp(stuff.friction_tissue * kPi / 2) + drag;
  expect_ratio("passage, a right angle: pull on the far side [N]", sum, expected, 0.1);
  EXPECT_GT(std::fabs(slipped), 4e-3);
  const double now = length(pulls[1].force);
  expect_ratio("what the tissue bears [N]", length(through[0].force), std::hypot(back, now), 0.1);
}

/// A way through a hole that is not the thread's own would drive it by what presses it there.
TEST(ThreadFriction, AThreadThatDoublesBackAtItsHoleIsNotDrivenIntoIt) {
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const ThreadModel m = build({.stuff = stuff, .length = 0.12, .gravity = {0, 0, 0}});
  const double turn = 150 * kPi / 180;
  ThreadState s = laid(m, std::vector<Vec3d>{{-0.03, 0, 0}, {0, 0, 0}, {std::cos(turn), std::sin(turn), 0}});
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0.02), take_hold(m, s, 1, 0.05);
  open_passage(m, s, 0, 0.03);
  const Vec3d taut{2e-4, 0, 0};  // both sides lie to the left of the hole
  Hold holds[2] = {{.x = point_at(m, s, 0.02) - taut, .friction_limit = 1}, {.x = point_at(m, s, 0.05) - taut}};
  Passage passage[1] = {{.x = {0, 0, 0}, .stiffness = 2000, .drag = 0.01}};
  PassageReaction through[1];
  double before = 0, fastest = 0;
  for (int k = 0; k < 2000; ++k) {
    advance(m, {.holds = holds, .passages = passage}, {.passages = through}, s, w);
    if (k == 1000) before = s.passages[0].s;
    for (const Vec3d& v : s.v) fastest = k < 1000 ? 0 : std::max(fastest, length(v));
  }
  say("doubled back: bears at its hole [N]", length(through[0].force), "two pulls");
  say("goes through it in a second [m]", std::fabs(s.passages[0].s - before), "none");
  say("fastest node [m/s]", fastest, "at rest");
  EXPECT_GT(length(through[0].force), 0.5);
  EXPECT_LT(std::fabs(s.passages[0].s - before), 1e-4);
  EXPECT_LT(fastest, 0.01);
}

TEST(ThreadFriction, ASlackThreadStaysOnASlopeBelowTheAngleOfFrictionAndSlidesAboveIt) {
  for (const double slope : {0.15, 0.25}) {  // tangents; the thread's friction on tissue is 0.2
    ThreadStuff stuff = find_thread("3-0", "silk")->stuff;
    const ThreadModel m = build({.stuff = stuff, .length = 0.03});
    ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0.5 * stuff.diameter}, {0, 1, 0.5 * stuff.diameter}});
    ThreadWork w = make_work(m);
    const Vec3d normal = normalised(Vec3d{-slope, 0, 1});
    std::vector<SkinContact> skins(std::size_t(m.nodes));
    for (int i = 0; i < m.nodes; ++i) skins[std::size_t(i)] = {.node = i, .normal = normal};
    for (int k = 0; k < 500; ++k) advance(m, {.skins = skins}, {}, s, w);
    const double before = s.x[10].x;
    for (int k = 0; k < 500; ++k) advance(m, {.skins = skins}, {}, s, w);
    const double moved = std::fabs(s.x[10].x - before);
    say("slope of " + std::to_string(slope) + ": slides in half a second [m]", moved, "friction 0.2");
    if (slope < 0.2)
      EXPECT_LT(moved, 1e-6);
    else
      EXPECT_GT(moved, 1e-3);
  }
}

}  // namespace
