// The event of an object that falls: a State that a test writes, in the scene with the rings.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/events/registry.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

struct Watched {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/peg_transfer/scene.json"));
  sim::State state = sim::initial_state(model);
  std::unique_ptr<EventDetector> detector = kDropped.watch(model, {{true, -1, 0.005, 0.005, {}, {}}});
  EventInstances seen;

  interactions::RigidState& ring() { return interactions::part_of<interactions::Rigid>(state)[2]; }
  int ticks(int n) {
    seen.count = 0;
    for (int i = 0; i < n; ++i) ++state.tick, detector->tick({model, state}, {}, seen);
    return seen.count;
  }
  void hold(bool held) {
    state.tools[1].holds = held;
    state.tools[1].hold[0].at.body = BodyId(BodyKind::rigid, 2);
  }
  void fall(Vec3d to) {
    const Vec3d from = ring().x;
    for (int i = 1; i <= 100; ++i) {
      ring().x = from + i / 100.0 * (to - from);
      ticks(1);
    }
  }
  double in_view() const { return kDropped.attributes[0].value({model, state}, seen.list[0]).number; }
};

TEST(Dropped, WhatAHandHeldAndNobodyCatchesIsToldOnceItLies) {
  Watched w;
  EXPECT_EQ(w.ticks(500), 0) << "nobody has held it";
  w.hold(true);
  w.fall({0, 0.1, -0.09});
  w.hold(false);
  w.fall({0, 0.1, -0.118});
  EXPECT_EQ(w.ticks(500), 1);
  EXPECT_EQ(w.seen.list[0].hand, 1);
  EXPECT_EQ(*w.seen.list[0].name, "ring_3");
  EXPECT_EQ(w.in_view(), 1);
  EXPECT_EQ(w.ticks(500), 0);
}

TEST(Dropped, OutOfViewIsKnown) {
  Watched w;
  w.hold(true);
  w.ticks(10);
  w.hold(false);
  w.fall({0.3, -0.1, -0.2});
  ASSERT_EQ(w.ticks(500), 1);
  EXPECT_EQ(w.in_view(), 0);
}

TEST(Dropped, PutDownOrCaughtItIsNot) {
  Watched w;
  w.hold(true);
  w.fall({0, 0.1, -0.116});
  w.hold(false);
  w.fall({0, 0.1, -0.118});
  EXPECT_EQ(w.ticks(500), 0) << "2 mm are no fall";
  w.hold(true);
  w.fall({0, 0.1, -0.08});
  w.hold(false);
  w.fall({0, 0.1, -0.1});
  w.hold(true);
  EXPECT_EQ(w.ticks(500), 0) << "the other hand has it";
}

TEST(Dropped, WhereThereAreNoObjectsItSaysSo) {
  const sim::Model model;
  EXPECT_EQ(kDropped.lacks(model), "objects");
}

}  // namespace
