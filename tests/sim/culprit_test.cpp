// Whose hand tissue tore under: the one that loads the torn place; and that nobody is charged where no hand does.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/culprit.hpp>

#include "shipped.hpp"
#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

using interactions::Owner;

constexpr BodyId kTube = BodyId::strand(small::kTube), kCord = BodyId::strand(small::kCord);

/// A tick in which the tests write down the loads.
struct Loaded {
  const Model& model;
  State state;
  Work work;
  Input input;
  StepReport report;

  explicit Loaded(const Model& m = small::model())
      : model(m), state(initial_state(m)), work(make_work(m)), input(m.start) {
    step(m, input, state, work);
    for (interactions::ToolState& tool : state.tools) tool.holds = 0;
    for (interactions::TouchBook& touches : state.touches) touches.count = 0;
    for (interactions::StrandBodyWork& w : work.strands) w.loads.clear(), w.loads.reaction.clear();
    for (interactions::OrganWork& w : work.organs) w.loads.clear(), w.loads.sorted.clear(), w.loads.reaction.clear();
  }
  StepContext context() { return {model, input, state, work, report}; }

  static int element_at(double s) {
    return interactions::place_at(small::model().strand_bodies[small::kTube], s).element;
  }
  Vec3d tube_at(double s) const { return state.strands[small::kTube].x[size_t(element_at(s))]; }

  /// A hand on a strand: as jaws do that hold it, or an instrument that presses on it.
  void load(Owner owner, int hand, size_t strand, int element, Vec3d force) {
    interactions::StrandLoads& loads = work.strands[strand].loads;
    tissue::StrandLoad load;
    load.element = element;
    loads.add(load, {owner, hand, 0});
    loads.reaction.push_back(force);
  }
  /// A hand holds that element of a strand, and pulls there.
  void hold(int hand, BodyId body, int element, Vec3d force) {
    interactions::ToolState& tool = state.tools[size_t(hand)];
    tool.holds = 1;
    tool.hold[0].at.body = body;
    tool.hold[0].at.element = element;
    for (int k = 0; k < 3; ++k) tool.hold[0].force[k] = float(force[k]), tool.pull[k] = -force[k];
    if (body.is(BodyKind::strand)) load(Owner::tool_hold, hand, body.index(), element, force);
  }
  int culprit_at(double s) { return culprit(context(), {kTube, tube_at(s)}); }
};

/// The tube in a scene where it can tear.
const Model& weak() {
  static const Model made = [] {
    scene::Description d = small::description();
    for (scene::Tissue& t : d.tissues)
      if (t.name == "duct") t.failure_strain = 0.5;
    return scene::compile(d);
  }();
  return made;
}

/// The box trainer's pad with its suture, whose thread goes through the pad at one place and pulls there.
struct Stitched : Loaded {
  static constexpr double kPull = 5;  // [N]
  TornPlace place;

  static const Model& box() {
    static const Model made = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_suture/scene.json"));
    return made;
  }
  Stitched() : Loaded(box()) {
    interactions::SutureState& s = state.objects.sutures[0];
    const StepContext c = context();
    const Vec3d at = interactions::nodes_of(bodies_of(c), BodyId::organ(0)).position(0);
    s.holes[0] = {};
    s.holes[0].at = interactions::attach(bodies_of(c), BodyId::organ(0), at);
    s.holes[0].force = {0, 0, float(kPull)};
    s.hole_count = 1;
    place = {BodyId::organ(0), at};
  }
  void press_beside(int hand, double force) {
    interactions::NetworkLoads& loads = work.organs[0].loads;
    tissue::NodeLoad load;
    load.node = 0;
    loads.sorted.push_back(load);
    loads.owner.resize(loads.sorted.size());
    loads.owner.back() = {Owner::tool_contact, hand, 0};
    loads.reaction.push_back({0, 0, float(force)});
  }
  int who() { return culprit(context(), place); }
  int left() const { return model.hand_index("left"); }
  int right() const { return model.hand_index("right"); }
};

}  // namespace

TEST(Culprit, OfTwoHandsThatHoldABodyIsTheOneAtTheTornPlaceThoughTheOtherPullsHarder) {
  Loaded h;
  h.hold(small::kGrasper, kTube, Loaded::element_at(0.070), {0, 0, 3});
  h.hold(small::kApplier, kTube, Loaded::element_at(0.012), {0, 0, 2});
  EXPECT_EQ(h.culprit_at(0.010), small::kApplier);
  EXPECT_EQ(h.culprit_at(0.065), small::kGrasper);
}

TEST(Culprit, IsTheHandThatPressesOnTheTornPlaceAndNotOneThatHoldsTheBodyElsewhere) {
  Loaded h;
  h.hold(small::kGrasper, kTube, Loaded::element_at(0.075), {0, 0, 1});
  h.load(Owner::tool_contact, small::kScissors, small::kTube, Loaded::element_at(0.011), {0, 0, -2});
  EXPECT_EQ(h.culprit_at(0.010), small::kScissors);
}

TEST(Culprit, ThatPullsFromAfarIsTheHandWhereNoOtherLoadsTheBody) {
  Loaded h;
  h.hold(small::kGrasper, kTube, Loaded::element_at(0.078), {0, 0, 3});
  EXPECT_EQ(h.culprit_at(0.003), small::kGrasper);
}

TEST(Culprit, JawsThatSpreadTissueLoadItThoughTheirForcesCancel) {
  Loaded h;
  for (const double force : {-1.0, 1.0})
    h.load(Owner::tool_contact, small::kGrasper, small::kTube, Loaded::element_at(0.010), {0, force, 0});
  EXPECT_EQ(h.culprit_at(0.010), small::kGrasper);
}

TEST(Culprit, IsNobodyWhereHandsLoadOnlyBodiesThatHaveNothingToDoWithIt) {
  Loaded h;
  const int end = int(h.state.strands[small::kCord].x.size()) - 3;
  h.hold(small::kGrasper, kCord, end, {0, 0, 9});
  EXPECT_EQ(h.culprit_at(0.005), -1) << "the cord is held 65 mm away";
  EXPECT_EQ(h.culprit_at(0.070), small::kGrasper) << "beside the torn place loads pass on";
}

TEST(Culprit, IsNobodyWhereAnInstrumentOnlyLiesThere) {
  Loaded h;
  h.load(Owner::tool_contact, small::kScissors, small::kTube, Loaded::element_at(0.010), {0, 0, -0.05});
  EXPECT_EQ(h.culprit_at(0.010), -1);
  EXPECT_EQ(Loaded().culprit_at(0.010), -1);
}

TEST(Culprit, OfAFoldIsTheHandThatHoldsTheStrandThatItHangsOnHoweverFar) {
  Loaded h;
  h.hold(small::kGrasper, kTube, Loaded::element_at(0.070), {0, 0, 3});
  EXPECT_EQ(culprit(h.context(), {BodyId::membrane(0), h.tube_at(0.008) - Vec3d{0, 0, 0.005}}), small::kGrasper);
}

TEST(Culprit, OfAStitchIsTheHandThatPullsItsThread) {
  Stitched h;
  EXPECT_EQ(h.who(), -1) << "a thread that no hand pulls";
  h.hold(h.left(), BodyId(BodyKind::suture, 0), 0, {0, 0, Stitched::kPull});
  EXPECT_EQ(h.who(), h.left());
  EXPECT_EQ(puller_of(h.context(), BodyId(BodyKind::suture, 0)), h.left());
}

TEST(Culprit, OfAStitchWithASlackThreadIsTheHandThatPullsTheTissueAway) {
  Stitched h;
  h.hold(h.left(), BodyId(BodyKind::suture, 0), 0, {0, 0, 0.01});
  EXPECT_EQ(h.who(), -1);
  h.press_beside(h.right(), 0.2 * Stitched::kPull);
  EXPECT_EQ(h.who(), -1) << "the thread does much more";
  h.press_beside(h.right(), Stitched::kPull);
  EXPECT_EQ(h.who(), h.right());
}

TEST(Culprit, OfABrokenThreadIsTheHandThatPullsItElseTheOneThatLoadsItsTissue) {
  Stitched h;
  const BodyId thread(BodyKind::suture, 0);
  EXPECT_EQ(breaker_of(h.context(), thread), -1);
  h.press_beside(h.right(), Stitched::kPull);
  EXPECT_EQ(breaker_of(h.context(), thread), h.right());
  h.hold(h.left(), thread, 0, {0, 0, 1});
  EXPECT_EQ(breaker_of(h.context(), thread), h.left());
}

TEST(Culprit, WhatTearsWithoutAHandIsAnEventOfNoHand) {
  small::Table t(weak());
  tissue::StrandState& tube = t.state.strands[small::kTube];
  const size_t at = tube.x.size() / 2;
  const double apart = length(tube.x[at + 1] - tube.x[at]);
  for (size_t i = at; i < tube.x.size(); ++i) tube.x[i].x += (i == at ? 10 : 20) * apart;
  t.state.overstretched_strands[small::kTube][at] = 49;  // as after 49 ticks of that
  t.step();
  ASSERT_EQ(t.count(Event::torn), 1);
  for (const Event& e : t.events) {
    if (e.kind != Event::torn) continue;
    EXPECT_EQ(e.hand, -1);
    EXPECT_EQ(e.body, kTube);
  }
}
