// Clips on a thread: what they tie holds by friction, what they stop stays, and they go where their thread goes.
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>

#include "figures.hpp"
#include "tying.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

const Vec3d kAxis{0, 0, 1}, kOpen{0, 1, 0};

/// A thread without weight that is led by its ends.
struct Led {
  ThreadModel m;
  ThreadState s;
  ThreadWork w;
  std::array<Hold, 2> holds;
  std::array<HoldReaction, 2> pulls;
  std::array<Passage, 2> passages;
  std::array<PassageReaction, 2> through;

  explicit Led(const std::vector<Vec3d>& path, const char* make = "PDS")
      : m(build({.stuff = find_thread("3-0", make)->stuff, .length = 0.08, .gravity = {0, 0, 0}})),
        s(laid(m, path)),
        w(make_work(m)) {}
  void take_ends() {
    take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
    holds[0].x = s.x.front(), holds[1].x = s.x.back();
  }
  void clip(std::initializer_list<double> places) {
    ASSERT_TRUE(set_clip(m, s, 7, {places.begin(), places.size()}, kAxis, kOpen));
  }
  const ThreadClip& at() const { return s.clips.front(); }
  ThreadReport tick() {
    return advance(m, {.holds = holds, .passages = passages}, {.holds = pulls, .passages = through}, s, w);
  }
  void rest(int ticks) {
    for (int k = 0; k < ticks; ++k) tick();
  }
};

/// Two stretches beside each other, a slack bight beyond them; ends to both sides.
Led hairpin() {
  Led led({{0, 0, 0}, {0.039, 0, 0}, {0.039, 0.002, 0}, {0.019, 0.002, 0}, {0.019, 0.004, 0}, {0.1, 0.004, 0}}, "silk");
  led.clip({0.025, 0.055});
  led.take_ends();
  return led;
}
/// Its ends are drawn apart until they bear so much; the most that they bore.
double draw(Led& led, double newtons, int ticks) {
  double most = 0;
  for (int k = 0; k < ticks; ++k) {
    const double pull = length(led.pulls[1].force);
    if (pull < newtons) led.holds[1].x.x += 2e-5;
    led.tick();
    most = std::max(most, length(led.pulls[1].force));
  }
  return most;
}

TEST(ThreadClips, TwoStretchesInAClipHoldTwoNewtonsAndSlipBeyondItsFriction) {
  Led led = hairpin();
  draw(led, 2, 4000);
  EXPECT_NEAR(length(led.pulls[1].force), 2, 0.3);
  const double a = led.at().s[0], b = led.at().s[1];
  EXPECT_NEAR(a, 0.025, 1e-9);
  EXPECT_NEAR(b, 0.055, 1e-9);
  led.rest(500);
  EXPECT_EQ(led.at().s[0], a);
  const double most = draw(led, 1.5 * kClipHolds, 1000);
  EXPECT_GT(most, 0.9 * kClipHolds);
  EXPECT_LT(most, 1.2 * kClipHolds);
  EXPECT_GT(std::fabs(led.at().s[0] - a) + std::fabs(led.at().s[1] - b), 0.005);
}

TEST(ThreadClips, StretchesThatAreNotClippedAreDrawnStraight) {
  Led led = hairpin();
  led.s.clip_count = 0;
  draw(led, 2, 1500);
  EXPECT_LT(length(led.pulls[1].force), 0.5);  // [N]: as long as the bight is not drawn out
  Led tied = hairpin();
  draw(tied, 2, 1500);
  EXPECT_GT(length(tied.pulls[1].force), 1.5);
}

/// A thread through a hole at 30 mm, its end drawn along it by jaws that bear so much.
Led through_hole(double newtons) {
  Led led({{-0.03, 0, 0}, {0.05, 0, 0}});
  open_passage(led.m, led.s, 0, 0.03);
  led.passages[0].stiffness = 2000;
  take_hold(led.m, led.s, 1, 0.06);
  led.holds[1].x = point_at(led.m, led.s, 0.06);
  led.holds[1].friction_limit = newtons;
  return led;
}
void draw_on(Led& led, double way) {
  for (int k = 0; k < int(way / 1e-5); ++k) led.holds[1].x.x += way > 0 ? 1e-5 : -1e-5, led.tick();
}

TEST(ThreadClips, AClipStopsAtAHoleThatTheThreadGoesThroughWithoutIt) {
  for (const bool clipped : {false, true}) {
    Led led = through_hole(1);
    if (clipped) led.clip({0.022});
    draw_on(led, 0.012);
    const double drawn = 0.03 - led.s.passages[0].s;
    if (clipped) {
      EXPECT_NEAR(drawn, 0.008 - kClipHalfWidth, 2e-5);
      EXPECT_NEAR(led.through[0].force.x, 1, 0.1) << "the tissue bears what is pulled with";
      EXPECT_NEAR(led.at().s[0], 0.022, 1e-9);
    } else {
      EXPECT_GT(drawn, 0.0115);
      EXPECT_LT(led.through[0].force.x, 0.1);
    }
  }
}

TEST(ThreadClips, AClipStopsFromTheOtherSideToo) {
  Led led = through_hole(0);
  led.clip({0.035});
  release_hold(led.s, 1);
  take_hold(led.m, led.s, 1, 0.015);
  led.holds[1] = {.x = point_at(led.m, led.s, 0.015), .friction_limit = 1};
  for (int k = 0; k < 1000; ++k) led.holds[1].x.x -= 1e-5, led.tick();
  EXPECT_NEAR(led.s.passages[0].s, 0.035 - kClipHalfWidth, 2e-5);
  EXPECT_NEAR(led.through[0].force.x, -1, 0.1);
}

TEST(ThreadClips, BeyondItsFrictionAClipSlidesAlongTheThreadBeforeTheHole) {
  Led led = through_hole(1.5 * kClipHolds);
  led.clip({0.028});
  draw_on(led, 0.015);
  EXPECT_LT(led.at().s[0], 0.022);
  EXPECT_NEAR(led.s.passages[0].s - led.at().s[0], kClipHalfWidth, 2e-5);
  EXPECT_NEAR(led.through[0].force.x, kClipHolds, 0.2);
}

TEST(ThreadClips, DrawnOffTheThreadsEndAClipIsGone) {
  Led led = through_hole(1.5 * kClipHolds);
  led.clip({0.003});
  draw_on(led, 0.045);
  EXPECT_EQ(led.s.clip_count, 0);
  EXPECT_EQ(clip_of(led.s, 7), nullptr);
}

TEST(ThreadClips, AClipGoesAndTurnsWithItsThread) {
  Led led({{-0.04, 0, 0}, {0.04, 0, 0}});
  led.clip({0.04});
  led.take_ends();
  for (int k = 0; k < 1000; ++k) {  // a quarter turn about z, in a second
    const double a = 0.5 * portable::pi * (k + 1) / 1000;
    led.holds[0].x = -0.04 * Vec3d{portable::cos(a), portable::sin(a), 0};
    led.holds[1].x = -led.holds[0].x;
    led.tick();
  }
  EXPECT_LT(length(led.at().at - point_at(led.m, led.s, 0.04)), 1e-5);
  EXPECT_GT(dot(led.at().axis_now, kAxis), 0.98);
  EXPECT_GT(dot(led.at().open_now, Vec3d{-1, 0, 0}), 0.98);
}

TEST(ThreadClips, AClipThatTiesTwoStretchesLiesOverBoth) {
  Led led = hairpin();
  draw(led, 2, 4000);
  const ThreadClip& c = led.at();
  const Vec3d a = point_at(led.m, led.s, c.s[0]), b = point_at(led.m, led.s, c.s[1]);
  EXPECT_LT(length(c.at - 0.5 * (a + b)), 1e-4);
  EXPECT_NEAR(dot(c.axis_now, c.open_now), 0, 1e-9);
  EXPECT_NEAR(length(b - a), c.apart[0], 2e-4);
}

TEST(ThreadClips, AThreadThatIsPartedBesideAClipLeavesItOnItsPiece) {
  Led led({{-0.04, 0, 0}, {0.04, 0, 0}});
  led.clip({0.04});
  led.take_ends();
  const int e = place_at(led.m, 0.04).element;
  cut(led.m, led.s, 0.04);
  const int on = place_at(led.m, led.at().s[0]).element;
  EXPECT_EQ(std::abs(on - e), 1);
  for (int k = 0; k < 500; ++k) led.holds[0].x.x -= 2e-5, led.holds[1].x.x += 2e-5, led.tick();
  ASSERT_EQ(led.s.clip_count, 1);
  EXPECT_EQ(place_at(led.m, led.at().s[0]).element, on);
  EXPECT_LT(length(led.at().at - 0.5 * (led.s.x[size_t(on)] + led.s.x[size_t(on) + 1])), led.m.spacing);
}

TEST(ThreadClips, AClipsWeightHangsOnItsThread) {
  for (const bool clipped : {false, true}) {
    Led led({{0, 0, 0}, {0, 0, -0.08}});
    led.m.gravity = {0, 0, -9.81};
    if (clipped) led.clip({0.078});
    take_hold(led.m, led.s, 0, 0);
    led.rest(2000);
    const double weight = led.m.stuff.mass * led.m.length + (clipped ? kClipMass : 0);
    EXPECT_NEAR(-led.pulls[0].force.z, 9.81 * weight, 0.02 * 9.81 * weight);
  }
}

TEST(ThreadClips, ThereIsNoneWhereThereIsNoThreadAndNoMoreThanThereIsRoomFor) {
  Led led({{-0.04, 0, 0}, {0.04, 0, 0}});
  const double beyond[1] = {0.2}, place[1] = {0.01};
  EXPECT_FALSE(set_clip(led.m, led.s, 0, beyond, kAxis, kOpen));
  cut(led.m, led.s, 0.01);
  EXPECT_FALSE(set_clip(led.m, led.s, 0, place, kAxis, kOpen));
  const double whole[1] = {0.05};
  for (int k = 0; k < kMostThreadClips; ++k) EXPECT_TRUE(set_clip(led.m, led.s, k, whole, kAxis, kOpen));
  EXPECT_FALSE(set_clip(led.m, led.s, 99, whole, kAxis, kOpen));
}

}  // namespace
