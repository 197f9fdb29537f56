// Peristalsis as forces on a skin: what they add up to, where they act and when.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <trocar/geometry/frames.hpp>
#include <trocar/geometry/loft.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/tissue/force_wave.hpp>

using namespace trocar;
using namespace trocar::tissue;

namespace {

constexpr double kRadius = 0.012;

/// A tube bent by a quarter of a circle of 80 mm, as a skin whose vertices are its nodes.
struct BentTube {
  std::vector<Vec3d> line;
  Skin skin;

  BentTube() {
    std::vector<geometry::Section> sections;
    for (int i = 0; i <= 12; ++i) {
      const double angle = 0.5 * portable::pi * i / 12, c = portable::cos(angle), s = portable::sin(angle);
      line.push_back({0.080 * s, 0.080 * (1 - c), 0});
      sections.push_back({line.back(), {-kRadius * s, kRadius * c, 0}, {0, 0, kRadius}, 2});
    }
    const geometry::TriMesh mesh = geometry::tessellate(geometry::loft(sections), 0.004);
    skin.triangles = mesh.triangles;
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
      skin.weights.push_back(SkinWeights::at(int(i), int(i)));
      skin.rest.push_back(vec_cast<float>(mesh.positions[i]));
    }
    index_skin(skin);
  }

  ForceWaveDescription waves() const {
    ForceWaveDescription d;
    d.centreline = line;
    d.stations = {{0, 2000, 0.015}};
    d.period = 6;
    return d;
  }
};

struct Sums {
  Vec3d force{0, 0, 0}, moment{0, 0, 0};
  double size = 0, lever = 0;
};
Sums sums(const ForceWaveModel& wave, const Skin& skin, const std::vector<Vec3f>& now, double t) {
  std::vector<Vec3d> f(size_t(skin.size()), Vec3d{0, 0, 0});
  add_wave(wave, skin, now, t, f);
  Sums s;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3d x = vec_cast<double>(now[i]);
    s.force += f[i];
    s.moment += cross(x, f[i]);
    s.size += length(f[i]);
    s.lever += length(x) * length(f[i]);
  }
  return s;
}

TEST(ForceWave, ItsForcesAndTheirMomentSumToZeroHoweverTheOrganLies) {
  const BentTube tube;
  const ForceWaveModel wave = build(tube.waves(), tube.skin);
  std::vector<Vec3f> now = tube.skin.rest;
  for (Vec3f& p : now) p = {p.y * 1.3f + 0.01f, -p.x + 4 * p.z * p.z, p.z * 0.7f + 2 * p.x * p.y};
  for (const double t : {0.5, 4.0, 7.7, 30.0}) {
    const Sums s = sums(wave, tube.skin, now, t);
    EXPECT_GT(s.size, 0.01);
    EXPECT_LT(length(s.force), 1e-13 * s.size);
    EXPECT_LT(length(s.moment), 1e-12 * s.lever);
  }
}

TEST(ForceWave, TheyPullInwardsAcrossTheLumenAndNotAlongIt) {
  const BentTube tube;
  const ForceWaveModel wave = build(tube.waves(), tube.skin);
  std::vector<Vec3d> f(size_t(tube.skin.size()), Vec3d{0, 0, 0});
  add_wave(wave, tube.skin, tube.skin.rest, 7.0, f);
  double inwards = 0, along = 0, size = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3d p = vec_cast<double>(tube.skin.rest[i]);
    const Vec3d out_of_bend = normalised(p - Vec3d{0, 0.080, p.z});
    const Vec3d axis = Vec3d{0, 0.080, 0} + 0.080 * out_of_bend;
    if (!(length(f[i]) > 0) || p.x < 0.005 || p.y > 0.075) continue;
    inwards += dot(f[i], normalised(axis - p));
    along += std::fabs(dot(f[i], cross(out_of_bend, {0, 0, 1})));
    size += length(f[i]);
  }
  EXPECT_GT(inwards, 0.97 * size);
  EXPECT_LT(along, 0.15 * size);
}

TEST(ForceWave, ACrestPressesWithItsPressureOnTheWall) {
  // Of a straight piece between two planes through a broad wave: forces on one half add up to p times its shadow.
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  d.width = 1;  // flat over the whole tube
  d.period = 1e6;
  const ForceWaveModel wave = build(d, tube.skin);
  std::vector<Vec3d> f(size_t(tube.skin.size()), Vec3d{0, 0, 0});
  const double t = 4;
  add_wave(wave, tube.skin, tube.skin.rest, t, f);
  double down = 0;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3d p = vec_cast<double>(tube.skin.rest[i]);
    if (p.z > 0 && p.x > 0 && p.y < 0.080) down -= f[i].z;
  }
  const double shadow = 0.25 * portable::pi * ((0.092 * 0.092) - (0.068 * 0.068));
  EXPECT_NEAR(down / (2000 * shadow), 1, 0.05);
}

TEST(ForceWave, WithOneSpeedItIsTheGaussianOfWayMinusSpeedTimesTime) {
  const BentTube tube;
  const ForceWaveDescription d = tube.waves();
  const ForceWaveModel wave = build(d, tube.skin);
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
  const ForceWaveModel wave = build(d, tube.skin);
  ForceWaveDescription even = d;
  even.stations = {{0, 1000, 0.001}};  // its delays are the ways [mm/s]
  const ForceWaveModel ways = build(even, tube.skin);
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
  const ForceWaveModel wave = build(d, tube.skin);
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
  const ForceWaveModel wave = build(tube.waves(), tube.skin);
  EXPECT_EQ(sums(wave, tube.skin, tube.skin.rest, 0).size, 0);
  EXPECT_LT(sums(wave, tube.skin, tube.skin.rest, 0.001).size, 1e-5);
}

TEST(ForceWave, ALineThatNoWallLiesAroundIsRefused) {
  const BentTube tube;
  ForceWaveDescription d = tube.waves();
  for (Vec3d& p : d.centreline) p += Vec3d{0, 0, 0.050};
  EXPECT_THROW(build(d, tube.skin), std::invalid_argument);
  d = tube.waves();
  d.stations[0].pressure = 0;
  EXPECT_THROW(build(d, tube.skin), std::invalid_argument);
}

}  // namespace
