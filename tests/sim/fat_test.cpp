// Fat about ducts in its scene: it hangs as drawn, is torn out by jaws, boils away at a hook, hides what lies in it,
// and obeys the laws of the step.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/bodies/fat.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/visibility.hpp>

using namespace trocar;
using namespace trocar::sim;
using interactions::BondState;

namespace {

constexpr int kGrasper = 0, kHook = 1;

const Model& model() {
  static const Model made = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/calot/scene.json"));
  return made;
}
const interactions::FatBody& body() { return model().fat.front(); }
tissue::FatState& fat_of(State& s) { return s.fat.front(); }
const tissue::FatState& fat_of(const State& s) { return s.fat.front(); }
const std::vector<interactions::Bond>& roots() { return model().bonds[size_t(body().roots)].bonds; }
const std::vector<BondState>& root_states(const State& s) { return s.bonds[size_t(body().roots)]; }

/// The lobule whose place as drawn is nearest.
int lobule_near(Vec3d p) {
  int best = 0;
  const std::vector<Vec3d>& rest = body().fat.network.rest;
  for (int n = 1; n < body().fat.lobules(); ++n)
    if (length(rest[size_t(n)] - p) < length(rest[size_t(best)] - p)) best = n;
  return best;
}
/// In front of the cystic duct, where nothing else is near.
Vec3d in_front() { return body().fat.network.rest[size_t(lobule_near({-0.046, 0.106, -0.094}))]; }

double whole_septa(const State& s) {
  double sum = 0;
  for (int i = 0; i < body().fat.septa(); ++i) sum += holding(body().fat, fat_of(s), i);
  return sum / body().fat.septa();
}

Input tool_at(int hand, Vec3d tip, double handle) {
  Input input = model().start;
  input.tools[hand] = tool_input(
      kinematics::inverse(model().hands[size_t(hand)].port, tip, double(input.tools[hand].roll)), float(handle));
  return input;
}
Vec3d before(int hand, Vec3d place, double by) {
  return place - by * normalised(place - model().hands[size_t(hand)].port);
}

/// Jaws close on the fat and draw it away.
Input tearing(int tick) {
  const Vec3d place = in_front(), from = before(kGrasper, place, 0.03), to = before(kGrasper, place, -0.004);
  Vec3d tip = from + std::min(1.0, tick / 400.0) * (to - from);
  tip += std::clamp(tick - 800, 0, 1500) * Vec3d{0, -1e-5, 1e-5};
  return tool_at(kGrasper, tip, std::clamp((tick - 450) / 250.0, 0.0, 0.98));
}

struct Story {
  std::vector<std::uint64_t> hashes;
  std::vector<double> septa;
  double pulled = 0;  ///< most [N]
  State end;
};
Story told(bool hard = false, int threads = 1) {
  const Model& m = model();
  core::ThreadPool pool(threads);
  Story story;
  State s = initial_state(m);
  Work w = make_work(m, &pool);
  for (int tick = 0; tick < 2300; ++tick) {
    EXPECT_TRUE(step(m, tearing(tick), s, w).fine()) << tick;
    if (tick % 50 == 0) story.hashes.push_back(hash_of(s)), story.septa.push_back(whole_septa(s));
    const double* pull = s.tools[kGrasper].pull;
    story.pulled = std::max(story.pulled, length(Vec3d{pull[0], pull[1], pull[2]}));
    if (!hard) continue;
    if (tick % 10 == 0) poison(w);
    if (tick % 97 == 0) {
      const State copy = s;
      s = copy;
      w = make_work(m, &pool);
    }
  }
  story.end = s;
  return story;
}
const Story& torn() {
  static const Story made = told();
  return made;
}

}  // namespace

TEST(FatInItsScene, HangsAsDrawnAndNothingGivesWay) {
  const Model& m = model();
  EXPECT_GT(body().fat.lobules(), 200);
  EXPECT_GT(roots().size(), 55u);
  State s = initial_state(m);
  Work w = make_work(m);
  double worst = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    ASSERT_TRUE(step(m, m.start, s, w).fine()) << tick;
    for (int n = 0; n < body().fat.lobules(); ++n)
      worst = std::max(worst, length(position(body().fat, fat_of(s), n) - body().fat.network.rest[size_t(n)]));
  }
  RecordProperty("moved_mm", std::to_string(1e3 * worst));
  EXPECT_LT(worst, 0.001);
  EXPECT_EQ(whole_septa(s), 1);
  for (const BondState& root : root_states(s)) EXPECT_TRUE(root.damage == 0);
}

TEST(FatInItsScene, JawsTearItOutAndItNeverGrowsTogether) {
  const Story& story = torn();
  EXPECT_GT(story.end.tools[kGrasper].holds, 0) << "the jaws hold what they tore out";
  EXPECT_EQ(story.end.tools[kGrasper].hold[0].at.body.kind(), BodyKind::fat);
  EXPECT_LT(story.septa.back(), story.septa[8]);
  EXPECT_TRUE(std::is_sorted(story.septa.rbegin(), story.septa.rend()));
  RecordProperty("pulled_N", std::to_string(story.pulled));
  EXPECT_GT(story.pulled, 0.02);
  EXPECT_LT(story.pulled, 1.5) << "blunt dissection takes 0.32 +- 0.36 N";
}

TEST(FatInItsScene, SpoiltScratchSavedStatesAndThreadsChangeNoBit) {
  EXPECT_EQ(told(true, 1).hashes, torn().hashes);
  EXPECT_EQ(told(false, 2).hashes, torn().hashes);
}

TEST(FatInItsScene, KeyframesShowWhereItIsAndWhatHolds) {
  State shown = initial_state(model());
  const std::vector<std::uint8_t> bytes = display_bytes(model(), torn().end);
  ASSERT_TRUE(restore_display(model(), bytes, shown));
  for (int n = 0; n < body().fat.lobules(); ++n) {
    const Vec3d off = position(body().fat, fat_of(shown), n) - position(body().fat, fat_of(torn().end), n);
    EXPECT_LT(length(off), 2e-5);
  }
  EXPECT_NEAR(whole_septa(shown), whole_septa(torn().end), 0.01);
}

TEST(FatInItsScene, AHookBoilsItAwayAndItsWaterIsBooked) {
  const Model& m = model();
  State s = initial_state(m);
  Work w = make_work(m);
  double steam = 0;
  const Vec3d from = before(kHook, in_front(), 0.02), to = in_front();
  for (int tick = 0; tick < 4000; ++tick) {
    Input input = tool_at(kHook, from + std::min(1.0, tick / 600.0) * (to - from), 0);
    if (tick > 700) input.pedals |= kBlue;
    ASSERT_TRUE(step(m, input, s, w).fine()) << tick;
    steam += w.steam.kilograms;
  }
  const tissue::FatState& fat = fat_of(s);
  EXPECT_GT(fat.gone, 0);
  double boiled = 0;
  for (const tissue::Lobule& l : fat.lobules) boiled += l.boiled;
  EXPECT_NEAR(steam, boiled, 1e-9 * boiled);
  EXPECT_GE(boiled, fat.gone * body().fat.material.water * body().fat.mass * (1 - 1e-9));
  for (size_t i = 0; i < roots().size(); ++i)
    if (fat.lobules[size_t(roots()[i].node())].gone()) {
      EXPECT_FALSE(root_states(s)[i].holds());
    }
}

TEST(FatInItsScene, BladesPartIt) {
  const Model& m = model();
  State s = initial_state(m);
  Work w = make_work(m);
  StepReport report = step(m, m.start, s, w);
  StepContext context{m, m.start, s, w, report};
  EXPECT_GT(sever_septa(context, geometry::square_blade(in_front(), {1, 0, 0}, 0.006)), 3);
  EXPECT_EQ(sever_septa(context, geometry::square_blade({0, 0, 0.05}, {1, 0, 0}, 0.006)), 0);
  EXPECT_LT(whole_septa(s), 1);
  for (int tick = 0; tick < 200; ++tick) ASSERT_TRUE(step(m, m.start, s, w).fine());
}

TEST(FatInItsScene, HidesWhatLiesInIt) {
  const Model& m = model();
  State s = initial_state(m);
  const size_t duct = size_t(m.strand_index("cystic_duct"));
  const Vec3d eye{-0.012, 0.012, -0.029}, middle = s.strands[duct].x[s.strands[duct].x.size() / 2];
  EXPECT_TRUE(behind_fat(m, s, eye, middle));
  for (tissue::Lobule& l : fat_of(s).lobules) l.marks |= tissue::Lobule::kBoiledAway;
  EXPECT_FALSE(behind_fat(m, s, eye, middle));
}
