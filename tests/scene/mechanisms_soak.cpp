// Inverse kinematics of the shipped arms at a hundred thousand poses each: none is missed.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::scene {
namespace {

using namespace kinematics;

class ArmSoak : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Arms, ArmSoak, testing::Values("dvrk_arm", "flexible_instrument", "redundant_arm"),
                         [](const auto& p) { return std::string(p.param); });

TEST_P(ArmSoak, InverseThenForwardIsIdentityAtAHundredThousandPoses) {
  const std::string file = std::string(TROCAR_SOURCE_DIR "/scenes/mechanisms/") + GetParam() + ".json";
  const Mechanism m = build(read_mechanism(file));
  const BodyFrame& tip = m.frames[std::size_t(m.frame("tip"))];
  LoopWork poses(m);
  InverseWork work(m, 6);
  core::Random random(41);
  Pose pose(m);
  std::vector<double> u(std::size_t(m.u_count())), v(u.size());
  double worst_place = 0, worst_turn = 0;
  long attempts = 0;
  int most_attempts = 0;
  const int count = 100'000;
  for (int k = 0; k < count;) {
    for (std::size_t i = 0; i < u.size(); ++i) {
      const auto q = std::size_t(m.independent[i]);
      u[i] = random.uniform(m.low[q], m.high[q]);
    }
    const LoopReport there = close(m, u, poses);
    if (!there.closed() || there.limit >= 0) continue;
    ++k;
    const Frame wanted = place(tip, poses.pose);
    const Closure goal = reach(tip, wanted);
    v = m.start_u();
    const InverseReport report = inverse(m, {&goal, 1}, v, work);
    ASSERT_TRUE(report.reached()) << k << ": " << words(m, report);
    attempts += report.attempts;
    most_attempts = std::max(most_attempts, report.attempts);
    forward(m, v, pose);
    const Frame now = place(tip, pose);
    worst_place = std::max(worst_place, length(now.p - wanted.p));
    worst_turn = std::max(worst_turn, length(turn_between(now.r, wanted.r)));
    ASSERT_LT(beyond_limits(m, pose.q), 0);
  }
  EXPECT_LT(worst_place, 1e-9);
  EXPECT_LT(worst_turn, 1e-9);
  RecordProperty("attempts_per_pose", std::to_string(double(attempts) / count));
  RecordProperty("most_attempts", most_attempts);
  RecordProperty("worst_place_m", std::to_string(worst_place * 1e12) + " pm");
}

}  // namespace
}  // namespace trocar::scene
