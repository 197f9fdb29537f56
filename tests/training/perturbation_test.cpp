// Ways of doing a task: the same number is the same way, and only what a hand may do otherwise differs.
#include <gtest/gtest.h>

#include <trocar/training/expert/perturbation.hpp>

namespace trocar::training {
namespace {

PlanTask drawn() {
  PlanTask task = PlanTask::of(*find_skill("draw"));
  task.set("by_mm", 0.010).set("pull_N", 2.0).set("speed_mm_s", 0.02);
  return task;
}

TEST(Ways, AsWrittenIsAsWritten) { EXPECT_EQ(in_way(drawn(), 0).arguments, drawn().arguments); }

TEST(Ways, TheSameNumberIsTheSameWayAndAnotherIsNot) {
  EXPECT_EQ(in_way(drawn(), 7).arguments, in_way(drawn(), 7).arguments);
  EXPECT_NE(in_way(drawn(), 7).arguments, in_way(drawn(), 8).arguments);
}

TEST(Ways, HowFarAndHowHardVaryWithinTheirPlayAndNothingElse) {
  for (int way = 1; way < 200; ++way) {
    PlanTask other = in_way(drawn(), way);
    EXPECT_NEAR(other.argument("by_mm").number(), 0.010, 0.003);
    EXPECT_NEAR(other.argument("pull_N").number(), 2.0, 0.5);
    EXPECT_EQ(other.argument("speed_mm_s").number(), 0.02);
  }
  PlanTask clip = PlanTask::of(*find_skill("clip_at"));
  clip.set("within_mm", 0.006, 0.008).set("closing_s", 2.4).set("angle_deg", 0.26);
  EXPECT_EQ(in_way(clip, 5).arguments, clip.arguments);  // what the exercise judges by
}

TEST(Ways, HandsTrembleOtherwiseInEach) {
  EXPECT_EQ(tremor_in_way(0).rms, 0);
  EXPECT_GT(tremor_in_way(3).rms, 0);
  EXPECT_NE(tremor_in_way(3).seed, tremor_in_way(4).seed);
}

}  // namespace
}  // namespace trocar::training
