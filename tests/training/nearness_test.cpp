// How near the current step is: rows of its condition with value, target and unit.
#include <gtest/gtest.h>

#include <trocar/training/exercise/step_nearness.hpp>
#include <trocar/training/exercise/step_needs.hpp>
#include <trocar/training/facts/registry.hpp>

#include "two_sides.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

Exercise nearness_exercise(const std::string& step) {
  return read_exercise(kChanged, files_with(R"({"format": 3, "name": "near", "title": "Near", "scene": "scene.json",
    "score": {"quality": 60, "time": 25, "motion": 15, "source": "ours"}, "hold_s": 0.2, "expert_s": 10,
    "longest_s": 100, "pass_mark": 50, "sets": {}, "steps": [{"step": "one", "title": "One", )" +
                                            step + "}], \"errors\": []}"));
}

const std::string& nearness_hand() { return two_sides::model().hands[0].name; }

std::string pull_fact(const std::string& test) {
  return R"({"fact": "hand.pull_N", "hand": ")" + nearness_hand() + "\", " + test + "}";
}

struct NearStep {
  Exercise e;
  two_sides::Attempt a;
  explicit NearStep(const std::string& step) : e(nearness_exercise(step)), a(Mode::assessed, e) {}
  void pull(double newtons) {
    a.hold_tube(two_sides::kLeft, 0.055, newtons);
    a.seconds(0.02);
  }
  std::vector<Nearness> rows() const { return nearness_of(a.monitor.rules(), 0, {a.model, a.state}); }
};

TEST(Nearness, HasValueTargetUnitAndShare) {
  NearStep s(R"("when": )" + pull_fact(R"("min": 4)"));
  s.a.seconds(0.02);
  ASSERT_EQ(s.rows().size(), 1u);
  EXPECT_FALSE(s.rows()[0].known);
  EXPECT_EQ(s.rows()[0].shown_value(), "-");
  s.pull(1);
  const Nearness row = s.rows()[0];
  EXPECT_EQ(row.label, "Pull");
  EXPECT_EQ(row.shown_value(), "1");
  EXPECT_EQ(row.target(), "min 4 N");
  EXPECT_FALSE(row.fulfilled);
  EXPECT_NEAR(row.share, 0.25, 1e-9);
  s.pull(5);
  EXPECT_TRUE(s.rows()[0].fulfilled);
  EXPECT_EQ(s.rows()[0].share, 1);
}

TEST(Nearness, ALeastAndAMostOfOneFactAreOneRow) {
  NearStep s(R"("when": {"all": [)" + pull_fact(R"("min": 2)") + ", " + pull_fact(R"("max": 3)") + "]}");
  s.pull(2.5);
  ASSERT_EQ(s.rows().size(), 1u);
  EXPECT_EQ(s.rows()[0].target(), "2 to 3 N");
  EXPECT_TRUE(s.rows()[0].fulfilled);
}

TEST(Nearness, ANegationTurnsTheTargetRound) {
  NearStep s(R"("when": {"not": {"any": [)" + pull_fact(R"("min": 3)") +
             R"(, {"fact": "mark.in_view", "of": "tube_left.fimbria"}]}})");
  s.pull(1);
  const std::vector<Nearness> rows = s.rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].target(), "max 3 N");
  EXPECT_TRUE(rows[0].fulfilled);
  EXPECT_FALSE(rows[1].wanted);
  EXPECT_FALSE(rows[1].fulfilled) << "it is in view";
  s.a.look("tube_left.fimbria", false);
  EXPECT_TRUE(s.rows()[1].fulfilled);
}

TEST(Nearness, OneOfTwoSidesIsNamedInWords) {
  NearStep s(R"("when": {"all": [{"fact": "mark.seen_for_s", "of": "tube_left.trace", "share": 0.5, "min": 1},
                                 {"fact": "mark.seen_for_s", "of": "tube_right.trace", "share": 0.5, "min": 1}]})");
  const std::vector<Nearness> rows = s.rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].label, "Seen: the left tube");
  EXPECT_EQ(rows[1].label, "Seen: the right tube");
}

TEST(Nearness, OfAlternativesTheNearestIsShown) {
  NearStep s(R"("when": {"any": [)" + pull_fact(R"("min": 10)") + ", " + pull_fact(R"("min": 2)") + "]}");
  s.pull(1);
  ASSERT_EQ(s.rows().size(), 1u);
  EXPECT_EQ(s.rows()[0].target(), "min 2 N");
}

TEST(Nearness, TheHoldTimeCountsDownWhileTheConditionHolds) {
  NearStep s(R"("when": )" + pull_fact(R"("min": 1)") + R"(, "for_s": 2)");
  s.pull(0.5);
  ASSERT_EQ(s.rows().size(), 2u);
  EXPECT_EQ(s.rows()[1].label, "Hold");
  EXPECT_EQ(s.rows()[1].value, 0);
  s.a.hold_tube(two_sides::kLeft, 0.055, 2);
  s.a.seconds(1);
  EXPECT_NEAR(s.rows()[1].value, 1, 0.05);
  EXPECT_EQ(s.rows()[1].target(), "min 2 s");
}

TEST(Nearness, ManyRowsOfOneFactBecomeACount) {
  std::vector<Nearness> rows;
  for (int i = 0; i < 8; ++i) {
    Nearness n = counted("seen", i < 3 ? 1 : 0, 1, "s");
    n.fact = &kMarkSeenFor;
    rows.push_back(n);
  }
  rows = in_short(rows, 5);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].value, 3);
  EXPECT_EQ(rows[0].low, 8);
}

TEST(Nearness, EveryFactHasALabelForPeople) {
  for (const Fact* fact : facts()) EXPECT_STRNE(words_of(*fact).label, "") << fact->name;
}

TEST(StepNeeds, AreTheEndoscopeWhereOnlyThePictureCountsAndElseTheHandOfTheStep) {
  const NearStep look(R"("when": {"fact": "mark.in_view", "of": "tube_left.fimbria"})");
  EXPECT_TRUE(needs_of(look.a.monitor.rules(), 0, {look.a.model, look.a.state}).endoscope);
  const NearStep pull(R"("when": )" + pull_fact(R"("min": 1)"));
  const StepNeeds needs = needs_of(pull.a.monitor.rules(), 0, {pull.a.model, pull.a.state});
  EXPECT_FALSE(needs.endoscope);
  EXPECT_EQ(needs.hand, 0);
  EXPECT_FALSE(asks_for_declaration(pull.a.monitor.rules()));
}

TEST(StepNeeds, OfACutAreTheScissors) {
  const NearStep cut(R"("on": {"event": "cut", "on": "tube_left"})");
  const StepNeeds needs = needs_of(cut.a.monitor.rules(), 0, {cut.a.model, cut.a.state});
  EXPECT_TRUE(needs.divide);
  EXPECT_EQ(needs.hand, two_sides::kScissors);
}

}  // namespace
