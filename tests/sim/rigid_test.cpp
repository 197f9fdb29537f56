// Rigid objects in the step: rings on the board of a box trainer, dropped, tilted, grasped and handed over.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>

#include "shipped.hpp"
#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;
using interactions::Rigid;
using interactions::RigidState;

namespace {

constexpr int kLeft = 0, kRight = 1;  // hands
constexpr double kFloor = -0.120, kLies = kFloor + 0.00175;
constexpr double kPegs = 0.6;  // handle: jaws so far open that they straddle a ring's rim

scene::Description board() { return scene::read_scene(TROCAR_SOURCE_DIR "/scenes/peg_transfer/scene.json"); }

std::vector<scene::RigidSetting>& rings_of(scene::Description& d) {
  return settings_of(scene::RigidScene{}, d.objects);
}

/// One ring, on the board without pegs unless asked for.
Model one_ring(Vec3d at, Vec3d axis = {0, 0, 1}, Vec3d gravity = {0, 0, -9.81}, bool pegs = false) {
  scene::Description d = board();
  d.gravity = gravity;
  rings_of(d).resize(1);
  rings_of(d)[0].place = at;
  rings_of(d)[0].axis = axis;
  if (!pegs) d.walls.resize(1);
  return scene::compile(d);
}

RigidState& ring(State& s, size_t i = 0) { return interactions::part_of<Rigid>(s)[i]; }
const RigidState& ring(const State& s, size_t i = 0) { return interactions::part_of<Rigid>(s)[i]; }

double energy(const Model& m, const State& s, size_t i = 0) {
  const interactions::RigidModel& body = interactions::part_of<Rigid>(m).list[i];
  const RigidState& now = ring(s, i);
  const Vec3d w = rotate(conjugate(now.q), now.w);
  return body.mass * (0.5 * dot(now.v, now.v) - dot(m.gravity, now.x)) + 0.5 * dot(w, body.inertia * w);
}

/// Seen from where it lies, the way along `slope` that it slides in `ticks` [m].
double slides(double degrees, int ticks) {
  const double a = degrees * portable::pi / 180;
  const Model m = one_ring({0, 0.075, kLies}, {0, 0, 1}, {0, 9.81 * portable::sin(a), -9.81 * portable::cos(a)});
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < ticks; ++i) step(m, m.start, s, w);
  return ring(s).x.y - 0.075;
}

/// The left grasper has closed on a ring's rim and lifted it by 30 mm.
struct Lifted : small::Table {
  Vec3d tip;
  explicit Lifted(const Model& m) : Table(m) {
    const Vec3d rim = ring(state).x + Vec3d{-0.00625, 0, 0}, above = rim + Vec3d{0, 0, 0.03};
    input.tools[kLeft].handle = float(kPegs);
    carry(kLeft, {-0.022, 0.088, -0.075}, above, 0.1);
    tip = rim + Vec3d{0, 0, 0.0005};
    carry(kLeft, above, tip, 0.05);
    close_slowly(kLeft, 1, 300);
    lift({0, 0, 0.03});
  }
  void lift(Vec3d by) {
    carry(kLeft, tip, tip + by, 0.1);
    tip += by;
    steps(200);
  }
};

TEST(Rigid, ARingAtRestStays) {
  const Model& m = shipped("peg_transfer");
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 500; ++i) step(m, m.start, s, w);
  const State settled = s;
  for (int i = 0; i < 5000; ++i) step(m, m.start, s, w);
  for (size_t i = 0; i < interactions::part_of<Rigid>(s).size(); ++i) {
    EXPECT_LT(length(ring(s, i).x - ring(settled, i).x), 1e-6) << i;
    EXPECT_NEAR(ring(s, i).x.z, kLies, 1e-4) << i;
    EXPECT_LT(length(ring(s, i).w), 1e-3) << i;
  }
}

TEST(Rigid, EnergyNeverGrowsWhenItIsDropped) {
  core::Random random(5);
  for (int trial = 0; trial < 12; ++trial) {
    const Vec3d axis{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Model m = one_ring({-0.026, 0.1, kFloor + 0.06}, axis, {0, 0, -9.81}, trial % 2 == 0);
    State s = initial_state(m);
    Work w = make_work(m);
    ring(s).w = {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20)};
    ring(s).v = {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0};
    const double whole = energy(m, s) + 1.2e-3 * 9.81 * kFloor * -1;
    double least = energy(m, s), grown = 0;
    for (int i = 0; i < 1500; ++i) {
      step(m, m.start, s, w);
      const double now = energy(m, s);
      grown = std::max(grown, now - least);
      least = std::min(least, now);
    }
    EXPECT_LT(grown, 1e-4 * whole + 2e-9) << trial;
    EXPECT_LT(least, energy(m, initial_state(m))) << "it fell";
  }
}

TEST(Rigid, ItSlidesAtCoulombsAngle) {
  EXPECT_LT(slides(15, 1000), 1e-5) << "atan 0.3 is 16.7 degrees";
  const double a = 20 * portable::pi / 180, pull = 9.81 * (portable::sin(a) - 0.3 * portable::cos(a));
  EXPECT_NEAR(slides(20, 400), 0.5 * pull * 0.4 * 0.4, 0.03 * 0.5 * pull * 0.4 * 0.4);
}

TEST(Rigid, FreeFallIsGalileos) {
  const Model m = one_ring({0, 0.1, -0.03});
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 100; ++i) step(m, m.start, s, w);
  EXPECT_NEAR(ring(s).x.z, -0.03 - 0.5 * 9.81 * 0.1 * 0.1, 9.81 * 0.1 * 1e-3);
  EXPECT_NEAR(ring(s).v.z, -9.81 * 0.1, 1e-9);
}

TEST(Rigid, DroppedOverAPegItLandsOnIt) {
  const Model m = one_ring({-0.0245, 0.1, kFloor + 0.035}, {0.1, 0, 1}, {0, 0, -9.81}, true);
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 1500; ++i) step(m, m.start, s, w);
  EXPECT_NEAR(ring(s).x.z, kLies, 3e-4);
  EXPECT_LT(std::hypot(ring(s).x.x + 0.026, ring(s).x.y - 0.1), 0.0045);
}

TEST(Rigid, AHeldRingFollowsTheJaws) {
  const Model m = one_ring({-0.01, 0.1, kLies});
  Lifted t(m);
  ASSERT_GT(t.tool(kLeft).holds, 0);
  ASSERT_EQ(t.tool(kLeft).hold[0].at.body, BodyId(BodyKind::rigid, 0));
  EXPECT_EQ(t.count(Event::grasped), 1);
  EXPECT_EQ(t.count(Event::slipped), 0);
  EXPECT_GT(ring(t.state).x.z, kLies + 0.025);
  const auto in_jaws = [&t] {
    const interactions::ToolModel& tool = t.model.tool(t.state, kLeft);
    return to_jaw(interactions::shape_of(tool, t.tool(kLeft).pose(), t.tool(kLeft).aperture), ring(t.state).x);
  };
  const Vec3d before = in_jaws();
  t.lift({0.02, -0.02, 0.01});
  EXPECT_LT(length(in_jaws() - before), 5e-4);
  EXPECT_NEAR(length(t.pull(kLeft)), 1.2e-3 * 9.81, 2e-3) << "its weight";
  t.close_slowly(kLeft, 0, 100);
  t.steps(800);
  EXPECT_EQ(t.count(Event::released), 1);
  EXPECT_NEAR(ring(t.state).x.z, kLies, 5e-3) << "it has fallen";
  EXPECT_EQ(t.flags, 0u);
}

TEST(Rigid, ARingGoesFromHandToHand) {
  const Model m = one_ring({-0.01, 0.1, kLies});
  Lifted t(m);
  ASSERT_GT(t.tool(kLeft).holds, 0);
  const RigidState held = ring(t.state);
  // The right hand comes to the rim across from where the left one holds it, with jaws that straddle it.
  const Vec3d far_rim =
      held.x + (held.x - interactions::Rigid::point(interactions::part_of<Rigid>(t.model),
                                                    interactions::part_of<Rigid>(t.state), t.tool(kLeft).hold[0].at));
  t.input.tools[kRight].handle = 0.5f;
  t.carry(kRight, {0.022, 0.088, -0.075}, far_rim + Vec3d{0.01, 0, 0.02}, 0.1);
  t.carry(kRight, far_rim + Vec3d{0.01, 0, 0.02}, far_rim, 0.05);
  t.close_slowly(kRight, 1, 300);
  ASSERT_GT(t.tool(kRight).holds, 0);
  ASSERT_GT(t.tool(kLeft).holds, 0) << "both hold it";
  t.close_slowly(kLeft, 0, 200);
  t.steps(500);
  EXPECT_EQ(t.tool(kLeft).holds, 0);
  EXPECT_GT(t.tool(kRight).holds, 0);
  EXPECT_LT(length(ring(t.state).x - held.x), 0.012);
  EXPECT_GT(ring(t.state).x.z, kLies + 0.015);
}

TEST(Rigid, NothingThatHandsDoThrowsItOutOrMakesItNaN) {
  const Model& m = shipped("peg_transfer");
  small::Table t(m);
  core::Random random(9);
  for (int round = 0; round < 60; ++round) {
    for (const int hand : {kLeft, kRight}) {
      t.point(hand, {random.uniform(-0.06, 0.06), random.uniform(0.06, 0.14), random.uniform(-0.118, -0.09)});
      t.close(hand, random.uniform(0, 1));
      t.input.tools[size_t(hand)].roll = float(random.uniform(-2, 2));
    }
    t.steps(100);
  }
  for (size_t i = 0; i < 6; ++i) {
    ASSERT_TRUE(std::isfinite(length(ring(t.state, i).x)));
    const Vec3d at = ring(t.state, i).x;
    const bool on_board = std::fabs(at.x) < 0.075 && at.y > 0.045 && at.y < 0.155;
    EXPECT_GT(at.z, on_board ? kFloor - 0.001 : -0.16) << i << " at " << at.x << " " << at.y;
    EXPECT_LT(length(ring(t.state, i).v), 2) << i;
  }
  EXPECT_EQ(t.flags & tissue::StepReport::kNonFinite, 0u);
}

TEST(Rigid, AKeyframeHasIt) {
  const Model& m = shipped("peg_transfer");
  State s = initial_state(m), shown = initial_state(m);
  ring(s, 2).x = {0.01, 0.08, -0.05};
  ring(s, 2).q = normalised(Quatd{0.5, 0.1, 0.7, -0.2});
  ASSERT_TRUE(restore_display(m, display_bytes(m, s), shown));
  EXPECT_EQ(ring(shown, 2).x, ring(s, 2).x);
  EXPECT_TRUE(ring(shown, 2).q == ring(s, 2).q);
}

TEST(Rigid, SavedAndPoisonedItGoesOnTheSame) {
  const Model m = one_ring({-0.026, 0.1, kFloor + 0.05}, {1, 0.3, 0.2}, {0, 0, -9.81}, true);
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 120; ++i) step(m, m.start, s, w);
  State saved = s;
  Work fresh = make_work(m);
  for (int i = 0; i < 300; ++i) {
    step(m, m.start, s, w);
    poison(fresh);
    step(m, m.start, saved, fresh);
  }
  EXPECT_EQ(hash_of(s), hash_of(saved));
  EXPECT_NE(hash_of(s), hash_of(initial_state(m)));
}

/// A pebble of 1 g over the pad of the small scene.
Model pebble_on_pad() {
  scene::Description d = small::description();
  d.solids.erase(d.solids.begin() + 2);
  d.vessels.clear();
  d.fluids.reset();
  scene::RigidSetting s;
  s.name = "pebble";
  s.pebble = {0.007, 0.006, 0.005};
  s.thick = s.pebble.z;
  s.mass = 0.001;
  s.place = {0.050, 0, 0.004};
  settings_of(scene::RigidScene{}, d.objects).push_back(s);
  return scene::compile(d);
}

TEST(Rigid, APebbleFallsOnTissueAndLiesThere) {
  const Model m = pebble_on_pad();
  State s = initial_state(m);
  Work w = make_work(m);
  double least = 1, grown = 0;
  const auto whole = [&] { return 0.001 * (0.5 * dot(ring(s).v, ring(s).v) + 9.81 * ring(s).x.z); };
  for (int i = 0; i < 3000; ++i) {
    step(m, m.start, s, w);
    grown = std::max(grown, whole() - least);
    least = std::min(least, whole());
  }
  EXPECT_NEAR(ring(s).x.z, -0.0021 + 0.0025, 0.0015) << "on the pad's top, at -2.1 mm";
  EXPECT_LT(length(ring(s).v), 1e-3);
  EXPECT_LT(grown, 2e-6) << "it does not jump";
}

TEST(Rigid, WhatLiesOnTissueWeighsOnIt) {
  const Model m = pebble_on_pad();
  State s = initial_state(m);
  Work w = make_work(m);
  for (int i = 0; i < 2500; ++i) step(m, m.start, s, w);
  double force = 0;  // that the skin is pressed with, mean of some ticks
  for (int i = 0; i < 100; ++i) {
    step(m, m.start, s, w);
    for (const interactions::RigidBed& bed : interactions::part_of<Rigid>(w).beds)
      force += std::max(0.0, -bed.gap) * 150 * bed.normal.z / 100;
  }
  EXPECT_NEAR(force, 9.81e-3, 2e-3);
}

}  // namespace
