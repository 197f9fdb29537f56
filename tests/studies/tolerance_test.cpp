#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/studies/handles.hpp>
#include <trocar/studies/statistics.hpp>
#include <trocar/studies/tolerance.hpp>

#include "shipped.hpp"

namespace trocar::studies {
namespace {

using namespace kinematics;

constexpr double kTenMicrometres = 1e-5;

Measured tip_along_x(const Mechanism& m, const char* frame) {
  return {MeasuredKind::along, m.frame(frame), -1, {1, 0, 0}};
}
ToleranceStudy study_of(const char* name, const char* frame, double handle) {
  const Mechanism m = shipped(name);
  return ToleranceStudy(m, std::vector<double>(m.drives.size(), handle), tip_along_x(m, frame),
                        everywhere(m, kTenMicrometres, 0));
}

TEST(Tolerance, LinearAndMonteCarloOfShippedInstrumentsAgreeWithinTwoPerCent) {
  for (const char* name : {"grasper", "maryland", "needle_holder", "clip_applier", "bipolar"}) {
    const ToleranceStudy study = study_of(name, "tip_upper", 0.5);
    std::vector<double> values(60'000);
    study.sample(1, 0, values);
    const Statistics s = statistics(values, study.linear().nominal, {});
    EXPECT_EQ(s.open, 0) << name;
    EXPECT_GT(study.linear().deviation, 1e-6) << name;
    EXPECT_NEAR(s.deviation / study.linear().deviation, 1, 0.02) << name;
    EXPECT_LT(std::fabs(s.mean), 0.02 * s.deviation) << name;
    EXPECT_NEAR(s.percentiles[4], 3 * study.linear().deviation, 0.15 * study.linear().deviation * 3) << name;
  }
}

TEST(Tolerance, SlopesOfTheFourBarAreThoseOfFreudensteinsEquation) {  // [Freudenstein], differentiated by hand
  const Mechanism m = shipped("four_bar");
  const double crank = 60 * portable::pi / 180;
  const Measured what{MeasuredKind::turn, m.frame("tip"), -1, {0, 0, 1}};
  std::vector<Toleranced> tolerances;
  for (const char* name : {"crank", "coupler", "rocker", "ground_line"})
    tolerances.push_back({m.parameter(name), kTenMicrometres});
  const ToleranceStudy study(m, std::vector<double>{60.0 / 360}, what, tolerances);
  // The coupler's angle t from the loop: a e^(i crank) + b e^(i t) = d + c e^(i r).
  const double a = 0.020, b = 0.050, c = 0.045, d = 0.055;
  const double px = d - a * std::cos(crank), py = -a * std::sin(crank), far = std::sqrt(px * px + py * py);
  const double t = std::atan2(py, px) + std::acos((far * far + b * b - c * c) / (2 * far * b));
  const double rx = a * std::cos(crank) + b * std::cos(t) - d, ry = a * std::sin(crank) + b * std::sin(t);
  const double r = std::atan2(ry, rx), across = b * std::sin(t - r);
  // What moves the knee away from the rocker's end, along the rocker, must be turned back by the coupler.
  const double wanted[] = {std::cos(crank - r) / across, std::cos(t - r) / across, -1 / across, -std::cos(r) / across};
  for (const Sensitivity& s : study.linear().ranked) {
    const auto k = std::find_if(tolerances.begin(), tolerances.end(),
                                [&](const Toleranced& x) { return x.parameter == s.parameter; }) -
                   tolerances.begin();
    EXPECT_NEAR(s.slope, wanted[k], 1e-5 * std::fabs(1 / across)) << m.parameters[std::size_t(s.parameter)].name;
  }
  EXPECT_EQ(study.linear().ranked.size(), 4u);
}

TEST(Tolerance, RankingIsByEffectAndSharesAddUpToAll) {
  const LinearTolerance l = study_of("needle_holder", "tip_upper", 0.5).linear();
  double sum = 0, worst = 0;
  for (std::size_t k = 0; k < l.ranked.size(); ++k) {
    EXPECT_GE(std::fabs(l.ranked[k > 0 ? k - 1 : 0].effect()), std::fabs(l.ranked[k].effect()));
    sum += l.ranked[k].share;
    worst += std::fabs(l.ranked[k].effect());
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(worst, l.worst, 1e-15);
  EXPECT_GT(l.worst, l.rss);
}

TEST(Tolerance, SamplesAreTheSameBitsHoweverTheyAreSharedOut) {
  const ToleranceStudy study = study_of("grasper", "tip_upper", 0.3);
  std::vector<double> alone(5000), shared(5000), pieces(5000);
  study.sample(7, 0, alone);
  core::ThreadPool pool(3);
  study.sample(7, 0, shared, &pool);
  for (const auto& [from, to] : {std::pair(3001, 5000), std::pair(0, 700), std::pair(700, 3001)})
    study.sample(7, from, std::span(pieces).subspan(std::size_t(from), std::size_t(to - from)));
  EXPECT_EQ(alone, shared);
  EXPECT_EQ(alone, pieces);
  std::vector<double> other(5000);
  study.sample(8, 0, other);
  EXPECT_NE(alone, other);
}

TEST(Tolerance, UniformErrorsStayBelowTheWorstSum) {
  const Mechanism m = shipped("grasper");
  const ToleranceStudy study(m, std::vector<double>{0.5}, tip_along_x(m, "tip_upper"),
                             everywhere(m, kTenMicrometres, 0), Distribution::uniform);
  std::vector<double> values(30'000);
  study.sample(1, 0, values);
  const Statistics s = statistics(values, study.linear().nominal, {});
  EXPECT_NEAR(s.deviation / study.linear().deviation, 1, 0.02);
  EXPECT_LT(s.high, 1.01 * study.linear().worst);
  EXPECT_GT(s.low, -1.01 * study.linear().worst);
}

TEST(Tolerance, DimensionsAcrossAPlanarLoopAreToldAsMisfitsAndNotDrawn) {
  const ToleranceStudy study = study_of("four_bar", "tip", 0.2);
  const auto misfit = [&](const char* name) {
    return std::any_of(study.misfits().begin(), study.misfits().end(),
                       [&](const Misfit& x) { return x.parameter == study.mechanism().parameter(name); });
  };
  EXPECT_TRUE(misfit("coupler.at.z"));  // the knee's ends no longer meet
  EXPECT_FALSE(misfit("coupler.at.y"));
  for (const Misfit& x : study.misfits()) EXPECT_NEAR(x.gap, kTenMicrometres, 0.6 * kTenMicrometres);
}

TEST(Tolerance, RefusesAPoseThatCannotBeOrThatSlopesSayNothingOf) {
  EXPECT_THROW(study_of("grasper", "nothing", 0), std::invalid_argument);
  const Mechanism m = shipped("grasper");
  EXPECT_THROW(ToleranceStudy(m, std::vector<double>{40.0}, tip_along_x(m, "tip_upper"), everywhere(m, 1e-5, 0)),
               std::invalid_argument);
}

TEST(Tolerance, EverywhereLeavesOutShapesAndTakesTheFilesFiguresWhereNoneAreGiven) {
  const Mechanism m = shipped("grasper");
  const std::vector<Toleranced> of_file = everywhere(m, 0, 0), all = everywhere(m, kTenMicrometres, 0);
  EXPECT_EQ(of_file.size(), 2u);
  for (const Toleranced& t : all)
    EXPECT_EQ(m.parameters[std::size_t(t.parameter)].name.find("shape"), std::string::npos);
  EXPECT_GT(all.size(), 20u);
}

TEST(Statistics, FiguresOfKnownValuesAreThose) {
  std::vector<double> values;
  for (int i = 0; i <= 1000; ++i) values.push_back(5 + 0.001 * i);
  values.push_back(std::nan(""));
  const Statistics s = statistics(values, 5.5, {-0.25, 0.25}, 10);
  EXPECT_EQ(s.samples, 1002);
  EXPECT_EQ(s.open, 1);
  EXPECT_NEAR(s.mean, 0, 1e-12);
  EXPECT_NEAR(s.deviation, 0.28910, 1e-4);
  EXPECT_NEAR(s.skewness, 0, 1e-10);
  EXPECT_NEAR(s.percentiles[2], 0, 1e-12);
  EXPECT_NEAR(s.percentiles[1], -0.475, 1e-9);
  EXPECT_NEAR(s.yield, 0.5, 0.002);
  std::int64_t all = 0;
  for (const std::int64_t n : s.bins) all += n;
  EXPECT_EQ(all, 1001);
}

TEST(Statistics, NothingAndOneValueAreTakenAsTheyAre) {
  EXPECT_EQ(statistics({}, 0, {}).samples, 0);
  const double nan = std::nan("");
  EXPECT_EQ(statistics({&nan, 1}, 0, {}).yield, 0);
  const double one = 3;
  const Statistics s = statistics({&one, 1}, 1, {});
  EXPECT_EQ(s.mean, 2);
  EXPECT_EQ(s.deviation, 0);
  EXPECT_EQ(s.yield, 1);
}

}  // namespace
}  // namespace trocar::studies
