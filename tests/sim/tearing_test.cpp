// Tissue that tears, and tissue that hardly changes its volume, under the laws of the step.
#include <algorithm>

#include <gtest/gtest.h>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

const Model& weak() {
  static const Model made = [] {
    scene::Description d = small::description();
    for (scene::Tissue& t : d.tissues) {
      if (t.name == "flesh") t.poisson = 0.4;
      if (t.name == "duct") t.failure_strain = 0.5;
      if (t.name == "web") t.failure_strain = 0.6;
    }
    return scene::compile(d);
  }();
  return made;
}

bool counts(const State& s) {
  const auto any = [](const auto& bodies) {
    return std::any_of(bodies.begin(), bodies.end(), [](const std::vector<std::uint8_t>& counters) {
      return std::any_of(counters.begin(), counters.end(), [](std::uint8_t n) { return n > 0; });
    });
  };
  return any(s.overstretched_organs) || any(s.overstretched_membranes) || any(s.overstretched_strands);
}

/// The grasper takes the tube and lifts it until something tears, and on.
struct Pull {
  std::vector<Event> torn;
  std::vector<std::uint64_t> hashes;  ///< every 50 ticks
  State end;
  int saved = 0;  ///< how often it went on from a copy, with scratch of its own, while a counter ran
};
Pull pulled(bool hard, int threads) {
  core::ThreadPool pool(threads);
  Pull p;
  State s = initial_state(weak());
  Work w = make_work(weak(), &pool);
  Input input = weak().start;
  const Vec3d port = weak().hands[small::kGrasper].port, at{0.055, 0, -0.010};
  for (int tick = 0; tick < 3000; ++tick) {
    const double down = std::min(1.0, tick / 400.0), up = std::max(0, tick - 1000) * 4e-5;
    const Vec3d from{0.055, 0, 0.04};
    const kinematics::FulcrumPose pose = kinematics::inverse(port, from + down * (at - from) + Vec3d{0, 0, up},
                                                             double(input.tools[small::kGrasper].roll));
    input.tools[small::kGrasper] = tool_input(pose, float(std::clamp((tick - 450) / 400.0, 0.0, 0.98)));
    const StepReport report = step(weak(), input, s, w);
    EXPECT_TRUE(report.fine()) << tick;
    for (int e = 0; e < report.event_count; ++e)
      if (report.events[e].kind == Event::torn) p.torn.push_back(report.events[e]);
    if (tick % 50 == 0) p.hashes.push_back(hash_of(s));
    if (!hard) continue;
    poison(w);
    if (!counts(s) || tick % 7 != 0) continue;
    const State copy = s;
    s = copy;
    w = make_work(weak(), &pool);
    ++p.saved;
  }
  p.end = s;
  return p;
}
const Pull& plain() {
  static const Pull made = pulled(false, 1);
  return made;
}

bool has_torn(const Pull& p, BodyKind kind) {
  return std::any_of(p.torn.begin(), p.torn.end(), [&](const Event& e) { return e.body.is(kind); });
}

TEST(Tearing, ATubeThatIsLiftedTooFarTearsAndItsFoldTears) {
  const Pull& p = plain();
  EXPECT_TRUE(has_torn(p, BodyKind::strand)) << "the tube";
  EXPECT_TRUE(has_torn(p, BodyKind::membrane)) << "its fold";
  for (const Event& e : p.torn) EXPECT_EQ(e.hand, small::kGrasper) << "the hand that did it";
  const std::vector<std::uint8_t>& alive = p.end.strands[small::kTube].alive;
  EXPECT_GT(std::count(alive.begin(), alive.end(), 0), 0);
  const std::vector<std::uint8_t>& torn = p.end.torn[0];
  EXPECT_GT(std::count(torn.begin(), torn.end(), 1), 0);
}

TEST(Tearing, PoisonedScratchAndCopiesWhileItIsAboutToTearChangeNoBit) {
  const Pull hard = pulled(true, 1);
  EXPECT_GT(hard.saved, 3);
  EXPECT_EQ(hard.hashes, plain().hashes);
}

TEST(Tearing, TwoThreadsGiveTheSameBits) { EXPECT_EQ(pulled(false, 2).hashes, plain().hashes); }

TEST(Tearing, NoGripHoldsWhatHasParted) {
  for (const interactions::ToolState& tool : plain().end.tools)
    for (int h = 0; h < tool.holds; ++h) {
      if (!tool.hold[h].at.body.is(BodyKind::strand)) continue;
      EXPECT_TRUE(plain().end.strands[tool.hold[h].at.body.index()].alive[size_t(tool.hold[h].at.element)]);
    }
}

TEST(Tearing, TheFleshOfThisSceneHasAVolumeForce) {
  EXPECT_GT(weak().solids[0].network.bulk.impulses, 0);
  EXPECT_NE(weak().hash, small::model().hash);
}

}  // namespace
