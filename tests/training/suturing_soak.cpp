// A stitch and its knot as they are shown: the stitch on seeds on which the needle once was thrown off the pad, or the
// thread parted at its swage; the knot on five, and then pulled.
#include <trocar/suture/thread/chain.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/skills/registry.hpp>

#include "basics.hpp"

namespace trocar::training::basics {
namespace {

constexpr const char* kStitch = "../suturing/needle-through";
constexpr const char* kThrow = "../suturing/double-throw";
constexpr const char* kKnot = "../suturing/intracorporeal-suture";
constexpr int kLeft = 0, kRight = 1;

TEST(NeedleThrough, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 2, 3, 6, 7}) expect_passes(kStitch, seed, {});
}

TEST(NeedleThrough, TheDemonstrationPassesWithATremor) {
  for (const std::uint64_t seed : {0, 3}) expect_passes(kStitch, seed);
}

/// @param steady  hands do not tremble
std::unique_ptr<Performed> tied(Lesson& lesson) { return std::make_unique<Performed>(lesson, "", Slip{}, Tremor{}); }

class DoubleThrow : public testing::TestWithParam<int> {};
TEST_P(DoubleThrow, TheDemonstrationLaysItOnTheSlit) {
  Lesson lesson(kThrow, std::uint64_t(GetParam()));
  const auto run = tied(lesson);
  EXPECT_FALSE(run->gave_up) << run->difficulties;
  EXPECT_TRUE(run->monitor.score().passed) << run->monitor.score().total;
  const suture::KnotReading knot = knot_of(lesson.model, run->state);
  ASSERT_EQ(knot.count, 1);
  EXPECT_EQ(knot.throws[0].turns, 2);
  EXPECT_LT(knot_above_tissue(lesson.model, run->state, knot), 0.005);
}
INSTANTIATE_TEST_SUITE_P(Seeds, DoubleThrow, testing::Values(0, 1));

/// The largest in the thread between those distances from its beginning [N].
double most_tension(const sim::Model& model, const sim::State& state, double from, double to) {
  const suture::ThreadModel& thread = suture_of(model).thread;
  double most = 0;
  for (int e = int(from / thread.spacing); e <= int(to / thread.spacing); ++e)
    most = std::max(most, suture::tension(thread, suture_of(state).thread, e));
  return most;
}

/// How a knot bears what its ends are drawn with.
struct Drawn {
  double held = 0;   ///< how long both ends bore 5 N [s]
  double given = 0;  ///< how much farther apart thread on either side came meanwhile: what slipped in the knot [m]
  double least = 1e9, most = 0;
  std::string difficulties;
};
/// [m] from the needle, and from where the tail is held: between there and the knot. Thread lies round the jaws that
/// hold the needle, and bears less there.
constexpr double kStandingFrom = 0.030, kStandingTo = 0.070, kTail = 0.003;
/// On a state of its own. @param pull  of either hand [N]
Drawn drawn_with(double pull_by_hand, const sim::Model& model, sim::State state) {
  Demonstration pull;
  pull.plan.parts.emplace_back();
  PlanGoal& goal = pull.plan.parts[0].goals.emplace_back();
  goal.name = "pull";
  goal.tries = 1;
  goal.todo = {PlanTask::of(kPullThrow)
                   .set_index("hand", kLeft)
                   .set_index("with", kRight)
                   .set("x_mm", -0.003)
                   .set("y_mm", -0.010)
                   .set("z_mm", 0)
                   .set("pull_N", pull_by_hand)
                   .set("for_s", 3.5)};
  Performer performer(model, std::move(pull), {});
  sim::Work work = sim::make_work(model);
  Drawn drawn;
  double first = -1;
  while (!performer.done()) {
    const sim::StepReport report = step(model, performer.next(model, state), state, work);
    performer.after(model, state, report);
    const double held = suture_of(state).thread.holds[std::size_t(interactions::kFirstHandSlot + kLeft)].s;
    const double tail = most_tension(model, state, held - kTail, held - kTail);
    const double weaker = std::min(most_tension(model, state, kStandingFrom, kStandingTo), tail);
    if (weaker < 5) continue;
    const suture::ThreadModel& m = suture_of(model).thread;
    const suture::ThreadState& s = suture_of(state).thread;
    const double apart = length(suture::point_at(m, s, kStandingTo) - suture::point_at(m, s, held - kTail));
    if (first < 0) first = apart;
    drawn.held += sim::kTick;
    drawn.given = apart - first;
    drawn.least = std::min(drawn.least, weaker), drawn.most = std::max(drawn.most, weaker);
  }
  for (const std::string& d : performer.difficulties()) drawn.difficulties += d + "\n";
  return drawn;
}

/// Where thread lies round the jaws, hands feel more than it bears beyond them: they pull harder then.
Drawn drawn_with_five_newtons(const sim::Model& model, const sim::State& state) {
  const Drawn drawn = drawn_with(5.2, model, state);
  return drawn.held > 0 ? drawn : drawn_with(6.4, model, state);
}

class IntracorporealSuture : public testing::TestWithParam<int> {};
TEST_P(IntracorporealSuture, IsTiedWithADoubleThrowAndTwoOpposedSinglesAndHoldsFiveNewtonsForThreeSeconds) {
  Lesson lesson(kKnot, std::uint64_t(GetParam()));
  const auto run = tied(lesson);
  EXPECT_FALSE(run->gave_up) << run->difficulties;
  EXPECT_TRUE(run->monitor.score().passed) << run->monitor.score().total;
  for (const StepStatus& s : run->monitor.steps()) EXPECT_TRUE(s.done) << s.name;
  lesson.model.start = run->last;  // hands go on from there
  const Drawn drawn = drawn_with_five_newtons(lesson.model, run->state);
  EXPECT_EQ(drawn.difficulties, "");
  EXPECT_GE(drawn.held, 3);
  EXPECT_LT(drawn.given, 0.001);
  std::printf("seed %d: S = %.0f in %.0f s, %.1f to %.1f N for %.1f s, %.2f mm\n%s", GetParam(),
              run->monitor.score().total, double(run->state.tick) * sim::kTick, drawn.least, drawn.most, drawn.held,
              1e3 * drawn.given, run->difficulties.c_str());
}
INSTANTIATE_TEST_SUITE_P(Seeds, IntracorporealSuture, testing::Range(0, 20));

}  // namespace
}  // namespace trocar::training::basics
