// What the result window says, from results that no simulation had to make.
#include "trainer/result_summary.hpp"

#include <gtest/gtest.h>

#include <trocar/core/json.hpp>

namespace trocar::app {
namespace {

Json result() {
  return Json::parse(R"({
    "passed": false, "exercise_seconds": 71.4, "simulated_seconds": 80,
    "assessment": {
      "score": {"scored": true, "total": 46.2, "penalties": 11, "pass_mark": 80,
                "points": {"quality": 41.2, "time": 16}, "points_at_most": {"quality": 60, "time": 40}},
      "steps": [{"name": "Survey", "done": true}, {"name": "Cut", "done": false}],
      "errors": [
        {"code": "C1", "meaning": "the picture was turned", "hint": "turn it back", "points": 2, "at_s": 5},
        {"code": "C2", "meaning": "the lens touched a peg", "hint": "draw the endoscope back", "points": 5, "at_s": 12},
        {"code": "C1", "meaning": "the picture was turned", "hint": "turn it back", "points": 2, "at_s": 9},
        {"code": "C1", "meaning": "the picture was turned", "hint": "turn it back", "points": 2, "at_s": 20}]},
    "metrics": {"hands": [{"name": "left_lateral", "path_m": 0.4}], "camera": {"path_m": 1.25}}})");
}

TEST(ResultSummary, GivesPointsWithTheirMaximum) {
  const ResultSummary s = summarise(result(), {});
  EXPECT_EQ(s.score, "46.2 of 100 points (pass mark 80)");
  ASSERT_EQ(s.parts.size(), 3u);
  EXPECT_EQ(s.parts[0].name + " " + s.parts[0].points, "Quality 41.2 of 60 points");
  EXPECT_EQ(s.parts[1].points, "16 of 40 points");
  EXPECT_EQ(s.parts[2].points, "-11 points");
  EXPECT_EQ(s.duration, "Duration 1:11");
  EXPECT_EQ(s.verdict, ResultSummary::Verdict::not_passed);
}

TEST(ResultSummary, GathersErrorsOfAKindWithWhatWouldHaveBeenBetter) {
  const ResultSummary s = summarise(result(), {});
  ASSERT_EQ(s.costs.size(), 2u);
  EXPECT_EQ(s.costs[0].text, "The picture was turned");
  EXPECT_EQ(s.costs[0].when, "3 times, first at 0:05");
  EXPECT_EQ(s.costs[0].points, "-6 points");
  EXPECT_EQ(s.costs[0].better, "Better: turn it back");
  EXPECT_EQ(s.costs[1].when, "at 0:12");
}

TEST(ResultSummary, ComparesWithEarlierAttempts) {
  EXPECT_TRUE(summarise(result(), training::standing_of({46.2})).earlier.empty());
  EXPECT_EQ(summarise(result(), training::standing_of({60, 82.5, 46.2})).earlier,
            "Previous 82.5, best 82.5, median 60 points (3 attempts)");
}

TEST(ResultSummary, AdvisesTheWeakestThingFirst) {
  Json r = result();
  EXPECT_EQ(summarise(r, {}).advice, "Avoid this error first: The picture was turned. Better: turn it back");
  r["assessment"]["errors"] = Json::array();
  EXPECT_EQ(summarise(r, {}).advice, "Practise this step next: Cut.");
  r["assessment"]["steps"][1]["done"] = true;
  EXPECT_NE(summarise(r, {}).advice.find("Work faster"), std::string::npos);
  r["assessment"]["score"]["points"]["time"] = 39;
  EXPECT_TRUE(summarise(r, {}).advice.empty());
}

TEST(ResultSummary, NamesTheNextExerciseOnceThisOneIsPassed) {
  const std::vector<attempt::ExerciseEntry> list{{"basics/a", "First", {}}, {"basics/b", "Second", {}}};
  EXPECT_EQ(next_training(list, "basics/a", true), "Next exercise: Second");
  EXPECT_EQ(next_training(list, "basics/a", false), "Repeat this exercise until you reach the pass mark.");
  EXPECT_EQ(next_training(list, "basics/b", true), "");
  EXPECT_EQ(next_training(list, "elsewhere", true), "");
}

TEST(ResultSummary, OfPracticeHasNoScore) {
  const ResultSummary s = summarise(Json{{"passed", nullptr}, {"simulated_seconds", 11}}, {});
  EXPECT_EQ(s.verdict, ResultSummary::Verdict::no_score);
  EXPECT_TRUE(s.score.empty() && s.parts.empty() && s.costs.empty() && s.advice.empty());
  EXPECT_EQ(s.duration, "Duration 0:11");
}

TEST(ResultSummary, ListsTheLengthOfEveryPath) {
  EXPECT_EQ(summarise(result(), {}).paths, (std::vector<std::string>{"Left lateral: 400 mm", "Endoscope: 1250 mm"}));
}

TEST(Standing, KnowsLastBestAndMedian) {
  const training::Standing none = training::standing_of({});
  EXPECT_FALSE(none.last || none.best || none.median);
  const training::Standing even = training::standing_of({10, 40, 20, 30});
  EXPECT_EQ(even.last, 30);
  EXPECT_EQ(even.best, 40);
  EXPECT_EQ(even.median, 25);
}

}  // namespace
}  // namespace trocar::app
