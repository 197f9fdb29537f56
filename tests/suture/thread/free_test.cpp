// A thread that touches nothing: hangs, stands, bends and falls as a rod does.
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/core/poison.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/suture/thread/thread.hpp>

#include "figures.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

ThreadStuff elastic(const char* size, const char* make) {
  ThreadStuff stuff = find_thread(size, make)->stuff;
  stuff.yield_curvature = 0;
  return stuff;
}

std::vector<Vec3d> straight(Vec3d from, Vec3d direction, double length) { return {from, from + length * direction}; }

// K1
TEST(Thread, HangsInACatenary) {
  ThreadStuff stuff = elastic("3-0", "silk");
  stuff.bend = 1e-12, stuff.twist = 1e-12;
  const double length_of = 0.15, span = 0.1;
  const ThreadModel m = build({.stuff = stuff, .length = length_of, .drag = 10});
  std::vector<Vec3d> path;
  for (int i = 0; i <= 200; ++i) {
    const double u = i / 200.0;
    path.push_back({span * u, 0, -0.2 * u * (1 - u)});
  }
  ThreadState s = laid(m, path);
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  holds[1].x = {span, 0, 0};
  HoldReaction pulls[2];
  for (int k = 0; k < 3000; ++k) advance(m, {.holds = holds}, {.holds = pulls}, s, w);
  double low = 1e-3, high = 1;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high);
    (2 * a * std::sinh(0.5 * span / a) > length_of ? low : high) = a;
  }
  expect_ratio("K1, sag of a catenary", -s.x[m.nodes / 2].z, low * (std::cosh(0.5 * span / low) - 1), 0.01);
  expect_ratio("K1, its horizontal pull", pulls[0].force.x, stuff.mass * 9.81 * low, 0.01);
}

/// Bessel's function J0, by its series; z up to some units.
double bessel_j0(double z) {
  double sum = 0, term = 1;
  for (int k = 1; k < 20; ++k) sum += term, term *= -0.25 * z * z / (k * k);
  return sum;
}

// J 12
TEST(Thread, AHangingChainSwingsAtItsFirstFrequency) {
  ThreadStuff stuff = elastic("3-0", "silk");
  stuff.bend = 1e-12, stuff.twist = 1e-12;
  const ThreadModel m = build({.stuff = stuff, .length = 0.15, .drag = 0});
  ThreadState s = laid(m, straight({}, {0, 0, -1}, m.length));
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0);
  const Hold holds[1] = {};
  // about its first shape, J0(2.4048 sqrt(1 - depth / length))
  for (int i = 0; i < m.nodes; ++i) s.x[i].x += 0.002 * bessel_j0(2.4048 * std::sqrt(1 - double(i) / (m.nodes - 1)));
  std::vector<double> crossings;  // [s]
  double before = s.x[m.nodes - 1].x;
  for (int k = 1; k <= 3000; ++k) {
    advance(m, {.holds = holds}, {}, s, w);
    const double now = s.x[m.nodes - 1].x;
    if ((before > 0) != (now > 0)) crossings.push_back(1e-3 * (k - now / (now - before)));
    before = now;
  }
  ASSERT_GE(crossings.size(), 6u);
  const double omega = portable::pi * double(crossings.size() - 1) / (crossings.back() - crossings.front());
  expect_ratio("J12, frequency of a hanging chain", omega, 1.2024 * std::sqrt(9.81 / m.length), 0.02);
}

// J 15: not inextensible, but stretched by T / EA.
TEST(Thread, FiveNewtonStretchItByItsOwnStiffness) {
  for (const auto& [size, make] : {std::pair{"3-0", "PDS"}, std::pair{"2-0", "silk"}}) {
    const ThreadStuff stuff = elastic(size, make);
    const ThreadModel m = build({.stuff = stuff, .length = 0.15, .gravity = {}});
    ThreadState s = laid(m, straight({}, {1, 0, 0}, m.length));
    ThreadWork w = make_work(m);
    take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
    Hold holds[2];
    holds[1].x = s.x[m.nodes - 1];
    HoldReaction pulls[2];
    for (int k = 0; k < 4000 && pulls[0].force.x < 5; ++k) {
      holds[1].x.x += 1e-5;
      advance(m, {.holds = holds}, {.holds = pulls}, s, w);
    }
    for (int k = 0; k < 300; ++k) advance(m, {.holds = holds}, {.holds = pulls}, s, w);
    ASSERT_NEAR(pulls[0].force.x, 5, 0.2);
    const double strain = (s.x[m.nodes - 1].x - s.x[0].x) / m.length - 1;
    std::printf("%s %s: %.2f %% at %.2f N\n", size, make, 100 * strain, pulls[0].force.x);
    expect_ratio("J15, strain over T / EA", strain, pulls[0].force.x / stuff.stretch, 0.01);
  }
}

/// Stands on its clamped lower end, pushed aside a little; how far its tip is off after a while, over before.
double lean_growth(double share_of_critical) {
  const ThreadStuff stuff = elastic("3-0", "PDS");
  const double critical = std::cbrt(7.837 * stuff.bend / (stuff.mass * 9.81));
  const int elements = 80;
  const double free = share_of_critical * critical;
  const double spacing = free / (elements - 0.5);  // the clamp holds the first element's direction
  const ThreadModel m = build({.stuff = stuff, .length = elements * spacing, .spacing = spacing, .drag = 20});
  ThreadState s = laid(m, straight({}, {0, 0, 1}, 1));
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0);
  const Hold hold[1] = {{.direction = {0, 0, 1}}};
  for (int i = 0; i < m.nodes; ++i) s.x[i].x += 1e-4 * std::pow(double(i) / m.nodes, 2);
  const auto lean = [&] { return std::fabs(s.x[m.nodes - 1].x); };
  for (int k = 0; k < 400; ++k) advance(m, {.holds = hold}, {}, s, w);
  const double before = lean();
  for (int k = 0; k < 4000; ++k) advance(m, {.holds = hold}, {}, s, w);
  return lean() / before;
}

TEST(Thread, StandsUpToGreenhillsLengthAndFallsBeyond) {
  say("K1, Greenhill: lean grows by, at 0.97 of the length", lean_growth(0.97), "below 1");
  say("K1, Greenhill: lean grows by, at 1.03 of the length", lean_growth(1.03), "above 1");
  EXPECT_LT(lean_growth(0.97), 1);
  EXPECT_GT(lean_growth(1.03), 1);
}

/// Tip of a heavy elastica that is clamped level: EI theta'' = q (L - s) cos theta, by shooting.
Vec3d heavy_tip(double length_of, double bend, double weight) {
  const int n = 20000;
  const auto end = [&](double start, Vec3d* tip) {
    double theta = 0, curvature = start;
    Vec3d x{};
    const double h = length_of / n;
    for (int i = 0; i < n; ++i) {
      const double s = (i + 0.5) * h, middle = theta + 0.5 * h * curvature;
      curvature += h * weight * (length_of - s) * std::cos(middle) / bend;
      const double next = middle + 0.5 * h * curvature;
      x += h * Vec3d{std::cos(middle), 0, std::sin(middle)};
      theta = next;
    }
    if (tip) *tip = x;
    return curvature;
  };
  double low = -400, high = 0;
  for (int i = 0; i < 80; ++i) {
    const double a = 0.5 * (low + high);
    (end(a, nullptr) > 0 ? high : low) = a;
  }
  Vec3d tip;
  end(0.5 * (low + high), &tip);
  return tip;
}

TEST(Thread, AHeavyCantileverHangsAsTheElasticaSays) {
  const ThreadStuff stuff = elastic("3-0", "PDS");
  for (const double length_of : {0.05, 0.1, 0.15}) {
    const ThreadModel m = build({.stuff = stuff, .length = length_of, .drag = 20});
    ThreadState s = laid(m, straight({}, {1, 0, 0}, 1));
    ThreadWork w = make_work(m);
    take_hold(m, s, 0, 0);
    const Hold hold[1] = {{.direction = {1, 0, 0}}};
    for (int k = 0; k < 3000; ++k) advance(m, {.holds = hold}, {}, s, w);
    const Vec3d tip = heavy_tip(length_of, stuff.bend, stuff.mass * 9.81);
    const double off = length(s.x[m.nodes - 1] - tip) / length_of;
    say("K1, heavy cantilever of " + std::to_string(int(1000 * length_of)) + " mm: tip off, share of length", off,
        "allowed 0.05");
    EXPECT_LE(off, 0.05);
  }
}

// K2
TEST(Thread, ASlingWithItsEndsTogetherHasTheElasticasShape) {
  const ThreadStuff stuff = elastic("3-0", "PDS");
  const ThreadModel m = build({.stuff = stuff, .length = 0.15, .gravity = {0, 0, 0}, .drag = 50});
  const double apart = 1.05 * stuff.diameter;
  std::vector<Vec3d> path;
  for (int i = 0; i <= 400; ++i) {
    const double angle = 2 * 3.14159265358979 * i / 400;
    path.push_back({-0.0239 * std::sin(angle), 0.0239 * (1 - std::cos(angle)), 0});
  }
  ThreadState s = laid(m, path);
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  holds[0] = {.x = {-0.5 * apart, 0, 0}, .direction = {0, 1, 0}};
  holds[1] = {.x = {0.5 * apart, 0, 0}, .direction = {0, -1, 0}};
  for (int k = 0; k < 4000; ++k) advance(m, {.holds = holds}, {}, s, w);
  double height = 0, left = 0, right = 0;
  for (const Vec3d& x : s.x) {
    height = std::max(height, x.y);
    left = std::min(left, x.x), right = std::max(right, x.x);
  }
  const int middle = m.nodes / 2;
  const Vec3d bend = (1 / (m.spacing * m.spacing)) * (s.x[middle - 1] - 2.0 * s.x[middle] + s.x[middle + 1]);
  expect_ratio("K2, height of a sling over its length", height / m.length, 0.4243, 0.01);
  expect_ratio("K2, width", (right - left) / m.length, 0.2042, 0.01);
  expect_ratio("K2, curvature at its apex", length(bend) * m.length, 10.77, 0.01);
}

// K3. At the thread's own stiffness and a tick of 1 ms a fold that runs is damped by the step (docs/science/thread.md):
// this is the motion that the equations tend to.
TEST(Thread, AFoldedChainFallsFasterThanFreely) {
  ThreadStuff stuff = elastic("3-0", "silk");
  stuff.bend = 1e-13, stuff.twist = 1e-13, stuff.stretch = 0.1, stuff.diameter = 2e-5;
  const double total = 0.15;
  const ThreadModel m = build({.stuff = stuff, .length = total, .spacing = 4.5e-4, .tick = 2e-5, .drag = 0});
  const double apart = 6 * m.spacing;
  ThreadState s = laid(
      m,
      std::vector<Vec3d>{{0, 0, 0}, {0, 0, -0.5 * (total - apart)}, {apart, 0, -0.5 * (total - apart)}, {apart, 0, 1}});
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  const Vec3d top = s.x[m.nodes - 1];
  holds[1].x = top;
  for (int k = 0; k < 10000; ++k) advance(m, {.holds = holds}, {}, s, w);
  release_hold(s, 1);
  double worst = 0;
  for (int k = 0; k < 20000; ++k) {
    advance(m, {.holds = {holds, 1}}, {}, s, w);
    const double x = top.z - s.x[m.nodes - 1].z, v = -s.v[m.nodes - 1].z;
    if (x > 0.8 * total) break;
    if (x > 0.05 * total)
      worst = std::max(worst, std::fabs(v / std::sqrt(9.81 * x * (2 * total - x) / (total - x)) - 1));
  }
  expect_between("K3, folded chain: speed of its end off by at most, to 0.8 L", worst, 0, 0.07);
}

TEST(Thread, ScratchMayBeLostBetweenTicksAndTheSameTicksGiveTheSameBits) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.08});
  ThreadState s = laid(m, straight({}, {1, 0, 0}, 1));
  take_hold(m, s, 0, 0);
  ThreadState other = s;
  ThreadWork w = make_work(m), spoilt = make_work(m);
  for (int k = 0; k < 50; ++k) {
    const Hold hold[1] = {{.x = {1e-4 * k, 2e-5 * k, 0}}};
    advance(m, {.holds = hold}, {}, s, w);
    core::poison_fields(spoilt);
    advance(m, {.holds = hold}, {}, other, spoilt);
  }
  core::Hasher one, two;
  add_to_hash(one, s), add_to_hash(two, other);
  EXPECT_EQ(one.value(), two.value());
}

TEST(Thread, LaidBackwardsInAHoldTurnsRoundToItsDirection) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.05});
  ThreadState s = laid(m, straight({}, {1, 0, 0}, 1));
  take_hold(m, s, 0, 0);
  ThreadWork w = make_work(m);
  const Hold hold[1] = {{.direction = {-1, 0, 0}}};
  for (int k = 0; k < 200; ++k) advance(m, {.holds = hold}, {}, s, w);
  EXPECT_LT(normalised(s.x[1] - s.x[0]).x, -0.98);
}

TEST(Thread, RefusesWhatIsNotANumberAndStaysAsItWas) {
  const ThreadModel m = build({.stuff = find_thread("3-0", "PDS")->stuff, .length = 0.05});
  ThreadState s = laid(m, straight({}, {1, 0, 0}, 1));
  take_hold(m, s, 0, 0);
  ThreadWork w = make_work(m);
  const Hold hold[1] = {{.x = {std::nan(""), 0, 0}}};
  const Vec3d before = s.x[5];
  EXPECT_EQ(advance(m, {.holds = hold}, {}, s, w).flags, std::uint32_t(ThreadReport::kNonFinite));
  EXPECT_EQ(s.x[5], before);
}

}  // namespace
