#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/devices/motion_file.hpp>

using namespace trocar;
using namespace trocar::devices;
namespace fs = std::filesystem;

namespace {

const std::string kHeader = "operator,trial,t_ms,xL,yL,zL,rollL,handleL,xR,yR,zR,rollR,handleR,subtask\n";

class MotionFile : public testing::Test {
 protected:
  ~MotionFile() override { fs::remove(m_path); }
  std::string write(const std::string& text) const {
    std::ofstream(m_path, std::ios::binary) << text;
    return m_path.string();
  }
  /// The faults that reading `text` tells, without the path.
  std::vector<std::string> faults(const std::string& text) const {
    const std::string path = write(text);
    std::vector<std::string> result;
    try {
      read_motion_file(path);
    } catch (const core::BadInput& error) {
      for (const core::Fault& fault : error.faults()) {
        EXPECT_EQ(fault.at.file, path);
        result.push_back(core::to_string(fault).substr(path.size() + 1));
      }
    }
    return result;
  }

 private:
  fs::path m_path = fs::path(testing::TempDir()) / ("trocar_motion_" + std::to_string(getpid()) + ".csv");
};

/// A trial whose left hand goes through `points` [m], one a second; the right rests.
MotionTrial through(const std::vector<std::array<double, 3>>& points) {
  MotionTrial trial{"T/1", {}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    MotionSample sample;
    sample.time = double(i);
    sample.hands[0].tip = points[i];
    trial.samples.push_back(sample);
  }
  return trial;
}

double length_at_1_khz(const MotionCurve& curve, Hand hand) {
  double length = 0;
  auto before = curve.at_tick(0).hand(hand).tip;
  for (std::uint64_t tick = 1; tick < curve.ticks(); ++tick) {
    const auto now = curve.at_tick(tick).hand(hand).tip;
    length += std::hypot(now[0] - before[0], now[1] - before[1], now[2] - before[2]);
    before = now;
  }
  return length;
}

const fs::path kShared =
    fs::path(TROCAR_SOURCE_DIR) / "../shared/data/kinematics/iras_laparoscopic/iras_A_cartesian.csv";

}  // namespace

TEST_F(MotionFile, ReadsTrialsInSiUnits) {
  const std::string path = write(kHeader +
                                 "A01,P01,3438,1,2,3,0.5,0.25,-4,-5,-6,1,2,1\r\n"
                                 "A01,P01,4438,2e1,+2,3.5,0.5,0.75,-4,-5,-6,1,2,3\n"
                                 "A01,P02,0,0,0,0,0,0,0,0,0,0,0,1\n"
                                 "A01,P02,250.5,0,0,0,0,0,0,0,0,0,0,1\n");
  const std::vector<MotionTrial> trials = read_motion_file(path);
  ASSERT_EQ(trials.size(), 2u);
  EXPECT_EQ(trials[0].name, "A01/P01");
  ASSERT_EQ(trials[0].samples.size(), 2u);
  const MotionSample& second = trials[0].samples[1];
  EXPECT_DOUBLE_EQ(second.time, 1);
  EXPECT_EQ(second.hand(Hand::left).tip, (std::array<double, 3>{0.020, 0.002, 0.0035}));
  EXPECT_EQ(second.hand(Hand::right).tip, (std::array<double, 3>{-0.004, -0.005, -0.006}));
  EXPECT_EQ(second.hand(Hand::left).roll, 0.5);
  EXPECT_EQ(second.hand(Hand::left).handle, 0.75);
  EXPECT_EQ(second.subtask, 3);
  EXPECT_DOUBLE_EQ(trials[1].samples[1].time, 0.2505);
}

TEST_F(MotionFile, ColumnsAreFoundByName) {
  const std::string path = write(
      "t_ms,note,operator,trial,xR,yR,zR,rollR,handleR,xL,yL,zL,rollL,handleL\n"
      "0,hello,A,1,1,0,0,0,0,2,0,0,0,0\n"
      "9,,A,1,1,0,0,0,0,2,0,0,0,0\n");
  const MotionTrial trial = read_motion_trial(path);
  EXPECT_EQ(trial.samples[0].hand(Hand::left).tip[0], 0.002);
  EXPECT_EQ(trial.samples[0].hand(Hand::right).tip[0], 0.001);
}

TEST_F(MotionFile, TrialIsChosenByNameAndTheFirstIsTheDefault) {
  std::string text = kHeader;
  for (const char* name : {"A01,P01", "A01,P02", "A02,P01"})
    for (const char* rest : {",0,0,0,0,0,0,0,0,0,0,0,1\n", ",1,0,0,0,0,0,0,0,0,0,0,1\n"}) text += name, text += rest;
  const std::string path = write(text);
  EXPECT_EQ(read_motion_trial(path).name, "A01/P01");
  EXPECT_EQ(read_motion_trial(path + "#A02/P01").name, "A02/P01");
  try {
    read_motion_trial(path + "#A09/P01");
    FAIL();
  } catch (const core::BadInput& error) {
    EXPECT_EQ(std::string(error.what()),
              path + ": no trial \"A09/P01\" in this file; there are: A01/P01 A01/P02 A02/P01");
  }
}

TEST_F(MotionFile, EveryFaultIsLocatedInOnePass) {
  const std::vector<std::string> told = faults(kHeader +
                                               "A01,P01,0,1,2,3,0,0,0,0,0,0,0,1\n"
                                               "A01,P01,1000,x,2,nan,0,0,0,0,0,0,0,1\n"
                                               "A01,P01,1000,1,2\n"
                                               "A01,P01,0,1,2,3,0,0,0,0,0,0,0,1\n"
                                               "A01,P01,1000,99999,2,3,0,0,0,0,0,0x10,0,1\n"
                                               "A01,P02,0,1,2,3,0,0,0,0,0,0,0,1\n"
                                               "A01,P01,3000,1,2,3,0,0,0,0,0,0,0,1.5\n");
  const std::vector<std::string> expected = {
      "3:14: expected xL as a decimal number, got \"x\"",
      "3:18: expected zL as a decimal number, got \"nan\"",
      "4:1: expected 14 fields, got 5",
      "5:9: expected a later time than in the row before, got \"0\"",
      "6:14: expected xL within +-10000, got \"99999\"",
      "6:34: expected rollR as a decimal number, got \"0x10\"",
      "7:1: expected at least two rows of trial \"A01/P02\"",
      "8:1: expected the rows of trial \"A01/P01\" together, they begin a second time here",
      "8:34: expected subtask as a whole number, got \"1.5\"",
  };
  EXPECT_EQ(told, expected);
}

TEST_F(MotionFile, FaultsAreBounded) {
  std::string text = kHeader;
  for (int i = 0; i < 10'000; ++i) text += "?\n";
  const auto told = faults(text);
  EXPECT_EQ(told.size(), std::size_t(kMaxMotionFaults) + 1);
  EXPECT_NE(told.back().find("too many faults"), std::string::npos);
}

TEST_F(MotionFile, HeaderFaultsAreTold) {
  EXPECT_EQ(faults(""), std::vector<std::string>{"1:1: expected a line of column names, got an empty file"});
  EXPECT_EQ(faults("a,b\n1,2\n").size(), 13u);
  EXPECT_EQ(faults(kHeader), std::vector<std::string>{"1:1: expected rows of motion after the column names"});
  std::string twice = kHeader;
  twice.replace(twice.find("subtask"), 7, "xL");
  EXPECT_EQ(faults(twice).size(), 1u);
}

TEST_F(MotionFile, ALongTrialIsAFaultNotALongWait) {
  EXPECT_EQ(faults(kHeader + "A,1,0,0,0,0,0,0,0,0,0,0,0,1\n"
                             "A,1,1,0,0,0,0,0,0,0,0,0,0,1\n"
                             "A,1,1e11,0,0,0,0,0,0,0,0,0,0,1\n")
                .size(),
            1u);
}

TEST_F(MotionFile, DamagedBytesNeverCrash) {
  const std::string good = kHeader +
                           "A01,P01,0,1,2,3,0,0,0,0,0,0,0,1\n"
                           "A01,P01,1000,1.5,2,3,0.5,0,0,0,0,0,0,1\n"
                           "A01,P01,2000,1.5,2,3,0.5,0,0,0,0,0,0,1\n";
  core::Random random(3);
  int refused = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = char(random.next());
    refused += !faults(bad).empty();
    refused += !faults(good.substr(0, i)).empty();
  }
  EXPECT_GT(refused, int(good.size()) / 2);
}

TEST_F(MotionFile, AFolderOrAMissingFileIsRefused) {
  EXPECT_THROW(read_motion_file(testing::TempDir()), core::BadInput);
  EXPECT_THROW(read_motion_file("no/such/file.csv"), core::BadInput);
  EXPECT_THROW(read_motion_file("/dev/zero"), core::BadInput);
}

TEST(MotionBounds, AreThoseOfTheRows) {
  MotionTrial trial = through({{0, 0, 0}, {0.03, 0.04, 0}, {0.03, 0.04, 0}, {0.03, 0.04, 0.1}});
  trial.samples[1].hands[0].handle = 2;
  trial.samples[2].hands[0].roll = -1;
  const MotionBounds bounds = bounds_of(trial, Hand::left);
  EXPECT_EQ(bounds.low, (std::array<double, 3>{0, 0, 0}));
  EXPECT_EQ(bounds.high, (std::array<double, 3>{0.03, 0.04, 0.1}));
  EXPECT_DOUBLE_EQ(bounds.path_length, 0.15);
  EXPECT_DOUBLE_EQ(bounds.centroid[0], (0.015 + 0.03 + 0.03) / 3);
  EXPECT_EQ(bounds.roll_low, -1);
  EXPECT_EQ(bounds.handle_high, 2);
  EXPECT_DOUBLE_EQ(closure(2, bounds), 0);  // wide open
  EXPECT_DOUBLE_EQ(closure(0, bounds), 1);
  EXPECT_DOUBLE_EQ(closure(-1, bounds), 1);
  EXPECT_EQ(closure(0, bounds_of(trial, Hand::right)), 0);  // never moved
}

TEST(MotionCurve, PassesThroughEveryRow) {
  const std::vector<std::array<double, 3>> points = {{0, 0, 0}, {0.01, 0.02, 0}, {0.01, 0.03, 0.01}, {-0.02, 0, 0.05}};
  const MotionCurve curve(through(points));
  ASSERT_EQ(curve.ticks(), 3001u);
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(curve.at_tick(1000 * i).hand(Hand::left).tip[k], points[i][k], 1e-15);
}

TEST(MotionCurve, AStraightRunAtConstantSpeedStaysOne) {
  const MotionCurve curve(through({{0, 0, 0}, {0.01, 0.02, 0}, {0.02, 0.04, 0}, {0.03, 0.06, 0}, {0.04, 0.08, 0}}));
  for (double t = 1; t <= 3; t += 0.01) EXPECT_NEAR(curve.at(t).hand(Hand::left).tip[1], 0.02 * t, 1e-15);
}

TEST(MotionCurve, ALineIsNeverOvershot) {
  core::Random random(5);
  std::vector<std::array<double, 3>> points(200);
  for (auto& point : points) point = {random.uniform(-0.1, 0.1), 0, 0};
  const MotionCurve curve(through(points));
  for (std::uint64_t tick = 0; tick < curve.ticks(); ++tick) {
    const std::size_t i = std::min<std::size_t>(tick / 1000, points.size() - 2);
    const double x = curve.at_tick(tick).hand(Hand::left).tip[0];
    ASSERT_GE(x, std::min(points[i][0], points[i + 1][0]) - 1e-15) << tick;
    ASSERT_LE(x, std::max(points[i][0], points[i + 1][0]) + 1e-15) << tick;
  }
}

TEST(MotionCurve, VelocityIsContinuous) {
  core::Random random(8);
  std::vector<std::array<double, 3>> points(50);
  for (auto& p : points) p = {random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)};
  const MotionCurve curve(through(points));
  constexpr double kStep = 1e-6;
  for (std::size_t i = 1; i + 1 < points.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const auto x = [&](double t) { return curve.at(t).hand(Hand::left).tip[k]; };
      const double t = double(i), left = (x(t) - x(t - kStep)) / kStep, right = (x(t + kStep) - x(t)) / kStep;
      EXPECT_NEAR(left, right, 1e-5);
    }
}

TEST(MotionCurve, GivesTheSameBitsOnEveryMachineAndCompiler) {
  core::Random random(12);
  MotionTrial trial{"T/1", std::vector<MotionSample>(40)};
  double time = 0;
  for (MotionSample& sample : trial.samples) {
    sample.time = time;
    time += random.uniform(0.1, 1.5);
    for (HandMotion& hand : sample.hands)
      hand = {{random.uniform(), random.uniform(), random.uniform()}, random.uniform(), random.uniform()};
  }
  const MotionCurve curve(trial);
  core::Hasher hasher;
  for (std::uint64_t tick = 0; tick < curve.ticks(); ++tick)
    for (const HandMotion& hand : curve.at_tick(tick).hands)
      for (const double value : {hand.tip[0], hand.tip[1], hand.tip[2], hand.roll, hand.handle}) hasher.add(value);
  EXPECT_EQ(hasher.value(), 0xb9458ff3785f9285ull);  // computed with gcc 12 at -O2
}

TEST(MotionCurve, HandsAtOneHertzKeepTheirPathLength) {
  core::Random random(21);
  for (int n = 0; n < 20; ++n) {  // hands that wander: each second a little on in a direction that turns
    std::vector<std::array<double, 3>> points(120);
    double heading = random.uniform(0, 6), slope = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      heading += random.uniform(-0.8, 0.8);
      slope = random.uniform(-0.3, 0.3);
      const double step = random.uniform() < 0.2 ? 0 : random.uniform(0, 0.02);
      points[i] = {points[i - 1][0] + step * std::cos(heading), points[i - 1][1] + step * std::sin(heading),
                   points[i - 1][2] + step * slope};
    }
    const MotionTrial trial = through(points);
    const double excess =
        length_at_1_khz(MotionCurve(trial), Hand::left) / bounds_of(trial, Hand::left).path_length - 1;
    EXPECT_GE(excess, 0) << n;
    EXPECT_LT(excess, 0.005) << n;
  }
}
