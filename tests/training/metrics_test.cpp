// Each metric on motions whose figure can be worked out by hand, and the properties that all of them must have.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <trocar/core/random.hpp>
#include <trocar/training/metrics/metrics_parts.hpp>

#include "traces.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

/// A smooth way from 0 to 1 in the time 0..1: the minimum-jerk movement.
double smooth_step(double u) {
  u = std::fmin(std::fmax(u, 0), 1);
  return u * u * u * (10 - 15 * u + 6 * u * u);
}

TraceSample at(Vec3d tip) {
  TraceSample s;
  s.tip = tip;
  return s;
}

/// One hand goes 0.2 m along `way` between 1 s and 3 s of 5 s; the other rests.
Trace reach(Vec3d way) {
  return traces::make(2, 5, [&](int hand, double t) {
    return at(hand == 0 ? 0.2 * smooth_step((t - 1) / 2) * normalised(way) : Vec3d{});
  });
}

/// Two hands wander, grip, pull.
Trace wander(std::uint64_t seed) {
  core::Random random(seed);
  std::array<double, 24> a{};
  for (double& v : a) v = random.uniform(-1, 1);
  return traces::make(2, 40, [&](int hand, double t) {
    const double* p = &a[std::size_t(hand) * 12];
    TraceSample s;
    const auto wave = [&](int i) { return p[i] * std::sin((0.7 + 0.3 * p[i + 3]) * t + p[i + 6]); };
    s.tip = {0.05 * wave(0), 0.03 * wave(1), 0.04 * wave(2) + 0.01 * std::sin(3 * t)};
    s.orientation = quat_from_rotation_vector(Vec3d{0.5 * wave(1), 0.4 * wave(2), 0.8 * wave(0)});
    s.pinch = std::fmax(0, 10 * wave(0));
    s.pull = {wave(0), 2 * wave(1), wave(2)};
    s.contact = t > 20 ? Vec3d{0, 0, 0.5} : Vec3d{};
    return s;
  });
}

/// Turned about an axis, moved, scaled.
Trace transformed(Trace trace, Quatd turn, Vec3d shift, double scale) {
  for (TraceHand& hand : trace.hands)
    for (TraceSample& s : hand.samples) {
      s.tip = scale * rotate(turn, s.tip) + shift;
      s.orientation = turn * s.orientation;
      s.pull = rotate(turn, s.pull);
      s.contact = rotate(turn, s.contact);
    }
  return trace;
}

}  // namespace

TEST(Metrics, AStraightReachHasItsLengthAndNoDetour) {
  MetricsOptions options;
  options.waypoints = {{{0, 0, 0}, {0.12, 0.16, 0}}};
  const Metrics m = metrics_of(reach({3, 4, 0}), options);
  EXPECT_NEAR(m.hands[0].path, 0.2, 3e-4) << "what lies before 5 mm/s is not counted";
  EXPECT_NEAR(m.hands[0].economy, 1, 2e-3);
  EXPECT_EQ(m.hands[0].movements, 1);
  EXPECT_NEAR(m.hands[0].peak_speed, 1.875 * 0.1, 1e-4);
  // With 5 % of the peak cut off at both ends, u = 0.0594 .. 0.9406: T^3 = 0.684, the integral is 420.6, peak^2 3.516.
  EXPECT_NEAR(m.hands[0].ldlj, -4.405, 0.02);
  EXPECT_LT(m.hands[1].path, 1e-12);
  EXPECT_EQ(m.both.path, m.hands[0].path + m.hands[1].path);
}

TEST(Metrics, EconomyOfAStraightLineAtConstantSpeedIsOne) {
  const Trace line = traces::make(1, 4, [](int, double t) { return at({0.02 * t, 0, 0}); });
  MetricsOptions options;
  options.waypoints = {{{0, 0, 0}, {0.08, 0, 0}}};
  EXPECT_NEAR(metrics_of(line, options).hands[0].economy, 1, 1e-5);
}

TEST(Metrics, TimeRunsFromTheFirstMotionToTheGivenEnd) {
  const Trace trace = reach({1, 0, 0});
  // 5 mm/s is reached 33 ms after the start: 0.1 m/s * 30 u^2 (1 - u)^2 = 0.005 at u = 0.0417, of 2 s.
  EXPECT_NEAR(metrics_of(trace).from, 1.083, 0.021);
  EXPECT_NEAR(metrics_of(trace).to, 5, 1e-9);
  MetricsOptions options;
  options.end = 2;
  const Metrics half = metrics_of(trace, options);
  EXPECT_NEAR(half.to, 2, 1e-9);
  EXPECT_NEAR(half.hands[0].path, 0.1, 3e-4);
  EXPECT_NEAR(half.time, half.to - half.from, 1e-12);
}

TEST(Metrics, WithoutMotionNothingIsClaimed) {
  const Trace still = traces::make(2, 3, [](int, double) { return at({0.1, 0, 0}); });
  const Metrics m = metrics_of(still);
  EXPECT_EQ(m.time, 0);
  EXPECT_TRUE(std::isnan(m.hands[0].sparc));
  const auto json = nlohmann::json::parse(metrics_json(m));
  EXPECT_TRUE(json["both"]["sparc"].is_null());
  EXPECT_TRUE(json["from_s"].is_null());
  EXPECT_NO_THROW(metrics_of(Trace{}));
  MetricsOptions before;
  before.end = -5;
  EXPECT_EQ(metrics_of(reach({1, 0, 0}), before).time, 0);
}

TEST(Metrics, OwnMarksMakeTheReference) {
  // Out along x, a clip there, back and up along y: the reference leads through the clip's place.
  Trace trace = traces::make(1, 8, [](int, double t) {
    return at({0.1 * (smooth_step(t / 2) - smooth_step((t - 3) / 2)), 0.05 * smooth_step((t - 5.5) / 2), 0});
  });
  EXPECT_TRUE(std::isnan(metrics_of(trace).hands[0].economy)) << "without marks there is no reference";
  trace.marks = {{TraceMark::clipped, 0, 125}};
  const Metrics m = metrics_of(trace);
  EXPECT_NEAR(m.hands[0].path, 0.25, 1e-3);
  EXPECT_NEAR(m.hands[0].reference, 0.1 + std::hypot(0.1, 0.05), 1e-3);
  EXPECT_NEAR(m.both.economy, m.hands[0].economy, 1e-12);
}

TEST(Metrics, DepthIsTravelAlongTheShaft) {
  // The shaft points along +x; the tip goes 0.1 m that way, then 0.05 m across.
  const Quatd turn = quat_from_two_vectors(Vec3d{0, 0, -1}, Vec3d{1, 0, 0});
  Trace trace = traces::make(1, 6, [&](int, double t) {
    TraceSample s = at({0.1 * smooth_step(t / 2), 0.05 * smooth_step((t - 3) / 2), 0});
    s.orientation = turn;
    return s;
  });
  EXPECT_NEAR(metrics_of(trace).hands[0].depth, 0.1, 4e-4);
  EXPECT_EQ(metrics_of(trace).hands[0].depth_reversals, 0);
  trace.hands[0].has_shaft = false;
  EXPECT_TRUE(std::isnan(metrics_of(trace).hands[0].depth));
}

TEST(Metrics, DepthReversalsCountTurnsOfMoreThanThreeMillimetres) {
  const Quatd turn = quat_from_two_vectors(Vec3d{0, 0, -1}, Vec3d{1, 0, 0});
  const auto swing = [&](double amplitude) {
    return traces::make(1, 10, [&](int, double t) {
      TraceSample s =
          at({0.05 - amplitude / 2 * std::cos(2 * std::numbers::pi * 0.5 * t) + 0.001 * std::sin(10 * t), 0, 0});
      s.orientation = turn;
      return s;
    });
  };
  EXPECT_EQ(metrics_of(swing(0.010)).hands[0].depth_reversals, 9) << "every second from 1 s to 9 s";
  EXPECT_LE(metrics_of(swing(0.0005)).hands[0].depth_reversals, 0);
  MetricsOptions options;
  options.targets = {{{0.055, 0.019, 0}}};
  EXPECT_EQ(metrics_of(swing(0.010), options).hands[0].depth_reversals_near, 5) << "the outer turns";
  options.targets = {{{0.065, 0.019, 0}}};
  EXPECT_EQ(metrics_of(swing(0.010), options).hands[0].depth_reversals_near, 0);
}

TEST(Metrics, ReversalsAreFoundAtTheTurningPoints) {
  const std::vector<double> axial{0, 1, 2, 5, 8, 7.5, 8.5, 6, 3, 4, 2, 7, 9};
  const std::vector<std::size_t> turns = reversals(axial, 3);
  ASSERT_EQ(turns.size(), 2u);
  EXPECT_EQ(turns[0], 6u);
  EXPECT_EQ(turns[1], 10u);
}

TEST(Metrics, AngularPathIsExactForSmallAndLargeTurns) {
  for (const double step : {1e-7, 1e-4, 0.1, 2.0}) {
    std::vector<Quatd> q;
    for (int i = 0; i <= 10; ++i) q.push_back(quat_from_axis_angle(Vec3d{1, -2, 0.5}, step * i));
    q[5] = -q[5];  // the same rotation
    EXPECT_NEAR(angular_path(q) / (10 * step), 1, 1e-7) << step;
  }
}

TEST(Metrics, MeanJerkOfTheMinimumJerkMovementIsItsClosedForm) {
  // p = L s(u): integral of p'''^2 du = 720 L^2, so the figure is sqrt(360) for any length and duration.
  for (const double seconds : {1.0, 4.0}) {
    std::vector<Vec3d> tip;
    const int n = 4000;
    for (int i = 0; i <= n; ++i) tip.push_back({0.3 * smooth_step(double(i) / n), 0, 0});
    EXPECT_NEAR(mean_jerk(tip, n / seconds), std::sqrt(360.0), 0.03);
  }
}

TEST(Metrics, IdleCountsRestsOfAtLeastASecondOfAllHands) {
  // Hand 0 moves 0-2 s and 6-8 s, hand 1 from 4 s on: both rest from 2 to 4 s, hand 0 from 2 to 6 s.
  const auto moving = [](int hand, double t) { return hand == 0 ? t < 2 || (t >= 6 && t < 8) : t >= 4; };
  std::array<double, 2> x{};
  const Trace trace = traces::make(2, 10, [&](int hand, double t) {
    if (t == 0) x[std::size_t(hand)] = 0;
    if (moving(hand, t)) x[std::size_t(hand)] += 0.001;
    return at({x[std::size_t(hand)], 0, 0});
  });
  const Metrics m = metrics_of(trace);
  EXPECT_NEAR(m.both.idle, 0.2, 0.03);
  EXPECT_NEAR(m.hands[0].idle, 0.6, 0.03);
  EXPECT_NEAR(m.hands[1].idle, 0.4, 0.03);
  EXPECT_NEAR(m.bimanual.simultaneous, 0.25, 0.03) << "2 s of the 8 s in which a hand moves";
}

TEST(Metrics, HandsThatMirrorEachOtherAreFullyBimanual) {
  const Trace trace = traces::make(2, 10, [](int hand, double t) {
    const double x = 0.05 * std::sin(t);
    return at({hand == 0 ? x : -2 * x, 0, 0});
  });
  const Metrics m = metrics_of(trace);
  EXPECT_NEAR(m.bimanual.ratio, 0.5, 1e-6);
  EXPECT_NEAR(m.bimanual.speed_correlation, 1, 1e-9);
  EXPECT_GT(m.bimanual.simultaneous, 0.9);
}

TEST(Metrics, TheTwoBusiestOfThreeHandsAreCompared) {
  const Trace trace = traces::make(3, 5, [](int hand, double t) {
    return at({0.01 * (hand + 1) * std::sin(t), 0, 0});
  });
  const Metrics m = metrics_of(trace);
  EXPECT_EQ(m.bimanual.left, 1);
  EXPECT_EQ(m.bimanual.right, 2);
  MetricsOptions options;
  options.pair = {0, 2};
  EXPECT_NEAR(metrics_of(trace, options).bimanual.ratio, 1.0 / 3, 1e-6);
}

TEST(Metrics, ForcesOfAKnownCourse) {
  std::vector<Vec3d> force(100, Vec3d{});
  for (std::size_t i = 20; i < 40; ++i) force[i] = {0, 3, 4};
  for (std::size_t i = 40; i < 50; ++i) force[i] = {1, 0, 0};
  const ForceMetrics m = force_metrics(force, 50, 4);
  EXPECT_DOUBLE_EQ(m.max, 5);
  EXPECT_NEAR(m.mean_nonzero, 110.0 / 30, 1e-12);
  EXPECT_NEAR(m.rms, std::sqrt(510.0 / 100), 1e-12);
  EXPECT_NEAR(m.impulse, 110.0 / 50, 1e-12);
  EXPECT_NEAR(m.above, 0.4, 1e-12);
  EXPECT_NEAR(m.volume, 0, 1e-4) << "all in one plane";
}

TEST(Metrics, ForceVolumeIsTheEllipsoidOfThreeDeviationsHoweverItLies) {
  std::vector<Vec3d> force;
  for (int i = 0; i < 8; ++i) force.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 2.0 : -2.0, i & 4 ? 0.5 : -0.5});
  const double expected = 4.0 / 3 * std::numbers::pi * 3 * 6 * 1.5;
  EXPECT_NEAR(force_metrics(force, 50, 4).volume, expected, 1e-9);
  const Quatd turn = quat_from_axis_angle(Vec3d{1, 2, 3}, 1.1);
  for (Vec3d& f : force) f = rotate(turn, f);
  EXPECT_NEAR(force_metrics(force, 50, 4).volume, expected, 1e-9);
}

TEST(Metrics, DoNotDependOnWhereThingsStand) {
  const Trace trace = wander(4);
  const Metrics a = metrics_of(trace),
                b = metrics_of(transformed(trace, quat_from_axis_angle(Vec3d{3, -1, 2}, 2.0), {1, -2, 0.5}, 1));
  for (std::size_t h = 0; h < 2; ++h) {
    EXPECT_NEAR(a.hands[h].path, b.hands[h].path, 1e-9);
    EXPECT_NEAR(a.hands[h].depth, b.hands[h].depth, 1e-9);
    EXPECT_NEAR(a.hands[h].angular_path, b.hands[h].angular_path, 1e-6);
    EXPECT_NEAR(a.hands[h].sparc, b.hands[h].sparc, 1e-6);
    EXPECT_NEAR(a.hands[h].ldlj, b.hands[h].ldlj, 1e-6);
    EXPECT_NEAR(a.hands[h].forces[kPull].volume, b.hands[h].forces[kPull].volume, 1e-6);
    EXPECT_NEAR(a.hands[h].forces[kContact].rms, b.hands[h].forces[kContact].rms, 1e-9);
  }
  EXPECT_EQ(a.time, b.time);
}

TEST(Metrics, LargerMotionsHaveLongerPathsAndTheSameSmoothness) {
  // The thresholds are absolute, so the window is kept the same by a motion that is fast from the first sample.
  const Trace trace = wander(5);
  const Metrics a = metrics_of(trace), b = metrics_of(transformed(trace, {}, {}, 3));
  ASSERT_EQ(a.from, b.from);
  for (std::size_t h = 0; h < 2; ++h) {
    EXPECT_NEAR(b.hands[h].path / a.hands[h].path, 3, 1e-9);
    EXPECT_NEAR(b.hands[h].mean_jerk, a.hands[h].mean_jerk, 1e-6 * a.hands[h].mean_jerk);
    EXPECT_NEAR(b.hands[h].sparc, a.hands[h].sparc, 1e-9);
    EXPECT_NEAR(b.hands[h].ldlj, a.hands[h].ldlj, 1e-9);
    EXPECT_EQ(b.hands[h].movements, a.hands[h].movements);
  }
  EXPECT_NEAR(a.bimanual.ratio, b.bimanual.ratio, 1e-9);
  EXPECT_NEAR(a.bimanual.speed_correlation, b.bimanual.speed_correlation, 1e-9);
}

TEST(Metrics, AreTheSameFromAStoredTrace) {
  Trace trace = wander(6);
  for (TraceHand& hand : trace.hands)
    for (TraceSample& s : hand.samples) s = rounded(s);
  trace.marks = {{TraceMark::grasped, 0, 400}, {TraceMark::clipped, 1, 1100}, {TraceMark::released, 0, 1500}};
  EXPECT_EQ(metrics_json(trace), metrics_json(trace_from_bytes(to_bytes(trace), "x")));
  EXPECT_EQ(metrics_json(trace), metrics_json(trace_from_csv(to_csv(trace), "x")));
  if (const char* folder = std::getenv("TROCAR_METRICS_SAMPLE")) {  // for tools/check_metrics.py
    std::ofstream(std::string(folder) + "/trace.csv") << to_csv(trace);
    std::ofstream(std::string(folder) + "/trace.json") << metrics_json(trace);
  }
}

/// An endoscope that rests for a second, then moves 60 mm and back while its picture tilts.
Trace endoscope() {
  Trace trace;
  for (int i = 0; i < 400; ++i) {
    const double t = std::max(0, i - 50) / 50.0;
    trace.scope.push_back(rounded(
        TraceScope{{0.06 * std::sin(0.5 * t), 0.01 * t, -0.1}, {0, 0, -1}, i % 7 == 0 ? 1000.0 : 8 * std::sin(t)}));
  }
  return trace;
}

TEST(Metrics, OfTheEndoscopeAreTheSameFromAStoredTrace) {
  const Trace trace = endoscope();
  EXPECT_EQ(metrics_json(trace), metrics_json(trace_from_bytes(to_bytes(trace), "x")));
  EXPECT_EQ(metrics_json(trace), metrics_json(trace_from_csv(to_csv(trace), "x")));
  if (const char* folder = std::getenv("TROCAR_METRICS_SAMPLE")) {
    std::ofstream(std::string(folder) + "/camera.csv") << to_csv(trace);
    std::ofstream(std::string(folder) + "/camera.json") << metrics_json(trace);
  }
}

TEST(Metrics, OfTheEndoscopeFollowItsPathItsHorizonAndItsTargets) {
  MetricsOptions options;
  options.camera = {0.4, 2, {3, 5}};
  const Metrics m = metrics_of(endoscope(), options);
  EXPECT_NEAR(m.from, 1, 0.1);
  EXPECT_GT(m.camera.path, 0.07);
  EXPECT_LT(m.camera.path, 0.2);
  EXPECT_NEAR(m.camera.horizon_mean, 8 * 2 / 3.14, 0.6);
  EXPECT_GT(m.camera.horizon_p95, 7.5);
  EXPECT_LE(m.camera.horizon_p95, 8);
  EXPECT_EQ(m.camera.on_target, 0.4);
  EXPECT_EQ(m.camera.lens_touches, 2);
  EXPECT_EQ(m.camera.target_mean, 4);
  EXPECT_EQ(m.camera.target_longest, 5);
  EXPECT_TRUE(m.hands.empty());
}

TEST(Metrics, WithoutAHorizonTheEndoscopeHasOnlyAPath) {
  Trace trace = endoscope();
  for (TraceScope& s : trace.scope) s.horizon = TraceScope::kNoHorizon;
  const Metrics m = metrics_of(trace);
  EXPECT_TRUE(std::isnan(m.camera.horizon_mean));
  EXPECT_TRUE(std::isnan(m.camera.horizon_p95));
  EXPECT_GT(m.camera.path, 0.07);
}

TEST(Metrics, SensorNoiseBarelyLengthensThePath) {
  Trace trace = reach({1, 0, 0});
  core::Random random(9);
  for (TraceSample& s : trace.hands[0].samples) s.tip.y += random.uniform(-1e-4, 1e-4);
  const double raw = [&] {
    std::vector<Vec3d> tip;
    for (const TraceSample& s : trace.hands[0].samples) tip.push_back(s.tip);
    return path_length(tip);
  }();
  EXPECT_GT(raw, 0.2 + 0.008);
  EXPECT_LT(metrics_of(trace).hands[0].path, 0.2 + 0.5 * (raw - 0.2));
}

TEST(Metrics, TotalsPoolTheHands) {
  const Metrics m = metrics_of(wander(7));
  EXPECT_NEAR(m.both.path, m.hands[0].path + m.hands[1].path, 1e-12);
  EXPECT_NEAR(m.both.forces[kPull].impulse, m.hands[0].forces[kPull].impulse + m.hands[1].forces[kPull].impulse, 1e-9);
  EXPECT_EQ(m.both.forces[kPull].max, std::max(m.hands[0].forces[kPull].max, m.hands[1].forces[kPull].max));
  EXPECT_NEAR(m.both.sparc,
              (m.hands[0].sparc * m.hands[0].movements + m.hands[1].sparc * m.hands[1].movements) / m.both.movements,
              1e-9);
  EXPECT_TRUE(std::isnan(m.hands[0].forces[kPinch].volume));
}
