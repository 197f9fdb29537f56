// The injection exercise performed: the demonstration on several seeds, and one run a code with that flaw in the plan.
#include "basics.hpp"

namespace trocar::training::basics {
namespace {

constexpr const char* kInjection = "../gynaecology/injection";

PlanTask& first(Lesson& lesson, std::string_view skill) {
  return lesson.demonstration.plan.task("inject on the left", skill);
}

/// To the nearest place of a vessel, by a hand that does not look where it goes, and the plunger pressed there.
Progress into_a_vessel(Surgeon& op, int hand, double now) {
  const sim::NeedleHand& needle = op.state().injection.hands[size_t(hand)];
  Arms::Arm& arm = op.arm(hand);
  const int vessel = op.model().vessel_index("uterine_upper_left");
  Vec3d way = op.vessel_spot(vessel, 0.5).place - needle.at;
  for (const double at : {0.6, 0.7, 0.8, 0.85, 0.9, 0.95}) {
    const Vec3d other = op.vessel_spot(vessel, at).place - needle.at;
    if (dot(other, other) < dot(way, way)) way = other;
  }
  const double far = length(way);
  if (needle.vessel < 0) arm.tip += (std::min(far, 0.01 * sim::kTick) / std::max(far, 1e-9)) * way;
  arm.moving = true;
  arm.irrigating = needle.vessel >= 0;
  return op.state().injection.account.vessel > fluids::kMillilitre / 10 || now > 40 ? Progress::done
                                                                                    : Progress::working;
}

std::vector<Flaw> of_injection() {
  return {
      {kInjection,
       "I1",
       [](Lesson& lesson) {
         const int hand = first(lesson, "pierce").argument("hand").index;
         first(lesson, "pierce").set("x_mm", 0.0148).set("y_mm", -0.1576).set("z_mm", -0.0957);
         flaws::replace(first(lesson, "aspirate"),
                        [hand](Surgeon& op, double now) { return into_a_vessel(op, hand, now); });
       },
       {}},
      {kInjection, "I2", [](Lesson& lesson) { first(lesson, "aspirate").set("for_s", 0.3); }, {}},
      {kInjection, "I3", [](Lesson& lesson) { first(lesson, "pierce").set("depth_mm", 0.008); }, {}},
      {kInjection,
       "E11",
       [](Lesson& lesson) {
         PlanTask& pierce = first(lesson, "pierce");
         pierce.set_index("of", BodyId::organ(size_t(lesson.model.organ_index("bladder"))).code());
         pierce.set("x_mm", 0).set("y_mm", -0.185).set("z_mm", -0.1);
       },
       {}},
      {kInjection,
       "I4",
       [](Lesson& lesson) {
         const int hand = first(lesson, "pierce").argument("hand").index;
         flaws::insert(lesson.demonstration.plan.goal("inject on the left"), 0, [hand](Surgeon& op, double now) {
           op.arm(hand).irrigating = now < 5;
           return now < 5 ? Progress::working : Progress::done;
         });
       },
       {}},
      {kInjection,
       "I5",
       [](Lesson& lesson) {
         first(lesson, "inject").set("volume_mL", 4.8e-6);
         lesson.demonstration.plan.task("inject on the right", "inject").set("volume_mL", 4.8e-6);
       },
       {}},
  };
}

TEST(InjectionExercise, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 1, 2}) expect_passes(kInjection, seed);
}

// Into the gallbladder's bed: the demonstration alone, its errors have no runs of their own yet.
TEST(HydrodissectionExercise, TheDemonstrationPassesOnSeveralSeeds) {
  for (const std::uint64_t seed : {0, 1}) expect_passes("../cholecystectomy/hydrodissection", seed);
}

/// All of the syringe at the first place. @param holds [m^3]  @param flow [m^3/s]
void flood(double holds, double flow) {
  Lesson lesson(kInjection);
  for (sim::HandModel& hand : lesson.model.hands)
    for (interactions::ToolModel& tool : hand.rack)
      if (tool.can().inject) tool.needle.holds = holds, tool.needle.flow = flow;
  first(lesson, "inject").set("volume_mL", 0.96 * holds);
  const int organ = lesson.model.organ_index("uterus"), hand = first(lesson, "inject").argument("hand").index;
  Performer performer(lesson.model, std::move(lesson.demonstration), {Tremor{0.0002, 1}});
  sim::State state = sim::initial_state(lesson.model);
  sim::Work work = sim::make_work(lesson.model);
  int tears = 0;
  double highest = 0;
  while (!performer.done() && state.tick < 120'000) {
    const sim::StepReport report = step(lesson.model, performer.next(lesson.model, state), state, work);
    performer.after(lesson.model, state, report);
    for (int i = 0; i < report.event_count; ++i) tears += report.events[i].kind == sim::Event::torn;
    highest = std::max(highest, state.injection.hands[size_t(hand)].tip_pressure);
    ASSERT_TRUE(report.fine()) << double(state.tick) * sim::kTick << " s";
    ASSERT_TRUE(balanced(state.injection)) << double(state.tick) * sim::kTick << " s";
  }
  const sim::InjectionAccount& account = state.injection.account;
  std::printf("%.0f mL at %.0f mL/min: %.1f injected, %.1f in the uterus, %.1f leaked, %d tears, %.0f kPa, %.0f s\n",
              1e6 * holds, 6e7 * flow, 1e-9 * double(account.injected),
              1e-9 * double(state.injection.organs[size_t(organ)].total), 1e-9 * double(account.leaked), tears,
              highest / 1e3, double(state.tick) * sim::kTick);
  EXPECT_GT(account.injected, 20 * fluids::kMillilitre);
}

TEST(InjectionExercise, AnyVolumeAtAnySpeedStaysFiniteAndWhatFindsNoRoomComesBack) {
  flood(50e-6, 1e-6);
  flood(50e-6, 2e-6);
  flood(100e-6, 10e-6);
}

class InjectionFlaw : public testing::TestWithParam<Flaw> {};
TEST_P(InjectionFlaw, TriggersItsErrorAndOnlyWhatTheTableSaysItImplies) {
  const Flaw& flaw = GetParam();
  Lesson lesson(flaw.exercise);
  const Penalty* p = lesson.exercise.penalty(flaw.code);
  ASSERT_NE(p, nullptr);
  flaw.plan(lesson);
  const Performed run(lesson, flaw.code);
  EXPECT_GE(run.made(flaw.code), 1) << run.difficulties;
  for (const ErrorMade& e : run.monitor.errors()) {
    std::printf("%s: %s at %.1f s\n", flaw.code, e.code.c_str(), e.at);
    const bool may = std::find(p->may.begin(), p->may.end(), e.code) != p->may.end();
    EXPECT_TRUE(e.code == flaw.code || may) << e.code << " at " << e.at << " s";
  }
  EXPECT_EQ(run.monitor.score().failed, p->fail);
}
std::string code_of(const testing::TestParamInfo<Flaw>& info) { return info.param.code; }
INSTANTIATE_TEST_SUITE_P(Codes, InjectionFlaw, testing::ValuesIn(of_injection()), code_of);

TEST(InjectionFlaws, ThereIsOneForEveryCode) { expect_complete(kInjection, of_injection()); }

}  // namespace
}  // namespace trocar::training::basics
