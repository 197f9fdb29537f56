// Spread and trend over attempts whose figures are chosen by hand.
#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/core/random.hpp>
#include <trocar/training/metrics/study.hpp>

using namespace trocar::training;

namespace {

std::string numbered(char letter, int number) { return std::string(1, letter).append(std::to_string(number)); }

StudyAttempt attempt(const std::string& person, int repetition, double seconds) {
  StudyAttempt a;
  a.person = person;
  a.trial = numbered('T', repetition);
  a.repetition = repetition;
  a.metrics.duration = seconds;
  return a;
}

const MetricStudy& durations(const Study& study) { return study.metrics.front(); }

}  // namespace

TEST(Study, SpearmanIsTheCorrelationOfRanks) {
  const std::vector<double> rising{1, 2, 3, 4, 5}, curved{1, 8, 27, 64, 125}, falling{5, 4, 3, 2, 1};
  EXPECT_NEAR(spearman(rising, curved), 1, 1e-15);
  EXPECT_NEAR(spearman(rising, falling), -1, 1e-15);
  // Ties share their mean rank: ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4.
  const std::vector<double> a{10, 20, 20, 30}, b{1, 2, 3, 4};
  EXPECT_NEAR(spearman(a, b), 4.5 / std::sqrt(4.5 * 5.0), 1e-15);
}

TEST(Study, WithoutVariationThereIsNoCorrelation) {
  const std::vector<double> constant(90, 0.1), zero(90, 0.0);
  std::vector<double> rising;
  for (int i = 0; i < 90; ++i) rising.push_back(i % 15);
  EXPECT_TRUE(std::isnan(spearman(rising, constant)));
  EXPECT_TRUE(std::isnan(spearman(rising, zero)));
  EXPECT_TRUE(std::isnan(spearman(std::vector<double>{1, 2}, std::vector<double>{1, 2})));
}

TEST(Study, QuartilesInterpolate) {
  const Spread s = spread_of({4, 1, 3, 2, kNoMetric, 10});
  EXPECT_EQ(s.count, 5);
  EXPECT_EQ(s.least, 1);
  EXPECT_EQ(s.lower, 2);
  EXPECT_EQ(s.median, 3);
  EXPECT_EQ(s.upper, 4);
  EXPECT_EQ(s.most, 10);
  EXPECT_EQ(spread_of({1, 2}).median, 1.5);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

TEST(Study, SlopeIsTheOneWithinPeopleAndNotBetweenThem) {
  // Everybody becomes 2 s quicker each time; who did more repetitions is slower, which pulls a pooled slope upwards.
  std::vector<StudyAttempt> attempts;
  for (int person = 0; person < 3; ++person)
    for (int r = 1; r <= 4 + 4 * person; ++r)
      attempts.push_back(attempt(std::string(1, char('A' + person)), r, 100 + 80 * person - 2 * r));
  const Study study = study_of(attempts);
  const Trend& trend = durations(study).trend;
  EXPECT_NEAR(trend.slope.value, -2, 1e-12);
  EXPECT_NEAR(trend.slope.low, -2, 1e-12);
  EXPECT_NEAR(trend.slope.high, -2, 1e-12);
  EXPECT_NEAR(trend.within.value, -1, 1e-12);
  EXPECT_GT(trend.pooled.value, 0) << "the pooled figure mixes people, which is why both are given";
  EXPECT_EQ(study.persons, (std::vector<std::string>{"A", "B", "C"}));
  EXPECT_EQ(durations(study).by_repetition.size(), 12u);
  EXPECT_EQ(durations(study).by_repetition[0].count, 3);
  EXPECT_EQ(durations(study).by_repetition[11].count, 1);
}

TEST(Study, RangeIsWhatRemainsWhenEachPersonIsLeftOut) {
  std::vector<StudyAttempt> attempts;
  const double slopes[] = {-1, -2, -6};
  for (int person = 0; person < 3; ++person)
    for (int r = 1; r <= 5; ++r)
      attempts.push_back(attempt(std::string(1, char('A' + person)), r, 200 + slopes[person] * r));
  const Trend trend = durations(study_of(attempts)).trend;
  EXPECT_NEAR(trend.slope.value, -3, 1e-12);
  EXPECT_NEAR(trend.slope.low, -4, 1e-12) << "without the first";
  EXPECT_NEAR(trend.slope.high, -1.5, 1e-12) << "without the third";
  attempts.resize(10);
  EXPECT_TRUE(std::isnan(durations(study_of(attempts)).trend.slope.low)) << "two people have no range";
}

TEST(Study, ChanceGivesNoTrend) {
  trocar::core::Random random(11);
  std::vector<StudyAttempt> attempts;
  for (int person = 0; person < 10; ++person)
    for (int r = 1; r <= 30; ++r) attempts.push_back(attempt(numbered('P', person), r, random.uniform(100, 200)));
  const Trend trend = durations(study_of(attempts)).trend;
  EXPECT_NEAR(trend.pooled.value, 0, 0.15);
  EXPECT_NEAR(trend.within.value, 0, 0.15);
}

TEST(Study, JsonLeavesOutWhatNobodyHasAndStaysValidWithStrangeNames) {
  const Study study = study_of({attempt("Zoë \"<b>\"\xff", 1, 10), attempt("B", 1, 20)});
  const auto json = nlohmann::json::parse(study_json(study));
  ASSERT_EQ(json["attempts"].size(), 2u);
  for (const auto& metric : json["metrics"]) EXPECT_NE(metric["key"], "sparc");
  EXPECT_EQ(json["metrics"][0]["key"], "duration_s");
  EXPECT_EQ(json["metrics"][0]["spread"]["median"], 15);
  EXPECT_TRUE(json["metrics"][0]["trend"]["spearman_pooled"]["value"].is_null());
  EXPECT_NO_THROW(study_json(study_of({})));
}

TEST(Study, LeavingOutEachOfManyPeopleIsAffordable) {
  constexpr int kPeople = 1500;  // cubic in them this takes minutes
  trocar::core::Random random(3);
  std::vector<StudyAttempt> all;
  for (int p = 0; p < kPeople; ++p)
    for (int r = 1; r <= 3; ++r) all.push_back(attempt(numbered('P', p), r, 100 - 5 * r + random.uniform(-1, 1)));
  const Trend& trend = durations(study_of(all)).trend;
  EXPECT_NEAR(trend.slope.value, -5, 0.1);
  EXPECT_LE(trend.slope.low, trend.slope.value);
  EXPECT_GE(trend.slope.high, trend.slope.value);
  EXPECT_NEAR(trend.within.value, -1, 1e-12);
  EXPECT_LT(trend.pooled.high, -0.9);
}
