// Whose hand tissue tore under, and what is said where no hand is to blame.
#include <gtest/gtest.h>

#include <trocar/sim/model/culprit.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr BodyId kTube = BodyId::strand(small::kTube), kCord = BodyId::strand(small::kCord);

struct Hands {
  State state = initial_state(small::model());

  void hold(int hand, BodyId body, double pull) {
    interactions::ToolState& tool = state.tools[size_t(hand)];
    tool.holds = 1;
    tool.hold[0].body = body;
    tool.pull[0] = pull;
  }
  void press(int hand, double force) { state.tools[size_t(hand)].contact_force[1] = force; }
  int culprit(std::initializer_list<BodyId> bodies) const { return sim::culprit(small::model(), state, bodies); }
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

}  // namespace

TEST(Culprit, IsTheHandThatHoldsTheBodyThoughAnotherPressesHarder) {
  Hands h;
  h.hold(small::kGrasper, kTube, 2);
  h.press(small::kScissors, 9);
  EXPECT_EQ(h.culprit({kTube}), small::kGrasper);
  EXPECT_EQ(h.culprit({kCord}), small::kScissors);
}

TEST(Culprit, OfTwoHandsThatHoldItIsTheOneThatPullsHarder) {
  Hands h;
  h.hold(small::kGrasper, kTube, 2);
  h.hold(small::kApplier, kTube, 3);
  EXPECT_EQ(h.culprit({kTube}), small::kApplier);
}

TEST(Culprit, OfAStitchIsTheHandThatHoldsItsThread) {
  Hands h;
  const BodyId thread(BodyKind::suture, 0);
  h.press(small::kGrasper, 9);
  h.hold(small::kScissors, thread, 1);
  EXPECT_EQ(h.culprit({thread, kTube}), small::kScissors);
}

TEST(Culprit, IsNobodyWhereNoHandExertsAForce) { EXPECT_EQ(Hands().culprit({kTube}), -1); }

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
    EXPECT_EQ(e.tool, -1);
    EXPECT_EQ(e.body(), kTube);
  }
}
