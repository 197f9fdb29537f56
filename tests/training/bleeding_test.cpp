// The judge of bleeding control, on States made by hand: which clips are right, what blood lost costs, what counts as
// stopped.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/expert.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

const Exercise& exercise() {
  static const Exercise e = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/bleeding-control.json");
  return e;
}

/// The holes of the scene by number: the first is in an artery that wants clips, on either side; one is small; one lies
/// under the pool.
enum Place { kWide = 0, kSmall = 3, kCovered = 5 };

sim::Model bleeding_at(Place place) {
  scene::Description scene = scene::read_scene(exercise().scene);
  scene.bleeder->which = place;
  return scene::compile(scene);
}
const sim::Model& scene_model(Place place = kWide) {
  static const sim::Model wide = bleeding_at(kWide), small = bleeding_at(kSmall), covered = bleeding_at(kCovered);
  return place == kSmall ? small : place == kCovered ? covered : wide;
}

const sim::Model& scene_model_without_pool() {
  static const sim::Model model = [] {
    scene::Description scene = scene::read_scene(exercise().scene);
    scene.fluids->pool_at_start = 0;
    return scene::compile(scene);
  }();
  return model;
}

/// An attempt whose State is what the test says.
struct Attempt {
  explicit Attempt(Place place = kWide) : model(scene_model(place)) {}
  const sim::Model& model;
  sim::State state = sim::initial_state(model);
  Monitor monitor{exercise(), model};

  const sim::Bleeder& bleeder() const { return model.vessels.bleeder; }

  void look(bool at_it) {
    const sim::VisibilityTarget& t = model.targets[size_t(model.target_index("bleeder"))];
    for (int i = t.first; i < t.first + t.count; ++i) state.seen[size_t(i)] = at_it;
  }
  /// @param flow  [mL/s]
  void pass(double seconds, double flow = 0) {
    for (int k = 0; k < int(seconds * 50); ++k) {
      state.tick += 20;
      const auto bled = std::int64_t(flow / 50 * double(fluids::kMillilitre));
      receive(state.fluids.ledger, fluids::Source::kBled, fluids::Place::kPool, {.blood = bled});
      monitor.update(model, state, {});
    }
  }
  void clear_pool() {
    move(state.fluids.ledger, fluids::Place::kPool, fluids::Place::kSucked,
         at(state.fluids.ledger, fluids::Place::kPool));
    fluids::PoolState& pool = state.fluids.pool;
    pool = sim::initial_state(scene_model_without_pool()).fluids.pool;
  }
  /// Heat has closed the artery there so well as it can.
  void seal(double off = 0) {
    interactions::VesselSeal& s = state.seals[size_t(state.seal_count++)];
    s = {};
    s.vessel = bleeder().vessel;
    s.from = s.to = bleeder().s + off;
    s.state.damage = 1e4;
  }
  interactions::Clip& clip(double off, double cover = 1, int vessel = -1) {
    interactions::Clip& c = state.clips[size_t(state.clip_count)];
    c = {};
    c.strand = 0;
    c.tips_visible = 2;
    c.closing_time = 2;
    c.cover = 1;
    interactions::VesselClip& v = state.vessel_clips[size_t(state.vessel_clip_count++)];
    v = {bleeder().s + off, cover, state.tick, vessel < 0 ? bleeder().vessel : vessel, state.clip_count++};
    return c;
  }
  bool done(const std::string& step) const {
    const auto& all = monitor.steps();
    return std::any_of(all.begin(), all.end(), [&](const StepStatus& s) { return s.task == step && s.done; });
  }
  int count(const char* code) const {
    return int(std::count_if(monitor.errors().begin(), monitor.errors().end(),
                             [code](const ErrorMade& e) { return e.code == code; }));
  }
};

TEST(BleedingControl, PassesWhoFindsClipsBothSidesClearsAndChecks) {
  Attempt a;
  a.look(true);
  a.pass(3);
  EXPECT_FALSE(a.done("find")) << "nothing bleeds yet";
  a.pass(2, 0.5);
  EXPECT_TRUE(a.done("find"));
  a.clip(-0.05);
  a.pass(1, 0.3);
  EXPECT_TRUE(a.done("close"));
  EXPECT_FALSE(a.done("stop")) << "it is fed from the other end, too";
  a.clip(0.05);
  a.pass(6);
  EXPECT_TRUE(a.done("stop"));
  EXPECT_TRUE(a.done("check"));
  EXPECT_FALSE(a.done("clear")) << "what lay there before is to be sucked away, too";
  a.clear_pool();
  a.pass(1);
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.errors().empty());
  EXPECT_TRUE(a.monitor.score().passed);
}

TEST(BleedingControl, ASmallArteryMayBeCoagulated) {
  Attempt a(kSmall);
  a.look(true);
  a.pass(7, 0.2);
  a.seal();
  a.pass(6);
  EXPECT_TRUE(a.done("close"));
  EXPECT_TRUE(a.done("stop"));
  a.clear_pool();
  a.pass(1);
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.errors().empty());
}

TEST(BleedingControl, ASealBeyondThePlaceClosesNothing) {
  Attempt a(kSmall);
  a.pass(7, 0.2);
  a.seal(0.05);
  a.pass(6);
  EXPECT_FALSE(a.done("close"));
}

TEST(BleedingControl, AWideArteryThatIsOnlyCoagulatedDoesNotPass) {
  Attempt a;
  a.look(true);
  a.pass(7, 0.2);
  a.seal();
  a.pass(6);
  a.clear_pool();
  a.pass(6);
  EXPECT_EQ(a.count("A3.5"), 1) << "once";
  EXPECT_FALSE(a.done("close"));
  EXPECT_FALSE(a.done("stop"));
  EXPECT_FALSE(a.monitor.score().passed);
}

TEST(BleedingControl, AWideArteryMayBeCoagulatedOnceItIsClipped) {
  Attempt a;
  a.pass(7, 0.2);
  a.clip(-0.05);
  a.pass(1);
  a.seal();
  a.pass(6);
  EXPECT_EQ(a.count("A3.5"), 0);
  EXPECT_TRUE(a.done("stop"));
}

TEST(BleedingControl, APlaceUnderThePoolIsFoundOnceItIsFree) {
  Attempt a(kCovered);
  a.look(true);
  a.pass(70, 0.01);
  EXPECT_FALSE(a.done("find"));
  EXPECT_EQ(a.count("E9.3"), 0) << "nobody can stop it there";
  a.clear_pool();
  a.pass(2, 0.01);
  EXPECT_TRUE(a.done("find"));
}

TEST(BleedingControl, APlaceThatIsNeverFreedIsControlledTooLate) {
  Attempt a(kCovered);
  a.pass(124, 0.01);
  EXPECT_EQ(a.count("E9.3"), 1);
}

TEST(BleedingControl, WhoCoagulatesUnderBloodHasMissedSuction) {
  const auto missed = [](bool dry) {
    Attempt a(kCovered);
    if (dry) a.clear_pool();
    const sim::VisibilityTarget& t = a.model.targets[size_t(a.model.target_index("bleeder"))];
    const Vec3d at = place_of(a.model, a.state, a.model.samples[size_t(t.first)]);
    const kinematics::FulcrumPose pose = kinematics::inverse(a.model.hands[0].port, at, 0);
    interactions::ToolState& tool = a.state.tools[0];
    tool.yaw = float(pose.yaw), tool.pitch = float(pose.pitch), tool.depth = float(pose.depth);
    a.state.electrodes[0].current.now.mode = tissue::EnergyMode::coag;
    a.pass(0.02);
    return a.count("E10");
  };
  EXPECT_EQ(missed(false), 1);
  EXPECT_EQ(missed(true), 0);
}

TEST(BleedingControl, FailsWhoseFirstClipLiesBeyondThePlace) {
  Attempt a;
  a.pass(1, 0.5);
  a.clip(0.05);
  a.pass(1, 0.5);
  EXPECT_EQ(a.count("A3.1"), 1);
  EXPECT_FALSE(a.done("close"));
  EXPECT_TRUE(a.monitor.score().failed);
}

TEST(BleedingControl, TellsWhatIsWrongWithAClip) {
  Attempt a;
  a.clip(-0.05, 0.8);
  a.clip(-0.05, 1, a.bleeder().vessel == 0 ? 1 : 0);
  a.clip(-0.05).closing_time = 0.5;
  a.clip(-0.05).tips_visible = 0;
  a.clip(-0.05).strand = -1;  // closed on nothing
  a.pass(0.02);
  for (const char* code : {"A3.3", "A3.2", "A3.4", "E4.2", "E12"}) EXPECT_EQ(a.count(code), 1) << code;
}

TEST(BleederFacts, SayHowWideItIsAndWhatHasBeenDone) {
  const Attempt small(kSmall);
  const auto value = [](const Attempt& a, const Fact& fact, const Arguments& given = {}) {
    return fact.watch(a.model, given)->value({a.model, a.state});
  };
  EXPECT_NEAR(value(small, kBleederCalibre).number, 0.0008, 1e-9);
  EXPECT_NEAR(value(Attempt(), kBleederCalibre).number, 2 * (0.00065 - 0.0001 * 0.861), 1e-9);

  Argument heart, beyond, cover;
  heart.word = "heart", beyond.word = "beyond", cover.low = cover.high = 0.98;
  Attempt a;
  EXPECT_FALSE(value(a, kBleederClipped, {heart, cover}).number != 0);
  a.clip(-0.05, 0.9);
  EXPECT_FALSE(value(a, kBleederClipped, {heart, cover}).number != 0) << "too little of it";
  a.clip(0.05);
  EXPECT_FALSE(value(a, kBleederClipped, {heart, cover}).number != 0);
  EXPECT_TRUE(value(a, kBleederClipped, {beyond, cover}).number != 0);
  a.clip(-0.05);
  EXPECT_TRUE(value(a, kBleederClipped, {heart, cover}).number != 0);
  EXPECT_FALSE(value(a, kBleederSealed).number != 0);
  a.seal();
  EXPECT_TRUE(value(a, kBleederSealed).number != 0);
  a.state.seals[0].state.damage = 10;
  EXPECT_FALSE(value(a, kBleederSealed).number != 0) << "it would burst";
}

TEST(BleederFacts, CountTheTimeThatThePlaceStandsFree) {
  Attempt a(kCovered);
  const auto free = kBleederUncovered.watch(a.model, {});
  const auto pass = [&](double seconds) {
    for (int k = 0; k < int(seconds * 50); ++k) a.state.tick += 20, free->sample({a.model, a.state}, 0.02);
    return free->value({a.model, a.state}).number;
  };
  EXPECT_EQ(pass(10), 0) << "under the pool";
  a.clear_pool();
  EXPECT_NEAR(pass(3), 3, 1e-9);
  Attempt early;
  const auto not_yet = kBleederUncovered.watch(early.model, {});
  not_yet->sample({early.model, early.state}, 0.02);
  EXPECT_EQ(not_yet->value({early.model, early.state}).number, 0) << "nothing bleeds yet";
}

TEST(BleedingControl, CountsBloodOnceABandAndFailsTheAttemptAtTheLast) {
  Attempt a;
  a.pass(1, 9.9);
  EXPECT_EQ(a.count("E9.1"), 0);
  a.pass(1, 1);
  EXPECT_EQ(a.count("E9.1"), 1);
  a.pass(1, 45);
  EXPECT_EQ(a.count("E9.2"), 1);
  EXPECT_FALSE(a.monitor.score().failed);
  a.pass(2, 100);
  EXPECT_EQ(a.count("E9"), 1);
  EXPECT_EQ(a.monitor.errors().size(), 3u);
  EXPECT_TRUE(a.monitor.score().failed);
}

TEST(BleedingControl, ABleedingThatEndsByItselfIsNotStopped) {
  Attempt a;
  a.look(true);
  a.pass(2, 0.5);
  a.pass(5);
  EXPECT_FALSE(a.done("stop"));
  EXPECT_EQ(a.count("E9.3"), 0);
  a.pass(90);
  EXPECT_EQ(a.count("E9.3"), 1) << "late, and told once";
}

TEST(BleedingControl, WantsThePoolCleared) {
  Attempt a;
  a.look(true);
  a.pass(2, 6);
  a.clip(-0.05);
  a.clip(0.05);
  a.pass(5);
  EXPECT_TRUE(a.done("stop"));
  EXPECT_FALSE(a.done("clear")) << "12 mL";
  a.clear_pool();
  a.pass(1);
  EXPECT_TRUE(a.done("clear"));
}

TEST(BleedingControl, APoolThatIsLeftForAMinuteIsMissedSuction) {
  Attempt a;
  a.pass(2, 6);
  a.clip(-0.05);
  a.pass(5);
  ASSERT_TRUE(a.done("stop"));
  a.pass(50);
  EXPECT_EQ(a.count("E10"), 0);
  a.pass(20);
  EXPECT_EQ(a.count("E10"), 1) << "and told once";
}

TEST(BleedingControl, AClipUnderBloodIsMissedSuction) {
  const auto missed = [](double litres) {
    Attempt a;
    const fluids::PoolModel& pool = a.model.wet.model.pool;
    const size_t hand = 2;
    const fluids::PoolPoint at = locate(pool, tip_of(a.model, a.state, hand));
    EXPECT_TRUE(at.inside);
    pour(pool, at.i, at.j, {.blood = std::int64_t(1000 * litres * double(fluids::kMillilitre))}, a.state.fluids.pool);
    a.clip(-0.05).tool = int(hand);
    a.pass(0.02);
    return a.count("E10");
  };
  EXPECT_EQ(missed(1e-6), 0) << "a trace on the floor";
  EXPECT_EQ(missed(0.001), 1) << "a column that stands higher than the jaws";
}

/// One hand's electrode, which does what the test says.
struct Electrode : Attempt {
  sim::ElectrodeHand& hand = state.electrodes[0];
  void press(double seconds, bool flows, BodyId body = {}) {
    hand.current.now.mode = tissue::EnergyMode::coag;
    hand.current.now.flows = flows;
    hand.body = body;
    for (int t = 0; t < int(seconds * 1000 + 0.5); ++t) ++state.tick, monitor.update(model, state, {});
  }
  void release() {
    hand.current.now = {};
    ++state.tick, monitor.update(model, state, {});
  }
  BodyId carrier() const {
    return sim::body_of(model, bleeder().vessel == model.vessel_index("ovarian_left")
                                   ? "infundibulopelvic_ligament_left"
                                   : "infundibulopelvic_ligament_right");
  }
};

TEST(EnergyWatch, APedalMayBePressedBesideNothingForAMoment) {
  Electrode e;
  e.press(0.25, false);
  e.release();
  e.press(0.25, false);
  EXPECT_EQ(e.count("E6"), 0);
  e.press(0.5, false);
  EXPECT_EQ(e.count("E6"), 1) << "once an activation";
}

TEST(EnergyWatch, CurrentIsForWhatCarriesTheArtery) {
  Electrode e;
  e.press(0.5, true, e.carrier());
  e.release();
  EXPECT_TRUE(e.monitor.errors().empty());
  e.press(0.5, true, sim::body_of(e.model, "tube_left"));
  EXPECT_EQ(e.count("E7"), 1) << "once an activation";
  EXPECT_FALSE(e.monitor.score().failed);
  e.release();
  e.press(0.1, true, sim::body_of(e.model, "rectosigmoid"));
  EXPECT_EQ(e.count("E7.1"), 1);
  EXPECT_TRUE(e.monitor.score().failed) << "bowel";
}

TEST(EnergyWatch, AHotTipMayTouchWhatCarriesTheArteryAndNothingElseForLong) {
  Electrode e;
  const auto touch = [&e](BodyId body, double seconds) {
    e.hand.current.now = {};
    e.hand.current.now.hot_touch = 1;
    e.hand.body = body;
    for (int t = 0; t < int(seconds * 1000 + 0.5); ++t) ++e.state.tick, e.monitor.update(e.model, e.state, {});
    e.release();
  };
  touch(e.carrier(), 1);
  touch(sim::body_of(e.model, "tube_left"), 0.05);
  EXPECT_TRUE(e.monitor.errors().empty());
  touch(sim::body_of(e.model, "tube_left"), 1);
  EXPECT_EQ(e.count("E7.2"), 1) << "once a touch";
  EXPECT_FALSE(e.monitor.score().failed);
  touch(sim::body_of(e.model, "tube_left"), 0.2);
  EXPECT_EQ(e.count("E7.2"), 1) << "a tip that bounces touches once";
  for (int t = 0; t < 500; ++t) e.release();
  touch(sim::body_of(e.model, "tube_left"), 0.2);
  EXPECT_EQ(e.count("E7.2"), 2);
}

TEST(EnergyWatch, WhatWasBurntIsTouchedAnewOnlyOnceTheTipHasLeftIt) {
  Electrode e;
  const BodyId tube = sim::body_of(e.model, "tube_left");
  const auto touch = [&e](BodyId body, double seconds) {
    e.hand.current.now = {};
    e.hand.current.now.hot_touch = 1;
    e.hand.body = body;
    for (int t = 0; t < int(seconds * 1000 + 0.5); ++t) ++e.state.tick, e.monitor.update(e.model, e.state, {});
  };
  e.press(0.5, true, tube);
  touch(tube, 1);  // the pedal is up, and the tip still there
  EXPECT_EQ(e.count("E7"), 1);
  EXPECT_EQ(e.count("E7.2"), 0) << "told by what the current did";
  touch(sim::body_of(e.model, "uterus"), 0.2);
  EXPECT_EQ(e.count("E7.2"), 1) << "another one";
  for (int t = 0; t < 500; ++t) e.release();
  touch(tube, 0.2);
  EXPECT_EQ(e.count("E7.2"), 2) << "back again, still hot";
}

TEST(EnergyWatch, TissueMayDieSoFarFromTheElectrode) {
  const auto told = [](double beyond) {
    Electrode e;
    const tissue::HeatModel& heat = e.model.energy.heat;
    e.hand.a = e.hand.b = {0.5 * heat.cell, 0.5 * heat.cell, 0.5 * heat.cell};
    e.press(0.1, true, e.carrier());
    const double allowed = e.model.tool(e.state, 0).electrode.current.radius + exercise().limit("hook_spread_mm", 0);
    const int cells = int(std::floor((allowed + beyond) / heat.cell)), at = cells % tissue::kBrickSide;
    e.state.heat.key[0] = {e.carrier(), cells / tissue::kBrickSide, 0, 0};
    e.state.heat.slot[0] = tissue::HeatState::kAsleep;
    e.state.heat.cells[size_t(at)] = tissue::HeatState::kTissue;
    e.state.heat.damage[size_t(at)] = 1;
    e.pass(1);
    return e.count("E8");
  };
  EXPECT_EQ(told(0), 0);
  EXPECT_EQ(told(0.001), 1);
}

TEST(BleedingControl, SaysWhatTheSceneLacks) {
  const sim::Model calm = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json"));
  try {
    Monitor monitor(exercise(), calm);
    FAIL() << "expected faults";
  } catch (const core::BadInput& e) {
    const std::string all = e.what();
    EXPECT_NE(all.find("bleeder"), std::string::npos) << all;
    EXPECT_NE(all.find("fluids"), std::string::npos) << all;
  }
  EXPECT_THROW(make_expert(exercise(), calm), core::BadInput);
}

}  // namespace
}  // namespace trocar::training
