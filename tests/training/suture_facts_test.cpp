// Facts of sutures, loops and injections, each by States that are written by hand: what they say, and when they say
// nothing.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_strangle.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/seen.hpp>
#include <trocar/suture/thread/paths.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/observe/watches.hpp>

#include "../sim/shipped.hpp"
#include "../sim/small_scene.hpp"

namespace trocar::training {
namespace {

using interactions::SlingState;
using interactions::SutureBite;
using interactions::SutureHole;

const sim::Model& box() { return shipped("box_suture"); }

/// A State that a test writes, and facts of it.
struct Sewn {
  const sim::Model& model;
  sim::State state = sim::initial_state(model);

  explicit Sewn(const sim::Model& of = box()) : model(of) {}
  interactions::SutureState& suture() { return state.objects.sutures.front(); }
  const interactions::SutureModel& thing() const { return suture_of(model); }
  Snapshot snapshot() const { return {model, state}; }

  Argument named(ArgumentKind kind, const std::string& name) const {
    Argument a;
    a.given = true;
    std::vector<std::string> known;
    EXPECT_TRUE(find_named(model, kind, name, a.index, known)) << name;
    return a;
  }
  Argument mark(const char* name) const { return named(ArgumentKind::mark, name); }
  Argument body(const char* name) const { return named(ArgumentKind::body, name); }
  Argument strand(const char* name) const { return named(ArgumentKind::strand, name); }
  static Argument number(double v) {
    Argument a;
    a.given = true;
    a.low = a.high = v;
    return a;
  }
  static Argument hand(int h) {
    Argument a;
    a.given = true;
    a.index = h;
    return a;
  }

  Value value(const Fact& fact, const Arguments& a = {}) const {
    EXPECT_EQ(fact.parameters.size(), a.size()) << fact.name;
    return fact.watch(model, a)->value(snapshot());
  }
  /// Of one that remembers, after as long.
  Value later(const Fact& fact, double seconds, const Arguments& a = {}) const {
    const auto observer = fact.watch(model, a);
    observer->sample(snapshot(), seconds);
    return observer->value(snapshot());
  }

  SutureBite& bite(SutureBite::Stage stage) {
    SutureBite& b = suture().bites[size_t(suture().bite_count++)];
    b = {};
    b.body = BodyId::organ(0);
    b.stage = stage;
    return b;
  }
  SutureHole& hole(double arc, int slot) {
    SutureHole& h = suture().holes[size_t(suture().hole_count++)];
    h = {};
    h.at.body = BodyId::organ(0);
    h.slot = slot;
    h.arc = float(arc);
    return h;
  }
  void hold(int hand, int place) {
    interactions::ToolState& tool = state.tools[size_t(hand)];
    tool.holds = 1;
    tool.hold[0].at.body = BodyId(BodyKind::suture, 0);
    tool.hold[0].at.element = place;
  }
  /// Throws of the whole thread, with the tissue in the loop below them.
  void tie(const std::vector<suture::Throw>& throws_) {
    suture::ThrowsPath path;
    path.throws_ = throws_;
    path.thickness = thing().thread.stuff.diameter;
    const std::vector<Vec3d> line = suture::laid_throws(path);
    suture().thread = suture::laid(thing().thread, line);
    double whole = 0;
    for (size_t i = 0; i + 1 < line.size(); ++i) whole += length(line[i + 1] - line[i]);
    hole(0.5 * whole, 0);
  }
};

#define EXPECT_UNTOLD(v) EXPECT_FALSE((v).known)
void expect_told(const Value& v, double expected, double tolerance = 1e-9) {
  ASSERT_TRUE(v.known);
  EXPECT_NEAR(v.number, expected, tolerance);
}

/// A node of the pad as a place that a needle went through.
interactions::MaterialPoint node(int n) {
  interactions::MaterialPoint p;
  p.body = BodyId::organ(0);
  p.count = 1;
  p.node[0] = n;
  p.weight[0] = 1;
  return p;
}

/// With what both hands pull at the suture in box(), for longer than an excursion; told as too hard so often.
int told_too_hard(Vec3d left, Vec3d right) {
  Sewn sewn;
  const Vec3d pull[] = {left, right};
  for (std::size_t h = 0; h < 2; ++h) {
    interactions::ToolState& tool = sewn.state.tools[h];
    tool.holds = 1, tool.hold[0].at.body = BodyId{BodyKind::suture, 0};
    tool.pull[0] = pull[h].x, tool.pull[1] = pull[h].y, tool.pull[2] = pull[h].z;
  }
  PullWatch watch;
  Incidents incidents;
  for (int tick = 0; tick < 300; ++tick)
    watch.update({.pull_limit = 5, .pull_limit_other = 8, .pull_excursion = 0.2}, {}, sewn.model, sewn.state,
                 incidents);
  return incidents.count;
}

TEST(PullAtASuture, IsTooHardByWhatIsLeftForTissueWhenHandsPullAtEachOther) {
  EXPECT_EQ(told_too_hard({9, 0, 0}, {-9, 0, 0}), 0) << "two hands hold the needle";
  EXPECT_EQ(told_too_hard({9, 0, 0}, {0, 0, 0}), 1) << "the other hand only holds on";
  EXPECT_EQ(told_too_hard({5, 0, 0}, {5, 0, 0}), 2) << "together";
  EXPECT_EQ(told_too_hard({4, 0, 0}, {3, 0, 0}), 0);
}

TEST(SutureFacts, BitesAreAsFarFromMarksAsTheyWereDrawn) {
  Sewn w;
  const Arguments in{w.mark("in_1")};
  EXPECT_UNTOLD(w.value(kSutureEntry, in));
  const int n = 40;
  SutureBite& bite = w.bite(SutureBite::open);
  bite.entry = bite.exit = node(n);
  const double off = length(sim::drawn_nodes(w.model, 0)[n] - Vec3d{0, 0.077, -0.070});
  expect_told(w.value(kSutureEntry, in), off, 2e-4);  // the mark lies on the skin as triangles have it
  EXPECT_UNTOLD(w.value(kSutureExit, in)) << "it has not come out";
  bite.stage = SutureBite::through;
  expect_told(w.value(kSutureExit, in), off, 2e-4);
  bite.stage = SutureBite::gone;
  EXPECT_UNTOLD(w.value(kSutureEntry, in));
}

TEST(SutureFacts, OnlyWaysFromEndToEndArePassages) {
  Sewn w;
  w.bite(SutureBite::through);
  w.bite(SutureBite::open);
  w.bite(SutureBite::through);
  w.bite(SutureBite::torn);
  expect_told(w.value(kSuturePassages, {w.body("pad")}), 2);
}

TEST(SutureFacts, ThreadIsDrawnThroughUpToTheNearestHole) {
  Sewn w;
  expect_told(w.value(kSutureDrawn), 0);
  w.hole(0.004, -1);
  expect_told(w.value(kSutureDrawn), 0);  // the needle's
  w.hole(0.050, 0);
  w.hole(0.030, 1);
  expect_told(w.value(kSutureDrawn), 0.030, 1e-8);
}

TEST(SutureFacts, ForcesAndWhatTheyHaveDoneAreTold) {
  Sewn w;
  expect_told(w.value(kSutureBroken), 0);
  expect_told(w.value(kSutureHarmed), 0);
  w.suture().peak = 1.5, w.suture().strain = 2.5, w.suture().torn = 3, w.suture().broken = 1;
  w.bite(SutureBite::through);
  w.bite(SutureBite::through).harmed = 1;
  expect_told(w.value(kSuturePeak), 1.5);
  expect_told(w.value(kSutureTension), 2.5);
  expect_told(w.value(kSutureTorn), 3);
  expect_told(w.value(kSutureBroken), 1);
  expect_told(w.value(kSutureHarmed), 1);
}

TEST(SutureFacts, AClipIsAsFarFromTissueAsTheThreadBetweenThem) {
  Sewn w;
  const auto clip_at = [&](double s) {
    suture::ThreadClip& c = w.suture().thread.clips[size_t(w.suture().thread.clip_count++)];
    c = {};
    c.count = 1, c.s[0] = s;
  };
  w.hole(0.040, 0);
  expect_told(w.value(kSutureClips), 0);
  EXPECT_UNTOLD(w.value(kSutureClipToTissue)) << "no clip";
  clip_at(0.045);
  expect_told(w.value(kSutureClips), 1);
  expect_told(w.value(kSutureClipToTissue), 0.005, 1e-8);
  w.hole(0.047, 1).kind = SutureHole::track;
  expect_told(w.value(kSutureClipToTissue), 0.005, 1e-8);  // not where it goes in or comes out
  clip_at(0.0385);
  expect_told(w.value(kSutureClips), 2);
  expect_told(w.value(kSutureClipToTissue), 0.0015, 1e-8);
  w.suture().hole_count = 0;
  EXPECT_UNTOLD(w.value(kSutureClipToTissue)) << "no stitch";
}

TEST(SutureFacts, AHandHoldsNeedleOrThreadByThePlaceThatIsBetweenItsJaws) {
  Sewn w;
  const int hand = w.model.hand_index("left");
  expect_told(w.value(kSutureNeedleHeld, {Sewn::hand(hand)}), 0);
  w.hold(hand, w.thing().grips - 1);
  expect_told(w.value(kSutureNeedleHeld, {Sewn::hand(hand)}), 1);
  expect_told(w.value(kSutureThreadHeld, {Sewn::hand(hand)}), 0);
  w.hold(hand, w.thing().grips);
  expect_told(w.value(kSutureNeedleHeld, {Sewn::hand(hand)}), 0);
  expect_told(w.value(kSutureThreadHeld, {Sewn::hand(hand)}), 1);
}

TEST(SutureFacts, ANeedleBehindTheEndoscopeIsNotInItsPicture) {
  Sewn w;
  const kinematics::ScopeFrame scope = sim::scope_of(w.model, w.state);
  w.suture().needle.x = scope.eye + 0.06 * scope.forward;
  expect_told(w.value(kSutureNeedleInView), 1);
  w.suture().needle.x = scope.eye - 0.06 * scope.forward;
  expect_told(w.value(kSutureNeedleInView), 0);
}

TEST(SutureFacts, MarksAreAsFarApartAsTheyAreDrawn) {
  const Sewn w;
  expect_told(w.value(kMarksApart, {w.mark("in_1"), w.mark("out_1")}), 0.014, 2e-4);
}

TEST(KnotFacts, OpposedThrowsAreASquareKnotWithItsTurnsAndTails) {
  Sewn w;
  w.tie({{2, 1}, {1, -1}});
  expect_told(w.value(kKnotThrows), 0);  // not looked at yet
  expect_told(w.later(kKnotThrows, 0.5), 2);
  const Value first = w.later(kKnotTurns, 0.5, {Sewn::number(1)}), second = w.later(kKnotTurns, 0.5, {Sewn::number(2)});
  ASSERT_TRUE(first.known && second.known);
  EXPECT_EQ(std::fabs(first.number), 2);
  EXPECT_EQ(std::fabs(second.number), 1);
  EXPECT_LT(first.number * second.number, 0);
  EXPECT_UNTOLD(w.later(kKnotTurns, 0.5, {Sewn::number(3)}));
  expect_told(w.later(kKnotSquare, 0.5), 1);
  expect_told(w.later(kKnotGranny, 0.5), 0);
  expect_told(w.later(kKnotSlip, 0.5), 0);
  expect_told(w.later(kKnotTail, 0.5), 0.030, 0.004);
  expect_told(w.later(kKnotAbove, 0.5), 0.008, 0.002);  // the loop's width: its lowest place is in the tissue
}

TEST(KnotFacts, EqualThrowsAreAGranny) {
  Sewn w;
  w.tie({{1, 1}, {1, 1}});
  expect_told(w.later(kKnotThrows, 0.5), 2);
  expect_told(w.later(kKnotGranny, 0.5), 1);
  expect_told(w.later(kKnotSquare, 0.5), 0);
}

TEST(KnotFacts, WithoutAThrowThereIsNoTailAndNothingAboveTissue) {
  const Sewn w;
  expect_told(w.later(kKnotThrows, 0.5), 0);
  EXPECT_UNTOLD(w.later(kKnotTail, 0.5));
  EXPECT_UNTOLD(w.later(kKnotAbove, 0.5));
}

TEST(KnotFacts, TurnsRoundAShaftAreCountedWithTheirSign) {
  Sewn w;
  const int hand = w.model.hand_index("left");
  expect_told(w.value(kThreadWraps, {Sewn::hand(hand)}), 0, 0.05);
  const interactions::ToolShape shape = sim::shape_of(w.model, w.state, size_t(hand));
  const Vec3d axis = shape.frame.axis(), a = any_perpendicular(axis), b = cross(axis, a);
  std::vector<Vec3d>& x = w.suture().thread.x;
  for (const double sign : {1.0, -1.0}) {
    for (size_t i = 0; i < x.size(); ++i) {
      const double share = double(i) / double(x.size() - 1), angle = sign * 2 * portable::two_pi * share;
      x[i] =
          shape.pivot - (0.020 - 0.015 * share) * axis + 0.004 * (portable::cos(angle) * a + portable::sin(angle) * b);
    }
    expect_told(w.value(kThreadWraps, {Sewn::hand(hand)}), sign * 2, 0.1);
  }
}

TEST(LoopFacts, SayWhereALoopLiesAndWhatItLeavesOfTheLumen) {
  Sewn w(shipped("box_loop"));
  const Arguments on{w.strand("appendage")};
  expect_told(w.value(kLoopClosed, on), 0);
  expect_told(w.value(kLoopOpenShare, on), 1);
  EXPECT_UNTOLD(w.value(kLoopAt, on));
  EXPECT_UNTOLD(w.value(kLoopToMark, {w.mark("line")}));

  const interactions::StrandBody& body = w.model.strand_bodies[0];
  const interactions::StrandPlace place = interactions::place_at(body, 0.020);
  SlingState& g = w.suture().sling;
  g.stage = SlingState::open;
  g.around_count = 1;
  g.tension = 3, g.pulled = 1.5;
  interactions::SlingAround& around = g.around[0];
  around.at.body = BodyId::strand(0);
  around.at.element = place.element, around.at.weight[0] = float(place.w);
  const double radius = body.model.radius[size_t(place.element)], lumen = body.model.lumen[size_t(place.element)];
  around.radius = radius - 0.5 * lumen;
  expect_told(w.value(kLoopAt, on), 0.020);
  expect_told(w.value(kLoopToMark, {w.mark("line")}), 0.002, 1e-6);
  expect_told(w.value(kLoopOpenShare, on), 0.5);
  expect_told(w.value(kLoopTension, on), 3);
  expect_told(w.value(kLoopPull, on), 1.5);
  expect_told(w.value(kLoopClosed, on), 0);
  const Value stump = w.value(kLoopStump, on);
  expect_told(stump, interactions::arc_at(body, {body.nodes() - 2, 1}) - 0.020, 1e-6);

  around.radius = radius - lumen;
  expect_told(w.value(kLoopClosed, on), 1);
  expect_told(w.value(kLoopSecured, on), 0);
  g.stage = SlingState::left;
  expect_told(w.value(kLoopSecured, on), 1);
  expect_told(w.value(kLoopPull, on), 0);  // nobody pulls at it
  w.suture().broken = 1;
  expect_told(w.value(kLoopSecured, on), 0);  // its tail was not cut
}

/// The small scene with an injection needle in its second hand.
const sim::Model& needled() {
  static const sim::Model made = [] {
    scene::Description d = small::description();
    scene::Instrument i = small::instrument("needle", interactions::ToolKind::injection_needle);
    i.jaw_length = 0.004;
    i.jaw_width = 0.005;
    i.jaw_thickness = 0.0018;
    i.opening = 0;
    i.needle.units = 0.2;
    d.instruments.push_back(i);
    d.placements[1] = {"needle", "b", {0.055, 0, 0.05}, 0, {}};
    return scene::compile(d);
  }();
  return made;
}

TEST(InjectionFacts, TellOfAPointOnlyWhileItIsInAnOrgan) {
  Sewn w(needled());
  sim::NeedleHand& n = w.state.injection.hands[1];
  n.depth = 0.003, n.drawn_for = 1.5, n.blood = 2 * fluids::kMillilitre;
  n.plunger = 7, n.left = 5 * fluids::kMillilitre;
  const Argument hand = Sewn::hand(1), organ = w.body("organ"), pad = w.body("pad");
  EXPECT_UNTOLD(w.value(kNeedleDepth, {hand}));
  EXPECT_UNTOLD(w.value(kNeedleDrawn, {hand}));
  expect_told(w.value(kNeedleIn, {hand, {}}), 0);
  n.entry.body = organ.body();
  expect_told(w.value(kNeedleDepth, {hand}), 0.003);
  expect_told(w.value(kNeedleDrawn, {hand}), 1.5);
  expect_told(w.value(kNeedleIn, {hand, {}}), 1);
  expect_told(w.value(kNeedleIn, {hand, organ}), 1);
  expect_told(w.value(kNeedleIn, {hand, pad}), 0);
  expect_told(w.value(kNeedlePlunger, {hand}), 7);
  expect_told(w.value(kNeedleLeft, {hand}), 5e-6, 1e-15);
  expect_told(w.value(kNeedleBlood, {hand}), 2e-6, 1e-15);
}

TEST(InjectionFacts, VolumesAreThoseOfTheAccount) {
  Sewn w(needled());
  const Argument organ = w.body("organ");
  w.state.injection.given[organ.body().index()] = 3 * fluids::kMillilitre;
  sim::InjectionAccount& account = w.state.injection.account;
  account.vessel = fluids::kMillilitre;
  account.leaked = 2 * fluids::kMillilitre, account.spilled = 4 * fluids::kMillilitre;
  account.drugged = 10 * fluids::kMillilitre;
  expect_told(w.value(kInjectedVolume, {organ}), 3e-6, 1e-15);
  expect_told(w.value(kInjectedVessels), 1e-6, 1e-15);
  expect_told(w.value(kInjectedSpilled), 6e-6, 1e-15);
  expect_told(w.value(kInjectedUnits), 2);  // 0.2 IU a millilitre
}

TEST(InjectionFacts, WhatGotNoDrugHasNotBlanched) {
  const Sewn w(needled());
  EXPECT_UNTOLD(w.value(kInjectedBlanched, {w.body("organ")}));
  expect_told(w.later(kInjectedBlanched, 0.02, {w.body("organ")}), 0);
}

}  // namespace
}  // namespace trocar::training
