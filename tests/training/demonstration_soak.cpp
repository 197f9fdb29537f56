// The demonstration of the whole exercise in the shipped scene: it passes without an error, its clips and cut are
// what the exercise asks for, and the laws of the step hold over all of it.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/core/random.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/expert.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

constexpr std::uint64_t kMark = 100;

struct Shown {
  Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  std::vector<sim::Input> inputs;
  std::vector<std::uint64_t> hash;
  std::uint32_t flags = 0;
  sim::State end;
  Monitor monitor{exercise, model};
  bool gave_up = false;

  Shown() {
    const std::unique_ptr<Expert> surgeon = make_expert(exercise, model);
    sim::State s = sim::initial_state(model);
    sim::Work w = sim::make_work(model);
    while (!surgeon->done() && inputs.size() < 400000) {
      inputs.push_back(surgeon->next(model, s));
      const sim::StepReport report = step(model, inputs.back(), s, w);
      flags |= report.flags;
      surgeon->after(model, s, report);
      monitor.update(model, s, report);
      if (s.tick % kMark == 0) hash.push_back(hash_of(s));
    }
    gave_up = surgeon->gave_up();
    end = s;
  }
};

const Shown& demonstration() {
  static const Shown made;
  return made;
}

template <class Before>
std::uint64_t first_difference(sim::State& s, sim::Work& w, Before&& before) {
  const Shown& d = demonstration();
  while (s.tick < d.inputs.size()) {
    before(s, w);
    step(d.model, d.inputs[s.tick], s, w);
    if (s.tick % kMark == 0 && hash_of(s) != d.hash[s.tick / kMark - 1]) return s.tick;
  }
  return 0;
}

TEST(Demonstration, PassesWithoutAnError) {
  const Shown& d = demonstration();
  EXPECT_FALSE(d.gave_up);
  EXPECT_TRUE(d.monitor.finished());
  for (const ErrorMade& e : d.monitor.errors()) ADD_FAILURE() << e.code << " at " << e.at << " s: " << e.meaning;
  EXPECT_TRUE(d.monitor.score().passed);
  EXPECT_GT(d.monitor.score().total, 95);
  const nlohmann::json result = nlohmann::json::parse(d.monitor.result_json());
  for (const auto& side : result["details"]) EXPECT_TRUE(side["side"] == "" || side["occluded"] == true) << side;
  EXPECT_EQ(d.flags & ~std::uint32_t(tissue::StepReport::kInverted), 0u);
}

TEST(Demonstration, ItsClipsAndCutAreAsTheExerciseAsks) {
  const Shown& d = demonstration();
  ASSERT_EQ(d.end.clip_count, 4);
  ASSERT_EQ(d.end.cut_count, 2);
  const nlohmann::json result = nlohmann::json::parse(d.monitor.result_json());
  for (const auto& side : result["details"]) {
    if (side["side"] == "") continue;
    ASSERT_EQ(side["clipped"].size(), 2u);
    ASSERT_EQ(side["cut"].size(), 1u);
    for (const auto& clip : side["clipped"]) {
      EXPECT_GE(double(clip["cover"]), 0.98);
      EXPECT_LE(double(clip["angle_deg"]), 15);
      EXPECT_EQ(double(clip["tips_visible"]), 2);
      EXPECT_GE(double(clip["closing_s"]), 1);
    }
    EXPECT_GE(double(side["clip_distance_mm"]), 6);
    EXPECT_LE(double(side["clip_distance_mm"]), 12);
    EXPECT_GE(double(side["cut"][0]["fraction"]), 0.99);
    EXPECT_GT(double(side["straightness"]), 0.95);
  }
}

TEST(Demonstration, PoisonedWorkChangesNoBitOfIt) {
  sim::State s = sim::initial_state(demonstration().model);
  sim::Work w = sim::make_work(demonstration().model);
  EXPECT_EQ(first_difference(s, w, [](sim::State&, sim::Work& work) { poison(work); }), 0u);
}

TEST(Demonstration, SavedAndRestoredEverySecondItIsTheSame) {
  sim::State s = sim::initial_state(demonstration().model);
  sim::Work w = sim::make_work(demonstration().model);
  EXPECT_EQ(first_difference(s, w,
                             [](sim::State& state, sim::Work& work) {
                               if (state.tick % 1000 != 500) return;
                               const sim::State saved = state;
                               state = sim::initial_state(demonstration().model);
                               work = sim::make_work(demonstration().model);
                               state = saved;
                             }),
            0u);
}

TEST(Demonstration, AnyPoolAndWidthGiveTheSame) {
  const std::string usual = tissue::simd_name();
  for (int threads : {2, 3}) {
    core::ThreadPool pool(threads);
    tissue::set_simd(threads == 2 ? "generic" : "sse2");
    sim::State s = sim::initial_state(demonstration().model);
    sim::Work w = sim::make_work(demonstration().model, &pool);
    EXPECT_EQ(first_difference(s, w, [](sim::State&, sim::Work&) {}), 0u) << threads << " threads";
  }
  tissue::set_simd(usual);
}

/// How far outside the cavity a place is [m].
double outside(const tissue::Box& cavity, Vec3d p) {
  const Vec3d low = vec_cast<double>(cavity.low), high = vec_cast<double>(cavity.high);
  double most = 0;
  for (int k = 0; k < 3; ++k) most = std::max({most, low[k] - p[k], p[k] - high[k]});
  return most;
}

class WildHands : public testing::TestWithParam<int> {};

TEST_P(WildHands, LeaveTheShippedSceneFiniteAndInsideThePatient) {
  const sim::Model& m = demonstration().model;
  sim::State s = sim::initial_state(m);
  sim::Work w = sim::make_work(m);
  core::Random random{std::uint64_t(GetParam())};
  sim::Input in = m.start;
  for (int t = 0; t < 30000; ++t) {
    if (random.uniform() < 0.1)
      for (size_t i = 0; i < m.hands.size(); ++i) {
        const Vec3d tip{random.uniform(-0.07, 0.07), random.uniform(-0.20, -0.10), random.uniform(-0.18, -0.05)};
        in.tools[i] = sim::tool_input(kinematics::inverse(m.hands[i].port, tip, random.uniform(-3, 3)),
                                      random.uniform() < 0.5 ? 0.0f : 1.0f);
      }
    const sim::StepReport report = step(m, in, s, w);
    ASSERT_TRUE(report.fine()) << "tick " << t << " body " << report.first_bad_body.code();
    if (t % 100 != 0) continue;
    constexpr double kOut = 0.05;
    for (size_t i = 0; i < m.strand_bodies.size(); ++i)
      for (Vec3d p : s.strands[i].x) ASSERT_LT(outside(m.cavity, p), kOut) << m.strands[i].name << " tick " << t;
    for (size_t i = 0; i < m.solids.size(); ++i)
      for (int n = 0; n < m.solids[i].network.nodes; ++n)
        ASSERT_LT(outside(m.cavity, tissue::position(m.solids[i].network, s.solids[i], n)), kOut)
            << m.solids[i].name << " tick " << t;
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, WildHands, testing::Range(1, 5));

}  // namespace
