// The basic skill with clips.
#include "basics.hpp"

namespace trocar::training::basics {
namespace {

/// The first clip as it should not be, then the others.
std::function<void(Lesson&)> first_clip(std::function<void(PlanTask&, const sim::Model&)> how) {
  return [how](Lesson& lesson) {
    PlanGoal& wrong = flaws::first_wrongly(lesson.demonstration.plan, "clip 1");
    how(wrong.todo.front(), lesson.model);
  };
}

std::vector<Flaw> of_clips() {
  const char* exercise = "clip-application";
  return {
      {exercise,
       "K1",
       first_clip([](PlanTask& t, const sim::Model&) { t.set("at_mm", t.argument("at_mm").number() + 0.003); }),
       {}},
      {exercise,
       "K2",
       first_clip([](PlanTask& t, const sim::Model& m) {  // only the legs' ends
         const int strand = t.argument("of").index;
         const double radius = m.strand_bodies[size_t(strand)].model.radius[0];
         const interactions::ToolModel& tool = m.hands[size_t(t.argument("hand").index)].rack[0];
         t.set("inside_mm", tool.jaw_length - 0.3 * radius).set("cover", 0).set("seen", "whatever");
       }),
       {}},
      {exercise,
       "K3",
       {},  // turned while the jaws close
       [](sim::Input& in, const sim::State&, const Monitor& monitor) {
         if (monitor.errors().empty() && in.tools[1].handle > 0.7f) in.tools[1].roll += float(25 * kDegree);
       }},
      {exercise,
       "K4",
       [](Lesson& lesson) {  // once more, where there is one
         PlanPart& part = lesson.demonstration.plan.parts.front();
         PlanGoal again = part.goals.front();
         again.until = {};
         part.goals.push_back(std::move(again));
       },
       {}},
      {exercise,
       "E12",
       [](Lesson& lesson) {  // the applier closes on nothing
         PlanGoal& goal = lesson.demonstration.plan.goal("clip 1");
         PlanTask close = PlanTask::of(kClose), open = PlanTask::of(kLetGo);
         const std::int32_t hand = goal.todo.front().argument("hand").index;
         close.set_index("hand", hand).set("in_s", 3);
         open.set_index("hand", hand);
         flaws::insert(goal, 0, std::move(open));
         flaws::insert(goal, 0, std::move(close));
       },
       {}},
  };
}

/// Without a tremor, as the program shows it, and with several.
TEST(ClipApplication, TheDemonstrationPassesHoweverTheHandsShake) {
  expect_passes("clip-application", 0, {});
  for (const std::uint64_t hands : {1, 2, 3}) expect_passes("clip-application", 0, {0.0002, hands});
}

class ClipFlaw : public testing::TestWithParam<Flaw> {};
TEST_P(ClipFlaw, TriggersItsErrorAndOnlyWhatTheTableSaysItImplies) { expect_only(GetParam()); }
INSTANTIATE_TEST_SUITE_P(Codes, ClipFlaw, testing::ValuesIn(of_clips()), word);

TEST(ClipFlaws, ThereIsOneForEveryCode) { expect_complete("clip-application", of_clips()); }

}  // namespace
}  // namespace trocar::training::basics
