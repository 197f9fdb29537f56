// Perturbations of a task: the same number gives the same task, and only what a hand may do otherwise differs.
#include <gtest/gtest.h>

#include <trocar/training/expert/perturbation.hpp>

namespace trocar::training {
namespace {

PlanTask drawn() {
  PlanTask task = PlanTask::of(*find_skill("draw"));
  task.set("by_mm", 0.010).set("pull_N", 2.0).set("speed_mm_s", 0.02);
  return task;
}

TEST(Perturbation, ZeroLeavesTheTaskAsWritten) { EXPECT_EQ(perturbed(drawn(), 0).arguments, drawn().arguments); }

TEST(Perturbation, TheSameNumberGivesTheSameTaskAndAnotherDoesNot) {
  EXPECT_EQ(perturbed(drawn(), 7).arguments, perturbed(drawn(), 7).arguments);
  EXPECT_NE(perturbed(drawn(), 7).arguments, perturbed(drawn(), 8).arguments);
}

TEST(Perturbation, HowFarAndHowHardVaryWithinTheirPlayAndNothingElse) {
  for (int perturbation = 1; perturbation < 200; ++perturbation) {
    PlanTask other = perturbed(drawn(), perturbation);
    EXPECT_NEAR(other.argument("by_mm").number(), 0.010, 0.003);
    EXPECT_NEAR(other.argument("pull_N").number(), 2.0, 0.5);
    EXPECT_EQ(other.argument("speed_mm_s").number(), 0.02);
  }
  PlanTask clip = PlanTask::of(*find_skill("clip_at"));
  clip.set("within_mm", 0.006, 0.008).set("closing_s", 2.4).set("angle_deg", 0.26);
  EXPECT_EQ(perturbed(clip, 5).arguments, clip.arguments);  // what the exercise judges by
}

TEST(Perturbation, HandsTrembleOtherwiseInEach) {
  EXPECT_EQ(perturbed_tremor(0).rms, 0);
  EXPECT_GT(perturbed_tremor(3).rms, 0);
  EXPECT_NE(perturbed_tremor(3).seed, perturbed_tremor(4).seed);
}

}  // namespace
}  // namespace trocar::training
