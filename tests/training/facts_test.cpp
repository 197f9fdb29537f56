// Facts and events, each by States that are written by hand: what they say, and when they say nothing.
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/training/events/catalogue.hpp>
#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/facts/unit.hpp>
#include <trocar/training/observe/marks.hpp>

#include "two_sides.hpp"

namespace trocar::training {
namespace {

using two_sides::kApplier;
using two_sides::kCord;
using two_sides::kGrasper;
using two_sides::kLeft;
using two_sides::kScissors;

constexpr double kDegree = 3.14159265358979323846 / 180;

Argument number(double v) { return {true, -1, v, v, {}, {}}; }
Argument range(double low, double high) { return {true, -1, low, high, {}, {}}; }
Argument word(const char* w) { return {true, -1, 0, 0, w, {}}; }
Argument bodies(const std::vector<int>& strands) {
  Argument a{true, -1, 0, 0, {}, {}};
  for (const int i : strands) a.bodies.push_back(BodyId::strand(size_t(i)));
  return a;
}

/// A State that a test writes, and facts of it.
struct World {
  const sim::Model& model;
  sim::State state = sim::initial_state(model);

  explicit World(const sim::Model& of = two_sides::model()) : model(of) {}
  Snapshot snapshot() const { return {model, state}; }
  Argument named(ArgumentKind kind, const std::string& name) const {
    Argument a{true, -1, 0, 0, {}, {}};
    std::vector<std::string> known;
    EXPECT_TRUE(find_named(model, kind, name, a.index, known)) << name;
    return a;
  }
  Argument hand(int h) const { return {true, h, 0, 0, {}, {}}; }
  Argument strand(const char* name) const { return named(ArgumentKind::strand, name); }
  Argument mark(const char* name) const { return named(ArgumentKind::mark, name); }

  Value value(const Fact& fact, const Arguments& a) const {
    EXPECT_EQ(fact.parameters.size(), a.size()) << fact.name;
    return fact.watch(model, a)->value(snapshot());
  }
  void see(const std::string& name, bool seen) {
    for (const sim::VisibilityTarget& t : model.targets)
      if (t.name.rfind(name, 0) == 0)
        for (int i = t.first; i < t.first + t.count; ++i) state.seen[size_t(i)] = seen;
  }
  void hold(int strand, double pull) {
    interactions::ToolState& tool = state.tools[kGrasper];
    tool.holds = 1;
    tool.hold[0].at.body = BodyId::strand(size_t(strand));
    tool.pull[2] = pull;
    tool.pinch = 5;
  }
  interactions::Clip& clip(int strand, double s) {
    interactions::Clip& c = state.clips[size_t(state.clip_count++)];
    c = {};
    c.strand = strand;
    c.s = s;
    c.cover = 1;
    c.closing_time = 2;
    c.tips_visible = 2;
    c.tool = kApplier;
    return c;
  }
  /// Looks at the mark from `off` [m] of its middle, straight.
  void aim(const char* name, Vec3d off) {
    const Vec3d at = place_of_mark(model, state, mark(name).index);
    const kinematics::FulcrumPose pose = kinematics::inverse(model.scope.port, at + off, 0);
    state.scope.yaw = float(pose.yaw);
    state.scope.pitch = float(pose.pitch);
    state.scope.depth = float(pose.depth);
  }
};

#define EXPECT_UNKNOWN(v) EXPECT_FALSE((v).known)
void expect_value(const Value& v, double expected, double tolerance = 1e-12) {
  ASSERT_TRUE(v.known);
  EXPECT_NEAR(v.number, expected, tolerance);
}

TEST(Facts, HaveNamesUnitsBoundsAndMeaningsOfTheirOwn) {
  std::set<std::string_view> names;
  for (const Fact* fact : facts()) {
    EXPECT_TRUE(names.insert(fact->name).second) << fact->name;
    EXPECT_FALSE(fact->meaning.empty()) << fact->name;
    EXPECT_LT(fact->low, fact->high) << fact->name;
    EXPECT_EQ(find_fact(fact->name), fact);
    EXPECT_TRUE(!fact->is_truth || unit_of(fact->name).suffix.empty()) << fact->name << " is a truth with a unit";
  }
  for (const EventKind* event : event_kinds()) {
    EXPECT_TRUE(names.insert(event->name).second) << event->name;
    EXPECT_FALSE(event->meaning.empty()) << event->name;
    EXPECT_EQ(find_event(event->name), event);
    for (const Attribute& a : event->attributes) {
      EXPECT_LT(a.low, a.high) << event->name << ", " << a.name;
      EXPECT_FALSE(a.is_truth && a.is_count) << event->name << ", " << a.name;
    }
  }
  EXPECT_GE(facts().size(), 30u);
  EXPECT_GE(event_kinds().size(), 12u);
  EXPECT_EQ(find_fact("no such fact"), nullptr);
}

TEST(Facts, UnitsAreWhatNamesEndIn) {
  EXPECT_EQ(unit_of("distance_mm").si, 1e-3);
  EXPECT_EQ(unit_of("speed_mm_s").suffix, "mm_s");
  EXPECT_EQ(unit_of("flow_mL_min").si, 1e-6 / 60);
  EXPECT_EQ(unit_of("impulse_N_s").suffix, "N_s");
  EXPECT_EQ(unit_of("angle_deg").si, kDegree);
  EXPECT_EQ(unit_of("cover").suffix, "");
  EXPECT_EQ(unit_of("comm").suffix, "") << "no word that happens to end so";
}

TEST(Facts, MarksAreInViewFromHalfOfTheirSamplesOn) {
  World w;
  EXPECT_EQ(w.value(kMarkInView, {w.mark("organ")}).number, 0);
  const sim::VisibilityTarget& t = w.model.targets[size_t(w.mark("organ").index)];
  for (int i = 0; i < t.count / 2; ++i) w.state.seen[size_t(t.first + i)] = 1;
  expect_value(w.value(kMarkInView, {w.mark("organ")}), 1);
  expect_value(w.value(kMarkVisibleShare, {w.mark("organ")}), 0.5);
  w.state.seen[size_t(t.first)] = 0;
  expect_value(w.value(kMarkInView, {w.mark("organ")}), 0);
}

TEST(Facts, AMarkLiesInThePictureOnlyWhileItIsSeen) {
  World w;
  const Arguments pad{w.mark("pad")};
  w.aim("pad", {0, 0, 0.04});
  for (const Fact* fact : {&kMarkOffCentre, &kMarkDistance, &kMarkFacing})
    EXPECT_UNKNOWN(w.value(*fact, pad)) << fact->name;
  w.see("pad", true);
  expect_value(w.value(kMarkDistance, pad), 0.04, 1e-6);
  const double off = w.value(kMarkOffCentre, pad).number;
  w.aim("pad", {0.03, 0, 0.04});
  EXPECT_GT(w.value(kMarkOffCentre, pad).number, off) << "farther from the middle";
  expect_value(w.value(kMarkDistance, pad), 0.05, 1e-6);
  EXPECT_UNKNOWN(w.value(kMarkFacing, pad)) << "a closed surface has no single normal";
}

/// The small scene with a disc and a stripe around the left tube.
const sim::Model& marked() {
  static const sim::Model compiled = [] {
    scene::Description d = small::description();
    d.strands = {two_sides::tube("tube_left", 1), two_sides::tube("tube_right", -1), small::cord()};
    d.membranes.clear();
    d.vessels.clear();
    scene::MarkSetting disc;
    disc.name = "disc";
    disc.place = {0, 0, 0.02};
    disc.normal = {0, 1, 1};
    scene::MarkSetting stripe;
    stripe.name = "stripe";
    stripe.on = "tube_left";
    stripe.stripe = true;
    stripe.s = 0.020;
    stripe.size = 0.001;
    d.marks = {disc, stripe};
    return scene::compile(d);
  }();
  return compiled;
}

TEST(Facts, ADiscIsAsFarAsItsMiddleAndFacesWhereItsNormalDoes) {
  World w{marked()};
  w.see("disc", true);
  w.aim("disc", {0, 0, 0.05});
  expect_value(w.value(kMarkDistance, {w.mark("disc")}), 0.05, 1e-6);
  expect_value(w.value(kMarkFacing, {w.mark("disc")}), 45 * kDegree, 1e-5);
  w.aim("disc", {0, 0.03, 0.03});
  expect_value(w.value(kMarkFacing, {w.mark("disc")}), 0, 1e-5);
  w.see("stripe", true);
  EXPECT_UNKNOWN(w.value(kMarkFacing, {w.mark("stripe")})) << "it goes all around";
}

TEST(Facts, AMarkHasMovedFromWhereItWasAtFirst) {
  World w;
  const auto moved = [&w](const char* towards) {
    return kMarkMoved.watch(w.model, {w.mark("tube_left.isthmus"), word(towards)});
  };
  const std::unique_ptr<Observer> left = moved("left"), right = moved("right"), hip = moved("right_hip");
  EXPECT_UNKNOWN(left->value(w.snapshot())) << "nobody has looked yet";
  for (Observer* o : {left.get(), right.get(), hip.get()}) o->sample(w.snapshot(), 0.02);
  expect_value(left->value(w.snapshot()), 0);
  for (Vec3d& x : w.state.strands[kLeft].x) x += Vec3d{0.003, 0, 0.005};
  for (Observer* o : {left.get(), right.get(), hip.get()}) o->sample(w.snapshot(), 0.02);
  expect_value(left->value(w.snapshot()), 0.003);
  expect_value(right->value(w.snapshot()), -0.003);
  expect_value(hip->value(w.snapshot()), -0.003 / std::sqrt(2.0));
}

TEST(Facts, TheHorizonIsWhereThePictureIsTurnedTo) {
  World w;
  w.state.scope.pitch = 0.9f;
  const double before = w.value(kScopeHorizon, {}).number;
  w.state.scope.roll += float(20 * kDegree);
  const Value turned = w.value(kScopeHorizon, {});
  ASSERT_TRUE(turned.known);
  EXPECT_NEAR(std::fabs(turned.number - before), 20 * kDegree, 1e-5);
}

TEST(Facts, ForcesOfAHandThatHoldsNothingAreUnknown) {
  World w;
  EXPECT_UNKNOWN(w.value(kHandPull, {w.hand(kGrasper)}));
  EXPECT_UNKNOWN(w.value(kHandPinch, {w.hand(kGrasper)}));
  w.hold(kLeft, 1.5);
  expect_value(w.value(kHandPull, {w.hand(kGrasper)}), 1.5);
  expect_value(w.value(kHandPinch, {w.hand(kGrasper)}), 5);
  w.state.tools[kGrasper].contact_force[0] = 3;
  w.state.tools[kGrasper].contact_force[1] = 4;
  expect_value(w.value(kHandContact, {w.hand(kGrasper)}), 5);
}

TEST(Facts, AHandHoldsABodySomewhere) {
  World w;
  const Argument anything{};
  expect_value(w.value(kHandHolds, {w.hand(kGrasper), anything}), 0);
  const Arguments place{w.hand(kGrasper), w.strand("tube_left")};
  EXPECT_UNKNOWN(w.value(kHandHeldAt, place));
  w.hold(kLeft, 1);
  w.state.tools[kGrasper].hold[0].at.element = interactions::place_at(w.model.strand_bodies[kLeft], 0.055).element;
  expect_value(w.value(kHandHolds, {w.hand(kGrasper), anything}), 1);
  expect_value(w.value(kHandHolds, {w.hand(kGrasper), bodies({kCord, kLeft})}), 1);
  expect_value(w.value(kHandHolds, {w.hand(kGrasper), bodies({kCord})}), 0);
  expect_value(w.value(kHandHeldAt, place), 0.055, 0.003);
  const Argument strand = w.strand("tube_left"), grasper = w.hand(kGrasper);
  expect_value(w.value(kHandHoldsBetween, {grasper, strand, word("isthmus"), word("fimbria")}), 1);
  w.state.tools[kGrasper].hold[0].at.element = 0;
  expect_value(w.value(kHandHoldsBetween, {grasper, strand, word("isthmus"), word("fimbria")}), 0);
}

TEST(Facts, AHandHoldsAllThatIsBetweenItsJaws) {
  World w;
  w.hold(kLeft, 1);
  w.state.tools[kGrasper].holds = 2;
  w.state.tools[kGrasper].hold[1].at.body = BodyId::strand(size_t(kCord));
  for (const int strand : {kLeft, kCord}) expect_value(w.value(kHandHolds, {w.hand(kGrasper), bodies({strand})}), 1);
}

TEST(Facts, AHandHasAnInstrument) {
  World w;
  expect_value(w.value(kHandHas, {w.hand(kScissors), word("scissors")}), 1);
  expect_value(w.value(kHandHas, {w.hand(kScissors), word("grasper")}), 0);
  EXPECT_UNKNOWN(w.value(kHandClipsLeft, {w.hand(kScissors)}));
  w.state.tools[kApplier].clips_left = 3;
  expect_value(w.value(kHandClipsLeft, {w.hand(kApplier)}), 3);
}

TEST(Facts, ATipIsSomewhereAndHasComeAWay) {
  World w;
  const auto path = kHandPath.watch(w.model, {w.hand(kGrasper)});
  expect_value(path->value(w.snapshot()), 0);
  const double depth = w.state.tools[kGrasper].depth;
  const double far = w.value(kHandTipToHand, {w.hand(kGrasper), w.hand(kScissors)}).number;
  EXPECT_GT(far, 0);
  w.state.tools[kGrasper].depth += 0.01;
  path->sample(w.snapshot(), 0.02);
  w.state.tools[kGrasper].depth -= 0.01;
  path->sample(w.snapshot(), 0.02);
  expect_value(path->value(w.snapshot()), 0.02, 1e-9);
  expect_value(w.value(kHandDepth, {w.hand(kGrasper)}), depth);
  EXPECT_GT(w.value(kHandTipToMark, {w.hand(kGrasper), w.mark("pad")}).number, 0);
  expect_value(w.value(kHandTipsInView, {w.hand(kGrasper)}), 0);
  w.see(w.model.hands[kGrasper].name + ".jaw_a", true);
  expect_value(w.value(kHandTipsInView, {w.hand(kGrasper)}), 1);
}

TEST(Facts, AStrandIsStraightUntilItIsBentAndWholeUntilItIsCut) {
  World w;
  const Argument tube = w.strand("tube_left");
  expect_value(w.value(kStrandStraightness, {tube, word("isthmus")}), 1, 1e-6);
  expect_value(w.value(kStrandSevered, {tube}), 0);
  w.state.strands[kLeft].x[2].z += 0.01;
  EXPECT_LT(w.value(kStrandStraightness, {tube, word("isthmus")}).number, 0.9);
  tissue::cut_element(w.state.strands[kLeft], 5);
  expect_value(w.value(kStrandSevered, {tube}), 1);
}

TEST(Facts, ATubeIsFollowedFromItsFimbriaeAtAnEyesPace) {
  World w;
  const auto followed = kStrandFollowed.watch(w.model, {w.strand("tube_left"), word("fimbria"), number(0.02),
                                                        number(0.03), number(0.009), number(1), number(0.01)});
  w.see("tube_left", true);
  for (int i = 0; i < 50; ++i) followed->sample(w.snapshot(), 0.02);
  expect_value(followed->value(w.snapshot()), 0);
  for (int i = 0; i < 100; ++i) followed->sample(w.snapshot(), 0.02);
  expect_value(followed->value(w.snapshot()), 1);
}

TEST(Facts, FollowingBeginsAtTheLandmarkThatIsNamed) {
  World w;
  const auto followed = [&w](const char* from) {
    return kStrandFollowed.watch(w.model, {w.strand("tube_left"), word(from), number(0.02), number(0.03), number(0.009),
                                           number(1), number(0.01)});
  };
  const auto from_fimbria = followed("fimbria"), from_ampulla = followed("ampulla");
  w.see("tube_left", true);
  w.see("tube_left.fimbria", false);
  for (int i = 0; i < 200; ++i)
    for (Observer* o : {from_fimbria.get(), from_ampulla.get()}) o->sample(w.snapshot(), 0.02);
  expect_value(from_fimbria->value(w.snapshot()), 0);
  expect_value(from_ampulla->value(w.snapshot()), 1);
}

TEST(Facts, ALumenIsOpenUntilItIsClippedAndStumpsAreUnknownUntilItIsCut) {
  World w;
  const Arguments tube{w.strand("tube_left"), number(0.98)};
  const auto occluded = kStrandOccluded.watch(w.model, tube), closed = kStrandStumpsClosed.watch(w.model, tube),
             seen = kStrandStumpsInView.watch(w.model, tube);
  const auto happened = [&] {
    for (Observer* o : {occluded.get(), closed.get(), seen.get()}) o->happened(w.snapshot());
  };
  happened();
  expect_value(occluded->value(w.snapshot()), 0);
  w.clip(kLeft, 0.016);
  happened();
  expect_value(occluded->value(w.snapshot()), 1);
  EXPECT_UNKNOWN(closed->value(w.snapshot()));
  EXPECT_UNKNOWN(seen->value(w.snapshot()));
  interactions::Cut& cut = w.state.cuts[size_t(w.state.cut_count++)];
  cut = {};
  cut.s = 0.0205;
  cut.strand = kLeft;
  tissue::cut_element(w.state.strands[kLeft], interactions::place_at(w.model.strand_bodies[kLeft], cut.s).element);
  happened();
  expect_value(closed->value(w.snapshot()), 0);
  expect_value(seen->value(w.snapshot()), 0);
  w.clip(kLeft, 0.025);
  w.see("tube_left", true);
  happened();
  expect_value(closed->value(w.snapshot()), 1);
  expect_value(seen->value(w.snapshot()), 1);
}

/// Limits of a pair, as the sterilisation has them.
Arguments pair_of(const World& w) {
  return {w.strand("tube_left"), range(0.012, 0.020),  range(0.018, 0.030), range(0.006, 0.012),
          range(0.010, 0.030),   number(15 * kDegree), number(0.98),        number(1)};
}

TEST(Facts, TwoClipsMakeAPairInEitherOrder) {
  for (const bool inner_first : {true, false}) {
    World w;
    const auto first = kClipsFirstSet.watch(w.model, pair_of(w)), second = kClipsSecondSet.watch(w.model, pair_of(w)),
               apart = kClipsApart.watch(w.model, pair_of(w));
    const auto happened = [&] {
      for (Observer* o : {first.get(), second.get(), apart.get()}) o->happened(w.snapshot());
    };
    w.clip(kLeft, inner_first ? 0.016 : 0.025);
    happened();
    expect_value(first->value(w.snapshot()), inner_first);
    expect_value(second->value(w.snapshot()), !inner_first);
    EXPECT_UNKNOWN(apart->value(w.snapshot()));
    w.clip(kLeft, inner_first ? 0.025 : 0.016);
    happened();
    expect_value(first->value(w.snapshot()), 1);
    expect_value(second->value(w.snapshot()), 1);
    expect_value(apart->value(w.snapshot()), 0.009);
  }
}

TEST(Facts, AClipThatMakesNoPairIsMisplacedAndOneThatIsBadlySetDoesNotCount) {
  World w;
  const auto misplaced = kClipsMisplaced.watch(w.model, pair_of(w)), first = kClipsFirstSet.watch(w.model, pair_of(w));
  w.clip(kLeft, 0.016).cover = 0.5;
  misplaced->happened(w.snapshot());
  first->happened(w.snapshot());
  expect_value(misplaced->value(w.snapshot()), 0);
  expect_value(first->value(w.snapshot()), 0);
  w.clip(kLeft, 0.016);
  w.clip(kLeft, 0.018);
  misplaced->happened(w.snapshot());
  expect_value(misplaced->value(w.snapshot()), 1);
  w.clip(kLeft, 0.025);
  misplaced->happened(w.snapshot());
  expect_value(misplaced->value(w.snapshot()), 0);
}

TEST(Facts, FluidsAreForScenesThatHaveThem) {
  World w;
  for (const Fact* fact : {&kBloodLost, &kBloodFlow, &kBloodSince, &kPoolVolume, &kMarkUnderLiquid})
    EXPECT_EQ(fact->lacks(w.model), w.model.wet.there ? "" : "fluids") << fact->name;
  w.state.tick = 2000;
  const auto flow = kBloodFlow.watch(w.model, {}), since = kBloodSince.watch(w.model, {});
  EXPECT_UNKNOWN(since->value(w.snapshot()));
  receive(w.state.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, {.blood = 3 * fluids::kMillilitre});
  flow->sample(w.snapshot(), 0.02);
  since->sample(w.snapshot(), 0.02);
  expect_value(w.value(kBloodLost, {}), 3e-6, 1e-12);
  expect_value(w.value(kPoolVolume, {}), 3e-6, 1e-12);
  expect_value(flow->value(w.snapshot()), 3e-6, 1e-12);
  w.state.tick = 5000;
  expect_value(since->value(w.snapshot()), 3);
  for (int i = 0; i < 50; ++i) flow->sample(w.snapshot(), 0.02);
  expect_value(flow->value(w.snapshot()), 0);
  expect_value(w.value(kClock, {}), 5);
}

/// The small scene, one of whose vessels opens by itself.
sim::Model opening(const char* vessel, bool carried = true) {
  scene::Description d = small::description();
  for (scene::Vessel& v : d.vessels[0].vessels)
    if (!carried) v.rides_on.clear(), v.rides_at.clear();
  d.bleeder = scene::BleederSetting{};
  d.bleeder->holes.push_back({vessel, 0.5, 0.3e-3, {}});
  return scene::compile(d);
}

TEST(Facts, WhereAVesselOpensIsAMarkOnWhateverCarriesIt) {
  for (const char* vessel : {"tube_artery", "fold_artery", "bar_artery"}) {
    const sim::Model model = opening(vessel);
    World w{model};
    const Argument mark = w.mark("bleeder");
    const interactions::VesselPath& path = model.vessels.list[size_t(model.vessel_index(vessel))].path;
    EXPECT_LT(length(place_of_mark(model, w.state, mark.index) - path.points[path.points.size() / 2].drawn), 0.006)
        << vessel;
    EXPECT_EQ(kBleederUncovered.lacks(model), "") << vessel;
    const auto free = kBleederUncovered.watch(model, {});
    w.state.tick = model.vessels.bleeder.tick;
    free->sample(w.snapshot(), 0.02);
    expect_value(free->value(w.snapshot()), 0.02);
  }
}

TEST(Facts, AVesselThatOpensWhereNothingCarriesItCannotBeTold) {
  const sim::Model model = opening("tube_artery", false);
  EXPECT_EQ(kBleederUncovered.lacks(model), "a bleeder on a body");
  EXPECT_EQ(kBleederCalibre.lacks(model), "");
}

TEST(Facts, WhatFlowsThroughAVesselIsAMeanOfSomeBeats) {
  World w{small::model()};
  const auto flow = kVesselFlow.watch(w.model, {w.named(ArgumentKind::vessel, "tube_artery")});
  EXPECT_UNKNOWN(flow->value(w.snapshot()));
  std::fill(w.state.flow.q.begin(), w.state.flow.q.end(), 2e-7);
  for (int i = 0; i < 100; ++i) flow->sample(w.snapshot(), 0.02);
  expect_value(flow->value(w.snapshot()), 2e-7, 1e-9);
  std::fill(w.state.flow.q.begin(), w.state.flow.q.end(), 0.0);
  for (int i = 0; i < 50; ++i) flow->sample(w.snapshot(), 0.02);
  expect_value(flow->value(w.snapshot()), 1e-7, 1e-9);
  for (int i = 0; i < 50; ++i) flow->sample(w.snapshot(), 0.02);
  expect_value(flow->value(w.snapshot()), 0, 1e-9);
  EXPECT_EQ(kVesselFlow.lacks(two_sides::model()), "vessels");
}

TEST(Facts, HeatIsUnknownWhereNoElectrodeWas) {
  World w;
  for (const Fact* fact : {&kTissueTemperature, &kTissueDeadBeyond, &kHandActive})
    EXPECT_EQ(fact->lacks(w.model), w.model.energy.there ? "" : "energy") << fact->name;
  w.state.electrodes.resize(w.model.hands.size());
  EXPECT_UNKNOWN(w.value(kTissueTemperature, {w.hand(0)}));
  EXPECT_UNKNOWN(w.value(kTissueDeadBeyond, {w.hand(0)}));
  expect_value(w.value(kHandActive, {w.hand(0)}), 0);
  w.state.electrodes[0].current.now.mode = tissue::EnergyMode::coag;
  expect_value(w.value(kHandActive, {w.hand(0)}), 1);
}

TEST(Facts, WhatIsPartedIsAShareOfTheSurface) {
  World w;
  const Argument organ = w.named(ArgumentKind::body, "organ");
  expect_value(w.value(kBodyParted, {organ}), 0);
  std::vector<std::uint8_t>& open = w.state.parted[organ.body().index()];
  for (size_t i = 0; i < open.size() / 2; ++i) open[i] = 1;
  expect_value(w.value(kBodyParted, {organ}), 0.5, 0.01);
  EXPECT_UNKNOWN(w.value(kBodyParted, {w.named(ArgumentKind::body, "cord")}));
}

/// Events of one kind that a State brings.
struct Noticed : World {
  explicit Noticed(const sim::Model& of = two_sides::model()) : World(of) {}
  std::unique_ptr<EventDetector> detector;
  EventInstances seen;
  void watch(const EventKind& kind, const Arguments& a = {}) {
    EXPECT_EQ(kind.parameters.size(), a.size());
    detector = kind.watch(model, a);
  }
  int tick(int count = 1, const sim::StepReport& report = {}) {
    seen.count = 0;
    for (int i = 0; i < count; ++i) {
      ++state.tick;
      detector->tick(snapshot(), report, seen);
      if (state.tick % 20 == 0) detector->sample(snapshot(), 0.02, seen);
    }
    return seen.count;
  }
  int report(const sim::Event& event) {
    sim::StepReport r;
    r.events[0] = event;
    r.event_count = 1;
    return tick(1, r);
  }
  Value attribute(const EventKind& kind, std::string_view name) const {
    for (const Attribute& a : kind.attributes)
      if (a.name == name) return a.value(snapshot(), seen.list[0]);
    ADD_FAILURE() << name;
    return kUnknown;
  }
};

sim::Event torn_by(int hand) { return sim::Event::on_body(sim::Event::torn, hand, BodyId::strand(kCord)); }

TEST(Events, OfHandsAreWhatTheStepReports) {
  using sim::Event;
  const BodyId cord = BodyId::strand(kCord);
  const struct {
    const EventKind& kind;
    Event reported;
  } all[] = {{*find_event("grasped"), Event::on_body(Event::grasped, kGrasper, cord)},
             {*find_event("released"), Event::of_hand(Event::released, kGrasper)},
             {*find_event("slipped"), Event::of_hand(Event::slipped, kGrasper)},
             {*find_event("exchanged"), Event::exchange(kGrasper, 1)},
             {*find_event("parted"), Event::on_body(Event::parted, kGrasper, cord)},
             {*find_event("declared"), Event::of_hand(Event::declared, kGrasper)},
             {kTorn, torn_by(kGrasper)}};
  for (const auto& one : all) {
    Noticed n;
    n.watch(one.kind);
    EXPECT_EQ(n.tick(), 0) << one.kind.name;
    EXPECT_EQ(n.report(one.reported), 1) << one.kind.name;
    EXPECT_EQ(n.seen.list[0].hand, kGrasper);
    EXPECT_EQ(n.seen.list[0].body.exists(), one.kind.has_body) << one.kind.name;
    if (one.kind.has_body) {
      EXPECT_EQ(*n.seen.list[0].name, "cord");
    }
    EXPECT_EQ(n.report({}), 0) << one.kind.name;
  }
}

TEST(Events, TearingIsToldOnceABodyForAsLongAsItGoesOn) {
  Noticed n;
  n.watch(kTorn);
  EXPECT_EQ(n.report(torn_by(kGrasper)), 1);
  EXPECT_EQ(n.report(torn_by(kGrasper)), 0);
  n.tick(1500);
  EXPECT_EQ(n.report(torn_by(kGrasper)), 1);
}

TEST(Events, WhatTearsOrBreaksByItselfIsNobodysAndATearByAHandAfterItCounts) {
  Noticed torn, broken;
  torn.watch(kTorn);
  broken.watch(*find_event("thread_broken"));
  EXPECT_EQ(torn.report(torn_by(-1)), 0);
  EXPECT_EQ(torn.report(torn_by(kGrasper)), 1);
  EXPECT_EQ(broken.report(sim::Event::on_body(sim::Event::thread_broken, -1, BodyId(BodyKind::suture, 0))), 0);
}

TEST(Events, BeyondTheRoomOfATickAreReportedAsLost) {
  Incidents incidents;
  EventInstances instances;
  for (std::size_t i = 0; i < incidents.list.size(); ++i) incidents.add({Incident::torn, kGrasper, {}, ""});
  pass(incidents, Incident::torn, instances);
  EXPECT_FALSE(instances.lost);
  incidents.add({Incident::torn, kGrasper, {}, ""});
  pass(incidents, Incident::overpulled, instances);
  EXPECT_TRUE(instances.lost);
  EventInstances many;
  for (std::size_t i = 0; i <= many.list.size(); ++i) many.add({});
  EXPECT_TRUE(many.lost);
}

TEST(Events, AClipHasAPlaceAndAMannerOrIsLost) {
  Noticed n, lost;
  n.watch(kClipped);
  lost.watch(kClipLost);
  interactions::Clip& c = n.clip(kLeft, 0.016);
  c.theta = 0.1;
  EXPECT_EQ(n.tick(), 1);
  EXPECT_EQ(n.seen.list[0].body, BodyId::strand(kLeft));
  expect_value(n.attribute(kClipped, "s_mm"), 0.016);
  expect_value(n.attribute(kClipped, "angle_deg"), 0.1);
  expect_value(n.attribute(kClipped, "cover"), 1);
  expect_value(n.attribute(kClipped, "closing_s"), 2);
  expect_value(n.attribute(kClipped, "tips_visible"), 2);
  expect_value(n.attribute(kClipped, "on_bleeder"), 0);
  EXPECT_UNKNOWN(n.attribute(kClipped, "upstream"));
  EXPECT_UNKNOWN(n.attribute(kClipped, "bleeder_cover"));
  EXPECT_EQ(n.tick(), 0) << "told once";
  lost.clip(-1, 0);
  EXPECT_EQ(lost.tick(), 1);
  n.clip(-1, 0);
  EXPECT_EQ(n.tick(), 0) << "a clip that is lost is on nothing";
}

TEST(Events, AClipIsAWayFromTheStripeAndFromClipsThatWereThereBefore) {
  Noticed n(marked());
  n.watch(kClipped);
  n.clip(kLeft, 0.0212);
  EXPECT_EQ(n.tick(), 1);
  expect_value(n.attribute(kClipped, "to_mark_mm"), 0.0012);
  EXPECT_UNKNOWN(n.attribute(kClipped, "to_clip_mm"));
  n.clip(kLeft, 0.0197);
  EXPECT_EQ(n.tick(), 1);
  expect_value(n.attribute(kClipped, "to_mark_mm"), 0.0003);
  expect_value(n.attribute(kClipped, "to_clip_mm"), 0.0015);
  n.clip(kCord, 0.0197);
  EXPECT_EQ(n.tick(), 1);
  EXPECT_UNKNOWN(n.attribute(kClipped, "to_mark_mm")) << "the cord has no stripe";
  EXPECT_UNKNOWN(n.attribute(kClipped, "to_clip_mm"));
}

TEST(Events, AMarkThatWasHeldInTheMiddleIsLostOnceItIsOutOfView) {
  Noticed n(marked());
  n.watch(kMarkLost, {n.mark("disc"), number(0.1), number(0.5), number(0.2)});
  n.see("disc", true);
  const Vec3d disc = place_of_mark(n.model, n.state, n.mark("disc").index);
  n.aim("disc", 0.05 * normalised(n.model.scope.port - disc));
  EXPECT_EQ(n.tick(400), 0);
  n.see("disc", false);
  EXPECT_EQ(n.tick(1000), 0) << "it was in the middle in passing only";
  n.see("disc", true);
  EXPECT_EQ(n.tick(600), 0);
  n.see("disc", false);
  EXPECT_EQ(n.tick(150), 0) << "out of view for a moment";
  EXPECT_EQ(n.tick(100), 1);
  EXPECT_EQ(*n.seen.list[0].name, "disc");
  EXPECT_EQ(n.tick(1000), 0) << "told once";
}

TEST(Events, ACutKnowsTheClipsBesideIt) {
  Noticed n;
  n.watch(kCut);
  const auto cut = [&n](int strand, double s) {
    interactions::Cut& c = n.state.cuts[size_t(n.state.cut_count++)];
    c = {};
    c.strand = strand;
    c.s = s;
    c.fraction = 1;
    c.beyond = 0.003;
    return n.tick();
  };
  EXPECT_EQ(cut(kLeft, 0.02), 1);
  expect_value(n.attribute(kCut, "between_clips"), 0);
  EXPECT_UNKNOWN(n.attribute(kCut, "to_clip_mm"));
  n.clip(kLeft, 0.016);
  n.clip(kLeft, 0.025);
  EXPECT_EQ(cut(kLeft, 0.02), 1);
  expect_value(n.attribute(kCut, "between_clips"), 1);
  expect_value(n.attribute(kCut, "to_clip_mm"), 0.004);
  expect_value(n.attribute(kCut, "depth_mm"), 0.003);
  expect_value(n.attribute(kCut, "fraction"), 1);
  interactions::Cut& organ = n.state.cuts[size_t(n.state.cut_count++)];
  organ = {};
  organ.solid = 0;
  EXPECT_EQ(n.tick(), 1);
  EXPECT_EQ(n.seen.list[0].body, BodyId::organ(0));
  EXPECT_UNKNOWN(n.attribute(kCut, "fraction"));
}

TEST(Events, APullIsTooHardByWhatIsPulled) {
  Noticed n;
  n.watch(kOverpulled, {bodies({kLeft}), number(4), number(8), number(0.1)});
  n.hold(kLeft, 5);
  EXPECT_EQ(n.tick(90), 0) << "not for long";
  EXPECT_EQ(n.tick(30), 1);
  EXPECT_STREQ(n.seen.list[0].detail, "delicate tissue");
  EXPECT_EQ(n.tick(500), 0) << "once an excursion";
  n.hold(kCord, 5);
  EXPECT_EQ(n.tick(500), 0) << "bears more";
}

TEST(Events, APinchIsTooHardOrTooLong) {
  Noticed n;
  n.watch(kOverpinched, {bodies({kCord}), number(15), number(300)});
  n.hold(kCord, 0);
  EXPECT_EQ(n.tick(100), 0);
  n.state.tools[kGrasper].pinch = 16;
  EXPECT_EQ(n.tick(100), 1);
  n.state.tools[kGrasper].holds = 0;
  n.tick();
  n.hold(kLeft, 0);
  n.state.tools[kGrasper].pinch = 16;
  EXPECT_EQ(n.tick(100), 0) << "not bowel";
}

TEST(Events, ALensIsTouchedByWhatComesNear) {
  Noticed n;
  n.watch(kLensTouched, {number(0.003)});
  n.aim("pad", {0, 0, 0.05});
  EXPECT_EQ(n.tick(200), 0);
  n.aim("pad", {0, 0, 0.006});
  EXPECT_EQ(n.tick(200), 1) << "once";
}

TEST(Events, APedalIsPressedOnce) {
  Noticed n;
  n.state.electrodes.resize(n.model.hands.size());
  n.watch(kActivated);
  EXPECT_EQ(n.tick(), 0);
  n.state.electrodes[1].current.now.mode = tissue::EnergyMode::cut;
  EXPECT_EQ(n.tick(100), 1);
  EXPECT_EQ(n.seen.list[0].hand, 1);
}

TEST(Catalogue, SaysWhatThereIsAndWhatASceneLacks) {
  const auto all = catalogue();
  EXPECT_EQ(all["facts"].size(), facts().size());
  EXPECT_EQ(all["events"].size(), event_kinds().size());
  EXPECT_FALSE(all.contains("names"));
  for (const auto& event : all["events"])
    for (const auto& a : event["attributes"]) EXPECT_EQ(a.contains("to"), a["type"] != "true or false") << a["name"];
  sim::Model dry = two_sides::model();
  dry.wet.there = false;
  const auto here = catalogue(&dry);
  int lacking = 0;
  for (const auto& fact : here["facts"]) lacking += fact.contains("lacks") && fact["lacks"] == "fluids";
  EXPECT_EQ(lacking, 6);
  const auto strands = here["names"]["strand"].get<std::vector<std::string>>();
  EXPECT_EQ(strands, (std::vector<std::string>{"tube_left", "tube_right", "cord"}));
}

}  // namespace
}  // namespace trocar::training
