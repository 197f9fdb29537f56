// A loop of thread that a tube brings in: the box trainer's appendage of foam.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_strangle.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/training/observe/loops.hpp>
#include <trocar/training/observe/lumen_check.hpp>

#include "shipped.hpp"
#include "sling_driver.hpp"

namespace trocar {
namespace {

constexpr double kEnd = 0.045, kPlace = 0.022;  // [m] along the appendage

const sim::Model& box() { return shipped("box_loop"); }
int right_hand() { return box().hand_index("right"); }

/// Over the appendage and down to the place, once for all tests that go on from there.
const SlingDriver& over() {
  static const SlingDriver done = [] {
    SlingDriver d(box(), right_hand());
    d.put_over(0, kEnd, kPlace);
    return d;
  }();
  return done;
}
/// Drawn closed with 12 x 0.4 - 1 N.
const SlingDriver& closed() {
  static const SlingDriver done = [] {
    SlingDriver d = over();
    d.draw_closed(0, kPlace, 0.4, 6);
    return d;
  }();
  return done;
}
/// The handle opened, the tube 30 mm back.
void draw_back(SlingDriver& d) {
  d.grip(0, 0.5);
  d.rest(0.5);
  d.move(d.tip() + 0.03 * normalised(d.port() - d.tip()), 0.02);
  d.rest(0.5);
}
/// And the tail cut between knot and mouth.
void leave(SlingDriver& d) {
  draw_back(d);
  suture::cut(d.model().thread, d.state.objects.sutures[d.in_hand].thread, 0.5 * (d.sling().knot + d.sling().fed));
  d.rest(0.5);
}
const SlingDriver& left() {
  static const SlingDriver done = [] {
    SlingDriver d = closed();
    leave(d);
    return d;
  }();
  return done;
}
double place_of(const SlingDriver& d, size_t sling) {
  return arc_of(box(), d.state.objects.sutures[sling].sling.around[0].at);
}
double place_of(const SlingDriver& d) { return place_of(d, 0); }
/// A second loop, which the hand has taken at its trocar, 2.5 mm beside the first.
const SlingDriver& beside() {
  static const SlingDriver done = [] {
    SlingDriver d = left();
    d.grip(1, 0.3);
    d.move(d.port() + 0.008 * normalised(d.tip() - d.port()), 0.06);
    d.rest(0.2);
    d.in_hand = 1;
    d.put_over(0, kEnd, kPlace + 0.0025);
    d.draw_closed(0, kPlace + 0.0025, 0.4, 6);
    leave(d);
    return d;
  }();
  return done;
}
double cover_of(const SlingDriver& d) {
  double cover = 0;
  sim::visit_loops(box(), d.state, [&](const sim::LoopClosure& loop) { cover = std::max(cover, loop.cover); });
  return cover;
}
/// The appendage parted so far beyond the loop.
SlingDriver with_stump(double length) {
  SlingDriver d = left();
  const interactions::StrandBody& body = box().strand_bodies[0];
  int e = d.sling().around[0].at.element + 1;
  while (body.arc[size_t(e)] < place_of(d) + length - 0.00075) ++e;
  d.state.strands[0].alive[size_t(e)] = 0;
  d.rest(6);
  return d;
}

TEST(Sling, StandsOpenAsItIsBentByItself) {
  SlingDriver d(box(), right_hand());
  d.move({0.052, 0.055, -0.008});
  d.grip(0, 0.3);
  d.rest(3.5);
  ASSERT_EQ(d.sling().stage, interactions::SlingState::open);
  EXPECT_NEAR(d.sling().fed, box().objects.sutures.list[0].sling.loop, 1e-9);
  const interactions::SlingMouth& mouth = d.sling().mouth;
  double ahead = 0, wide = 0, off = 0;
  for (int n = 0; n * d.model().thread.spacing < d.sling().knot; ++n) {
    const Vec3d p = d.suture().thread.x[size_t(n)] - mouth.tip;
    ahead = std::max(ahead, dot(p, mouth.axis));
    wide = std::max(wide, std::fabs(dot(p, mouth.up)));
    off = std::max(off, std::fabs(dot(p, cross(mouth.axis, mouth.up))));
  }
  EXPECT_NEAR(ahead, 0.075, 0.002);
  EXPECT_NEAR(wide, 0.024, 0.002);
  EXPECT_LT(off, 0.004);  // its own weight
}

TEST(Sling, LedOverAFreeEndItLiesAroundTheAppendageAndPressesOnNothing) {
  ASSERT_EQ(over().sling().around_count, 1);
  EXPECT_LT(over().sling().tension, 0.05);
  EXPECT_EQ(cover_of(over()), 0);
}

/// What it grows out of may stand higher in the loop than the root does.
TEST(Sling, StillLiesAroundTheAppendageWellBelowItsRoot) {
  SlingDriver d = over();
  std::vector<Vec3d>& x = d.state.strands[0].x;
  const std::vector<Vec3d> from = x;
  const Vec3d shift = d.middle() - (from[0] - 0.02 * normalised(from[1] - from[0]));
  for (int tick = 0; tick < 8; ++tick) {
    for (size_t n = 0; n < x.size(); ++n) x[n] = from[n] + shift, d.state.strands[0].v[n] = {};
    d.step();
  }
  ASSERT_EQ(d.sling().around_count, 1);
  EXPECT_EQ(place_of(d), 0);
}

TEST(Sling, ClosesTheLumenByTheSameRuleAsClips) {
  EXPECT_GE(cover_of(closed()), 0.98);
  EXPECT_EQ(closed().told(sim::Event::loop_tightened), 1);
  training::LumenCheck check(box(), 0, 0.98);
  check.update(box(), over().state);
  EXPECT_FALSE(check.occluded());
  check.update(box(), closed().state);
  EXPECT_TRUE(check.occluded());
}

TEST(Sling, ClosesWhereItsKnotIsHeld) { EXPECT_NEAR(place_of(closed()), kPlace, 0.001); }

TEST(Sling, ItsKnotTakesANewtonToSlideForward) {
  const double rod = 12 * 0.4;
  EXPECT_NEAR(closed().sling().tension, rod - 1, 0.4);
}

TEST(Sling, CutsThroughAtEightNewtonsAndNotAtSix) {
  SlingDriver six = over(), more = over();
  six.draw_closed(0, kPlace, 0.58, 8);
  EXPECT_NEAR(six.sling().tension, 6, 0.5);
  EXPECT_EQ(six.told(sim::Event::loop_cut), 0);
  more.draw_closed(0, kPlace, 0.8, 8);
  EXPECT_EQ(more.told(sim::Event::loop_cut), 1);
}

/// Drawn closed, then with so much more in two seconds that the loop bears `newtons`, and a second of that.
struct DrawnWith {
  SlingDriver d = closed();
  double mean = 0, most = 0;  ///< of the loop's tension in that second, or until it cuts through [N]

  explicit DrawnWith(double newtons) {
    d.grip((newtons + 1) / 12, 2);
    int ticks = 0;
    for (; ticks < 1000 && d.told(sim::Event::loop_cut) == 0; ++ticks) {
      d.step();
      mean += d.sling().tension, most = std::max(most, d.sling().tension);
    }
    if (ticks > 0) mean /= ticks;
  }
};

TEST(Sling, HoldsAtTwoTenthsOfANewtonBelowEightAndCutsThroughAtTwoTenthsAbove) {
  const DrawnWith less(7.8), more(8.2);
  std::printf("mean %.3f N, most %.3f N\n", less.mean, less.most);
  EXPECT_NEAR(less.mean, 7.8, 0.1);
  EXPECT_EQ(less.d.told(sim::Event::loop_cut), 0);
  EXPECT_GE(cover_of(less.d), 0.98);
  EXPECT_EQ(more.d.told(sim::Event::loop_cut), 1);
}

TEST(Sling, StaysWithItsKnotWhenTheTailIsCut) {
  EXPECT_EQ(left().sling().stage, interactions::SlingState::left);
  EXPECT_EQ(left().told(sim::Event::loop_loosened), 0);
  EXPECT_EQ(training::secured_loops(box(), left().state, 0).count, 1);
  EXPECT_NEAR(place_of(left()), kPlace, 0.001);
  EXPECT_GE(cover_of(left()), 0.98);
  EXPECT_LT(left().sling().knot - closed().sling().knot, 0.0002);
}

TEST(Sling, TheHandWhoseBladesCutTheTailIsTheEventsHand) {
  SlingDriver d = closed();
  draw_back(d);
  const int blades = box().hand_index("left");
  const interactions::ToolModel& scissors = box().placed(std::size_t(blades));
  const std::size_t tail =
      std::size_t(suture::place_at(d.model().thread, 0.5 * (d.sling().knot + d.sling().fed)).element);
  const Vec3d at = d.suture().thread.x[tail], along = normalised(d.suture().thread.x[tail + 1] - at);
  const Vec3d axis = normalised(at - scissors.port), there = at + 0.5 * scissors.jaw_length * axis;
  const double roll = kinematics::roll_towards(kinematics::inverse(scissors.port, there, 0), along);
  std::vector<sim::Event> cuts;
  const int arrive = 800, close = 200;
  for (int tick = 0; tick < arrive + close; ++tick) {
    const Vec3d tip = there - 0.06 * std::max(0.0, 1 - double(tick) / (arrive - 300)) * axis;
    const double handle = std::clamp(double(tick - arrive) / (close - 50), 0.0, 1.0);
    d.input.tools[std::size_t(blades)] = sim::tool_input(kinematics::inverse(scissors.port, tip, roll), float(handle));
    const sim::StepReport report = d.step();
    for (int i = 0; i < report.event_count; ++i)
      if (report.events[i].kind == sim::Event::thread_cut) cuts.push_back(report.events[i]);
  }
  ASSERT_EQ(cuts.size(), 1u);
  EXPECT_EQ(cuts[0].hand, blades);
  EXPECT_EQ(cuts[0].body, BodyId(BodyKind::suture, 0));
  EXPECT_EQ(d.sling().stage, interactions::SlingState::left);
  EXPECT_EQ(d.told(sim::Event::thread_broken), 0);
}

TEST(Sling, AThreadThatIsPulledApartIsBrokenNotCutAndItsLoopIsNotSecured) {  // [knot pull]
  sim::Model weak = box();
  suture::ThreadStuff& stuff = weak.objects.sutures.list[0].thread.stuff;
  stuff.knotted_break_force = 3, stuff.break_force = 5;  // the handle pulls with 3.8 N
  SlingDriver d(weak, right_hand());
  d.put_over(0, kEnd, kPlace);
  ASSERT_EQ(d.told(sim::Event::thread_broken), 0);
  d.draw_closed(0, kPlace, 0.4, 6);
  EXPECT_EQ(d.told(sim::Event::thread_broken), 1);
  EXPECT_EQ(d.told(sim::Event::thread_cut), 0);
  EXPECT_EQ(d.suture().broken, 1);
  EXPECT_EQ(training::secured_loops(weak, d.state, 0).count, 0);
}

TEST(Sling, StaysOnAStumpOfSixMillimetres) {
  const SlingDriver d = with_stump(0.006);
  EXPECT_EQ(d.told(sim::Event::loop_slipped), 0);
  ASSERT_EQ(d.sling().around_count, 1);
  EXPECT_GE(cover_of(d), 0.98);
}

TEST(Sling, SlipsOffAStumpOfTwoMillimetresByItself) {
  const SlingDriver d = with_stump(0.002);
  EXPECT_EQ(d.told(sim::Event::loop_slipped), 1);
  EXPECT_EQ(d.sling().around_count, 0);
}

TEST(Sling, ASecondOneIsTakenAtTheTrocarAndBothHoldBesideEachOther) {
  const SlingDriver& d = beside();
  ASSERT_EQ(d.state.objects.sutures[0].sling.stage, interactions::SlingState::left);
  ASSERT_EQ(d.state.objects.sutures[1].sling.stage, interactions::SlingState::left);
  EXPECT_EQ(d.told(sim::Event::loop_slipped), 0);
  EXPECT_EQ(d.told(sim::Event::loop_loosened), 0);
  const training::SecuredLoops both = training::secured_loops(box(), d.state, 0);
  ASSERT_EQ(both.count, 2);
  EXPECT_LT(place_of(d, 0), place_of(d, 1));  // neither has gone over the other
  EXPECT_GT(both.at[1] - both.at[0], d.model().thread.stuff.diameter);
  EXPECT_NEAR(both.at[0], kPlace, 0.002);
  training::LumenCheck check(box(), 0, 0.98);
  check.update(box(), d.state);
  EXPECT_TRUE(check.occluded());
}

TEST(Sling, AKeyframeShowsWhatItsLoopsLieAround) {
  const sim::State& was = beside().state;
  sim::State read = sim::initial_state(box());
  ASSERT_TRUE(sim::restore_display(box(), sim::display_bytes(box(), was), read));
  std::vector<double> before, after;
  sim::visit_loops(box(), was, [&](const sim::LoopClosure& loop) { before.push_back(loop.radius); });
  sim::visit_loops(box(), read, [&](const sim::LoopClosure& loop) { after.push_back(loop.radius); });
  ASSERT_EQ(before.size(), 2u);
  EXPECT_EQ(before, after);
}

TEST(Sling, GoesWhereItsStrandGoesWithoutDrag) {
  for (const bool across : {false, true}) {
    SlingDriver d = left();
    const std::vector<Vec3d> from = d.state.strands[0].x;
    const Vec3d along = d.tangent(0, kPlace), way = across ? any_perpendicular(along) : along;
    const double place = place_of(d), speed = 0.1;
    double pull = 0;
    for (int tick = 0; tick < 200; ++tick) {
      for (size_t n = 0; n < from.size(); ++n) {
        d.state.strands[0].x[n] = from[n] + speed * tick * sim::kTick * way;
        d.state.strands[0].v[n] = speed * way;
      }
      d.step();
      ASSERT_EQ(d.sling().around_count, 1);
      pull = std::max(pull, length(d.sling().around[0].pull));
    }
    EXPECT_NEAR(place_of(d), place, 1e-4);
    EXPECT_LT(pull, 0.05);  // [N]
    EXPECT_NEAR(d.sling().tension, left().sling().tension, 0.1);
  }
}

/// What lies against one side of a strand that shakes by 0.3 mm, 60 times a second, presses as the depth says.
TEST(Sling, AWideOneAgainstOneSideIsNotPressedByItsStrandsVelocity) {
  SlingDriver d = over();
  while (d.sling().fed > 0.034) d.draw_closed(0, kPlace, 0.25, 0.01);
  d.grip(0.06, 0.2);
  ASSERT_EQ(d.sling().around_count, 1);
  ASSERT_FALSE(interactions::has_sunk_in(box().strand_bodies[0], d.sling().around[0]));
  const std::vector<Vec3d> from = d.state.strands[0].x;
  const Vec3d across = normalised(d.tip() - d.point(0, kPlace));
  const double sway = 0.0003, turns = 60 * 2 * portable::pi;
  double press = 0;
  for (int tick = 0; tick < 200; ++tick) {
    const double to = sway * portable::sin(turns * tick * sim::kTick);
    for (size_t n = 0; n < from.size(); ++n) {
      d.state.strands[0].x[n] = from[n] + to * across;
      d.state.strands[0].v[n] = sway * turns * portable::cos(turns * tick * sim::kTick) * across;
    }
    d.step();
    ASSERT_EQ(d.sling().around_count, 1);
    press = std::max(press, d.sling().around[0].press);
  }
  EXPECT_LT(press, 2);  // [N]
}

TEST(Sling, ItsInstrumentIsNotExchangedWhileTheLoopLiesAroundSomething) {
  SlingDriver d = closed();
  const std::int32_t had = d.state.tools[size_t(right_hand())].instrument;
  d.input.tools[right_hand()].instrument = had == 0 ? 1 : 0;
  d.rest(1);
  EXPECT_EQ(d.state.tools[size_t(right_hand())].instrument, had);
}

TEST(Sling, TheSameInputsGiveTheSameBits) {
  SlingDriver a = closed(), b = closed();
  b.work = sim::make_work(box());
  a.rest(0.2), b.rest(0.2);
  EXPECT_EQ(sim::hash_of(a.state), sim::hash_of(b.state));
}

}  // namespace
}  // namespace trocar
