// Organs that answer at once, in the step: what others see of them, and how they are handed over to their networks.
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/parallel.hpp>
#include <trocar/core/random.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr size_t kOrgan = 0, kPad = 1, kBarStatic = 2;  // among the statics, which are in the order of the scene

const StaticOrganState& organ_state(const State& s, size_t i) { return s.statics[i]; }

std::vector<Vec3d> places(const Model& m, const State& s, int organ) {
  const tissue::NodeView nodes = nodes_of(m, s, organ);
  std::vector<Vec3d> out;
  for (size_t i = 0; i < drawn_nodes(m, organ).size(); ++i) out.push_back(nodes.position(int(i)));
  return out;
}
/// Of the skin, which is what one sees and touches.
std::vector<Vec3d> skin_places(const Model& m, const State& s, int organ) {
  tissue::SkinPose pose = tissue::make_pose(m.skin(organ));
  tissue::pose_skin(nodes_of(m, s, organ), m.skin(organ), pose);
  std::vector<Vec3d> out;
  for (const Vec3f& p : pose.position) out.push_back(vec_cast<double>(p));
  return out;
}

double farthest(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double most = 0;
  for (size_t i = 0; i < a.size(); ++i) most = std::max(most, length(a[i] - b[i]));
  return most;
}

double off_drawn(const Model& m, const State& s, int organ) {
  const std::span<const Vec3d> drawn = drawn_nodes(m, organ);
  return farthest(places(m, s, organ), {drawn.begin(), drawn.end()});
}

Model compiled(void (*change)(scene::Description&)) {
  scene::Description d = small::static_description();
  change(d);
  return scene::compile(d);
}

constexpr Vec3d kPressed{0.050, -0.007, -0.0008};  // on the pad's top, beside the tube [m]

/// Presses the pad's middle down with the closed grasper, by `deep` from its surface; at rest there.
void press_pad(small::Table& table, double deep) {
  table.close(small::kGrasper, 1);
  table.carry(small::kGrasper, {0.055, 0, 0.04}, kPressed + Vec3d{0, 0, 0.004}, 0.2);
  table.carry(small::kGrasper, kPressed + Vec3d{0, 0, 0.004}, kPressed - Vec3d{0, 0, deep}, 0.02);
  table.steps(300);
}

}  // namespace

TEST(StaticOrgan, LiesAsItWasDrawnWhateverHangsOnIt) {
  const Model& m = small::statics();
  State s = initial_state(m);
  Work w = make_work(m);
  std::uint32_t flags = 0;
  for (int i = 0; i < 500; ++i) flags |= step(m, m.start, s, w).flags;
  EXPECT_EQ(flags & (tissue::StepReport::kBadLoad | tissue::StepReport::kNonFinite), 0u);
  for (int organ = 0; organ < m.organs(); ++organ) EXPECT_LT(off_drawn(m, s, organ), 5e-5) << m.organ_name(organ);
}

TEST(StaticOrgan, GivesWayUnderAnInstrumentAndFeelsLikeTheNetwork) {
  // The pad's contacts are springs of their own, softer than it, so that both are about as deep.
  double force[2], moved[2];
  for (const bool at_once : {false, true}) {
    small::Table table(at_once ? small::statics() : small::model());
    press_pad(table, 0.0005);
    const double* f = table.tool(small::kGrasper).contact_force;
    force[at_once] = length(Vec3d{f[0], f[1], f[2]});
    moved[at_once] = off_drawn(table.model, table.state, int(kPad));
  }
  EXPECT_GT(force[0], 0.02);
  EXPECT_GT(moved[0], 1e-4);
  EXPECT_NEAR(force[1], force[0], 0.03 * force[0]);
  EXPECT_NEAR(moved[1], moved[0], 0.03 * moved[0]);
}

TEST(StaticOrgan, LetGoItReturnsWithoutAJump) {
  small::Table table(small::statics());
  press_pad(table, 0.003);
  EXPECT_GT(off_drawn(table.model, table.state, int(kPad)), 0.001);
  double quickest = 0;
  std::vector<Vec3d> before = skin_places(table.model, table.state, int(kPad));
  for (int i = 0; i < 600; ++i) {
    table.point(small::kGrasper, kPressed + Vec3d{0, 0, -0.003 + std::min(0.010, 0.00005 * i)});
    table.step();
    std::vector<Vec3d> now = skin_places(table.model, table.state, int(kPad));
    quickest = std::max(quickest, farthest(now, before));
    before = std::move(now);
  }
  EXPECT_LE(quickest, 0.0002 * 1.01);
  EXPECT_LT(off_drawn(table.model, table.state, int(kPad)), 5e-5);
}

TEST(StaticOrgan, IsGraspedPulledAndLetGo) {
  small::Table table(small::statics());
  const int hand = small::kGrasper;
  const Vec3d above{0.050, -0.014, 0.02}, side{0.050, -0.014, -0.009};  // astride the pad's edge
  table.carry(hand, {0.055, 0, 0.04}, above, 0.2);
  table.carry(hand, above, side, 0.05);
  table.close_slowly(hand, 1, 300);
  ASSERT_EQ(table.count(Event::grasped), 1);
  const BodyId held = table.tool(hand).hold[0].at.body;
  ASSERT_TRUE(held.is(BodyKind::organ));
  table.carry(hand, side, side + Vec3d{0, -0.002, 0.003}, 0.02);
  table.steps(200);
  EXPECT_GT(length(table.pull(hand)), 0.05);
  EXPECT_GT(off_drawn(table.model, table.state, int(held.index())), 0.001);
  table.close_slowly(hand, 0, 100);
  table.carry(hand, side + Vec3d{0, -0.002, 0.003}, above, 0.05);
  table.steps(500);
  EXPECT_LT(off_drawn(table.model, table.state, int(held.index())), 1e-4);
  EXPECT_TRUE(organ_state(table.state, held.index()).at_once());
}

TEST(StaticOrgan, ACutHandsItOver) {
  const Model& m = small::statics();
  State s = initial_state(m);
  Work w = make_work(m);
  small::Hands hands(m);
  hands.cut_at = -1;
  int cuts = 0;
  while (!hands.done()) {
    const StepReport report = step(m, hands.next(s), s, w);
    for (int e = 0; e < report.event_count; ++e) cuts += report.events[e].kind == Event::cut;
    EXPECT_EQ(organ_state(s, kBarStatic).at_once(), cuts == 0) << s.tick;
  }
  EXPECT_GT(cuts, 0);
  EXPECT_TRUE(organ_state(s, kOrgan).at_once());
  EXPECT_TRUE(organ_state(s, kPad).at_once());
}

TEST(StaticOrgan, HandedOverItDoesNotJumpAndRestsWhereItsNetworkDoes) {
  const Model by_angle = compiled([](scene::Description& d) {
    d.solids[0].beyond = scene::BeyondLinear::switch_to_dynamic;
    d.solids[0].beyond_angle = 0.01;
  });
  const Vec3d from{0.055, 0, 0.04}, over{-0.014, 0, 0.022}, on{-0.014, 0, 0.0095};
  double off[2], quickest = 0;
  for (const bool at_once : {false, true}) {
    small::Table table(at_once ? by_angle : small::model());
    table.close(small::kGrasper, 1);
    table.carry(small::kGrasper, from, over, 0.2);
    std::vector<Vec3d> before = skin_places(table.model, table.state, int(kOrgan));
    for (int i = 0; i < 1200; ++i) {
      table.point(small::kGrasper, over + std::min(1.0, i / 600.0) * (on - over));
      table.step();
      std::vector<Vec3d> now = skin_places(table.model, table.state, int(kOrgan));
      if (at_once && !organ_state(table.state, kOrgan).at_once()) quickest = std::max(quickest, farthest(now, before));
      before = std::move(now);
    }
    off[at_once] = off_drawn(table.model, table.state, int(kOrgan));
  }
  EXPECT_GT(quickest, 0) << "it was handed over";
  EXPECT_LT(quickest, 0.0002) << "[m] in a tick";
  EXPECT_GT(off[0], 0.0005);
  EXPECT_NEAR(off[1], off[0], 0.02 * off[0]);
}

TEST(StaticOrgan, TurnedTooFarItSaysSo) {
  const Model warns = compiled([](scene::Description& d) { d.solids[0].beyond_angle = 1e-3; });
  small::Table table(warns);
  table.close(small::kGrasper, 1);
  table.carry(small::kGrasper, {0.055, 0, 0.04}, {-0.014, 0, 0.022}, 0.2);
  EXPECT_EQ(table.flags & tissue::StepReport::kBeyondLinear, 0u);
  table.carry(small::kGrasper, {-0.014, 0, 0.022}, {-0.014, 0, 0.0095}, 0.02);
  EXPECT_NE(table.flags & tissue::StepReport::kBeyondLinear, 0u);
  EXPECT_TRUE(organ_state(table.state, kOrgan).at_once());
}

TEST(StaticOrgan, RecordedHandsAreVerified) {
  // Grasp, lift, clips, the tube cut through, and the bar, which is handed over by that.
  const Model& m = small::statics();
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / ("trocar_static_" + std::to_string(getpid()) + ".rec");
  {
    RecordingHeader header;
    header.model_hash = m.hash;
    RecordingWriter writer(file, header);
    State s = initial_state(m);
    Work w = make_work(m);
    small::Hands hands(m);
    while (!hands.done()) {
      const Input input = hands.next(s);
      writer.tick(s.tick, input);
      step(m, input, s, w);
      if (s.tick % kHashEvery == 0) writer.hash(s.tick, hash_of(s));
    }
    writer.finish("{}");
    EXPECT_FALSE(organ_state(s, kBarStatic).at_once());
  }
  const Recording r = read_recording(file);
  std::filesystem::remove(file);
  ASSERT_TRUE(r.complete);
  const Model again = scene::compile(small::static_description());
  ASSERT_EQ(again.hash, r.header.model_hash);
  State s = initial_state(again);
  Work w = make_work(again);
  std::size_t mark = 0;
  for (const Input& input : r.inputs) {
    step(again, input, s, w);
    if (mark == r.hashes.size() || r.hashes[mark].tick != s.tick) continue;
    EXPECT_EQ(r.hashes[mark++].hash, hash_of(s)) << s.tick;
  }
  EXPECT_EQ(mark, r.hashes.size());
  EXPECT_GT(mark, 50u);
}

TEST(StaticOrgan, ThreadsScratchAndASavedStateChangeNoBit) {
  const Model& m = small::statics();
  std::vector<Input> inputs;
  State s = initial_state(m), saved;
  Work w = make_work(m);
  small::Hands hands(m);
  while (!hands.done()) {
    if (inputs.size() == 4700) saved = s;
    inputs.push_back(hands.next(s));
    step(m, inputs.back(), s, w);
  }
  core::ThreadPool pool(3);
  State threaded = initial_state(m);
  Work many = make_work(m, &pool);
  for (size_t i = 0; i < inputs.size(); ++i) {
    if (i % 100 == 50) poison(many);
    step(m, inputs[i], threaded, many);
  }
  EXPECT_EQ(first_difference(s, threaded), "");
  for (size_t i = 4700; i < inputs.size(); ++i) step(m, inputs[i], saved, many);
  EXPECT_EQ(first_difference(s, saved), "");
}
