// Peristalsis as forces on nodes: what they add up to, where they act and when.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/network/force_wave.hpp>

using namespace trocar;
using namespace trocar::tissue;

namespace {

constexpr double kRadius = 0.012;

/// A filled tube bent by a quarter of a circle of 80 mm, as nodes on circles around its line.
struct BentTube {
  std::vector<Vec3d> line, rest;
  std::vector<double> volume;
  std::vector<int> row;

  BentTube() {
    constexpr int kAlong = 60, kOut = 4, kAround = 16;
    for (int i = 0; i <= kAlong; ++i) {
      const double angle = 0.5 * portable::pi * i / kAlong, c = portable::cos(angle), s = portable::sin(angle);
      line.push_back({0.080 * s, 0.080 * (1 - c), 0});
      for (int j = 0; j < kOut; ++j)
        for (int k = 0; k < kAround; ++k) {
          const double r = kRadius * (j + 0.5) / kOut, turn = 2 * portable::pi * (k + 0.5) / kAround;
          const Vec3d out{-s * portable::cos(turn), c * portable::cos(turn), portable::sin(turn)};
          row.push_back(int(rest.size()));
          rest.push_back(line.back() + r * out);
          const double step = 0.5 * portable::pi / kAlong * (0.080 - r * portable::cos(turn));
          volume.push_back(2 * portable::pi * r / kAround * kRadius / kOut * step * (i % kAlong == 0 ? 0.5 : 1));
        }
    }
  }

  ForceWaveDescription waves() const {
    ForceWaveDescription d;
    d.centreline = line;
    d.stations = {{0, 2000, 0.015}};
    d.period = 6;
    return d;
  }
};

/// Nodes that are at these places.
std::vector<NodeState> states(const std::vector<Vec3d>& places) {
  std::vector<NodeState> rows(places.size());
  for (size_t i = 0; i < places.size(); ++i)
    rows[i].x = float(places[i].x), rows[i].y = float(places[i].y), rows[i].z = float(places[i].z);
  return rows;
}

std::vector<Vec3d> forces(const ForceWaveModel& wave, const NodeView& nodes, double t) {
  std::vector<Vec3d> f(nodes.rows.size(), Vec3d{0, 0, 0});
  add_wave(wave, nodes, t, f);
  return f;
}

struct Sums {
  Vec3d force{0, 0, 0}, moment{0, 0, 0};
  double size = 0, lever = 0;
};
Sums sums(const ForceWaveModel& wave, const NodeView& nodes, double t) {
  const std::vector<Vec3d> f = forces(wave, nodes, t);
  Sums s;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3d x = nodes.position(int(i));
    s.force += f[i];
    s.moment += cross(x, f[i]);
    s.size += length(f[i]);
    s.lever += length(x) * length(f[i]);
  }
  return s;
}

TEST(ForceWave, ItsForcesAndTheirMomentSumToZeroHoweverTheOrganLies) {
  const BentTube tube;
  const ForceWaveModel wave = build(tube.waves(), tube.rest, tube.volume);
  std::vector<Vec3d> places = tube.rest;
  for (Vec3d& p : places) p = {p.y * 1.3 + 0.01, -p.x + 4 * p.z * p.z, p.z * 0.7 + 2 * p.x * p.y};
  const std::vector<NodeState> rows = states(places);
  const NodeView now{rows, tube.row, {0.1, -0.2, 0}};
  for (const double t : {0.5, 4.0, 7.7, 30.0}) {
    const Sums s = sums(wave, now, t);
    EXPECT_GT(s.size, 0.01);
    EXPECT_LT(length(s.force), 1e-13 * s.size);
    EXPECT_LT(length(s.moment), 1e-12 * s.lever);
  }
}

TEST(ForceWave, TheyPullInwardsAcrossTheLumenAndNotAlongIt) {
  const BentTube tube;
  const ForceWaveModel wave = build(tube.waves(), tube.rest, tube.volume);
  const std::vector<NodeState> rows = states(tube.rest);
  const std::vector<Vec3d> f = forces(wave, {rows, tube.row, {}}, 7.0);
  double inwards = 0, along = 0, size = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3d p = tube.rest[i], out_of_bend = normalised(Vec3d{p.x, p.y - 0.080, 0});
    const Vec3d axis = Vec3d{0, 0.080, 0} + 0.080 * out_of_bend;
    inwards += dot(f[i], normalised(axis - p));
    along += std::fabs(dot(f[i], cross(out_of_bend, {0, 0, 1})));
    size += length(f[i]);
  }
  EXPECT_GT(inwards, 0.99 * size);
  EXPECT_LT(along, 0.05 * size);
}

TEST(ForceWave, ACrestPressesWithItsPressureOnTheWall) {
  // One half of a tube is pressed against the other with pressure times the shadow that it casts.
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  d.stations[0].speed = 1;
  d.width = 1;  // flat over the whole tube
  d.period = 1e6;
  d.first = 4;
  const ForceWaveModel wave = build(d, tube.rest, tube.volume);
  const std::vector<NodeState> rows = states(tube.rest);
  const std::vector<Vec3d> f = forces(wave, {rows, tube.row, {}}, 4.06);
  double down = 0;
  for (size_t i = 0; i < f.size(); ++i)
    if (tube.rest[i].z > 0) down -= f[i].z;
  const double shadow = 0.25 * portable::pi * (0.092 * 0.092 - 0.068 * 0.068);
  EXPECT_NEAR(down / (2000 * shadow), 1, 0.03);
}

TEST(ForceWave, WithOneSpeedItIsTheGaussianOfWayMinusSpeedTimesTime) {
  const BentTube tube;
  const ForceWaveDescription d = tube.waves();
  const ForceWaveModel wave = build(d, tube.rest, tube.volume);
  for (const double t : {3.5, 5.0, 6.5, 100.25})
    for (const ForceWavePair& pair : wave.pairs) {
      double expected = 0;
      const double s = 0.015 * pair.delay;
      for (int k = -30; k <= 30; ++k) {
        const double way = s - 0.015 * (t - 6 * k);
        if (std::fabs(way) <= 4 * d.width) expected += std::exp(-0.5 * way * way / (d.width * d.width));
      }
      EXPECT_NEAR(wave_height(wave, pair, t), expected, 1e-9);
    }
}

TEST(ForceWave, WhereItsSpeedChangesACrestArrivesAfterTheIntegralOfOneOverIt) {
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  d.stations = {{0.020, 1000, 0.008}, {0.060, 1000, 0.003}, {0.090, 1000, 0.006}};
  const ForceWaveModel wave = build(d, tube.rest, tube.volume);
  ForceWaveDescription even = d;
  even.stations = {{0, 1000, 0.001}};  // its delays are the ways [mm/s]
  const ForceWaveModel ways = build(even, tube.rest, tube.volume);
  ASSERT_EQ(wave.pairs.size(), ways.pairs.size());
  const auto speed = [](double s) {
    if (s < 0.020) return 0.008;
    if (s < 0.060) return 0.008 + (s - 0.020) / 0.040 * (0.003 - 0.008);
    if (s < 0.090) return 0.003 + (s - 0.060) / 0.030 * (0.006 - 0.003);
    return 0.006;
  };
  for (size_t i = 0; i < wave.pairs.size(); ++i) {
    const double s = 0.001 * ways.pairs[i].delay;
    double time = 0;
    for (int k = 0; k < 4000; ++k) time += s / 4000 / speed((k + 0.5) * s / 4000);
    EXPECT_NEAR(wave.pairs[i].delay, time, 1e-4 * time + 1e-9);
  }
}

TEST(ForceWave, AnOrganThatRestsForMostOfItsCycleHasOnlyTheWavesOfTheRest) {
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  d.cycle = 60;
  d.active = 0.25;  // waves begin at 0, 6 and 12 s
  const ForceWaveModel wave = build(d, tube.rest, tube.volume);
  const ForceWavePair& pair = wave.pairs.front();
  int crests = 0;
  double before = 0, now = 0;
  for (int i = 0; i < 6000; ++i) {
    const double next = wave_height(wave, pair, 60 + 0.01 * i);
    crests += now > 0.5 && now > before && now >= next;
    before = now, now = next;
  }
  EXPECT_EQ(crests, 3);
}

TEST(ForceWave, AtTheVeryBeginningNothingPulls) {
  const BentTube tube;
  const ForceWaveModel wave = build(tube.waves(), tube.rest, tube.volume);
  const std::vector<NodeState> rows = states(tube.rest);
  const NodeView nodes{rows, tube.row, {}};
  EXPECT_EQ(sums(wave, nodes, 0).size, 0);
  EXPECT_LT(sums(wave, nodes, 0.001).size, 1e-5);
}

TEST(ForceWave, ALineThatNoWallLiesAroundIsRefused) {
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  for (Vec3d& p : d.centreline) p += Vec3d{0, 0, 0.050};
  EXPECT_THROW(build(d, tube.rest, tube.volume), std::invalid_argument);
  d = tube.waves();
  d.stations[0].pressure = 0;
  EXPECT_THROW(build(d, tube.rest, tube.volume), std::invalid_argument);
}

}  // namespace
