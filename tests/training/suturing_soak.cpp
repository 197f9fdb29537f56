// A stitch and its knot as they are shown: the stitch on seeds on which the needle once was thrown off the pad, or the
// thread parted at its swage.
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/skills/registry.hpp>

#include "basics.hpp"

namespace trocar::training::basics {
namespace {

constexpr const char* kStitch = "../suturing/needle-through";
constexpr const char* kKnot = "../suturing/intracorporeal-suture";
constexpr int kLeft = 0, kRight = 1;
constexpr std::uint64_t kTied = 2;  // a seed on which it is tied

TEST(NeedleThrough, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 2, 3, 6, 7}) expect_passes(kStitch, seed, {});
}

TEST(NeedleThrough, TheDemonstrationPassesWithATremor) {
  for (const std::uint64_t seed : {0, 3}) expect_passes(kStitch, seed);
}

TEST(IntracorporealSuture, TheDemonstrationTiesADoubleThrowAndTwoOpposedSingles) { expect_passes(kKnot, kTied, {}); }

double pull_of(const sim::State& state, int hand) {
  const double* f = state.tools[std::size_t(hand)].pull;
  return length(Vec3d{f[0], f[1], f[2]});
}

TEST(IntracorporealSuture, ItsKnotHoldsFiveNewtonsForThreeSeconds) {
  Lesson lesson(kKnot, kTied);
  const Performed tied(lesson, "", {}, {});
  ASSERT_EQ(knot_of(lesson.model, tied.state).count, 3);
  PlanGoal pull;
  pull.name = "pull";
  pull.tries = 1;
  pull.todo = {PlanTask::of(kPullThrow)
                   .set_index("hand", kLeft)
                   .set_index("with", kRight)
                   .set("x_mm", -0.003)
                   .set("y_mm", -0.010)
                   .set("z_mm", 0)
                   .set("pull_N", 5)
                   .set("for_s", 3)};
  Demonstration plan;
  plan.plan.parts.emplace_back();
  plan.plan.parts[0].goals = {pull};
  Performer performer(lesson.model, std::move(plan), {});
  sim::State state = tied.state;
  sim::Work work = sim::make_work(lesson.model);
  double first_tail = -1, first_standing = 0, least = 1e9, slip = 0, held = 0;
  while (!performer.done()) {
    const sim::StepReport report = step(lesson.model, performer.next(lesson.model, state), state, work);
    performer.after(lesson.model, state, report);
    const double weaker = std::min(pull_of(state, kLeft), pull_of(state, kRight));
    if (first_tail < 0 && weaker < 4.8) continue;
    held += weaker > 4 ? sim::kTick : 0, least = std::min(least, weaker);
    if (state.tick % 100 != 0) continue;
    const suture::KnotReading knot = knot_of(lesson.model, state);
    ASSERT_EQ(knot.count, 3);
    if (first_tail < 0) first_tail = knot.tail, first_standing = knot.standing;
    slip = std::max({slip, std::fabs(knot.tail - first_tail), std::fabs(knot.standing - first_standing)});
  }
  EXPECT_FALSE(performer.gave_up());
  EXPECT_GT(held, 2.5);
  EXPECT_LT(slip, 0.001);
  std::printf("at least %.1f N for %.1f s, %.2f mm of slip\n", least, held, 1e3 * slip);
}

}  // namespace
}  // namespace trocar::training::basics
