// Knots: what pulls them tight, what they hold, and that they hold by themselves.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "figures.hpp"
#include "tying.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

constexpr double kPi = 3.14159265358979;

/// Complete elliptic integrals of the parameter m, by the arithmetic-geometric mean.
void elliptic(double m, double& k, double& e) {
  double a = 1, b = std::sqrt(1 - m), c = std::sqrt(m), sum = 0.5 * c * c, power = 1;
  for (int i = 0; i < 40 && c > 1e-17; ++i) {
    const double next = 0.5 * (a + b);
    c = 0.5 * (a - b);
    b = std::sqrt(a * b);
    a = next;
    sum += power * c * c;
    power *= 2;
  }
  k = kPi / (2 * a);
  e = k * (1 - sum);
}

struct PulledKnot {
  double pull = 0;        ///< mean of the measuring time [N]
  double radius = 0;      ///< least, of circles through nodes 4 spacings apart [m]
  double shortening = 0;  ///< thread that is in the knot, over the distance of its ends [m]
  double gap = 0;         ///< least distance of axes, in diameters
};

/// An overhand knot of `turns`, both ends drawn apart; measured where its ends come `shortenings` [m] nearer than the
/// thread is long.
std::vector<PulledKnot> pull_knot(int turns, double friction, const std::vector<double>& shortenings, double speed) {
  ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  stuff.yield_curvature = 0;
  stuff.friction_thread = friction;
  const ThreadModel m = build({.stuff = stuff, .length = 0.15, .gravity = {0, 0, 0}, .most_solves = 32});
  ThreadState s = laid(m, laid_overhand(turns, m.length, 0.012, stuff.diameter));
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  HoldReaction pulls[2];
  holds[0].x = s.x.front(), holds[1].x = s.x.back();
  for (int k = 0; k < 300; ++k) advance(m, {.holds = holds}, {}, s, w);
  std::vector<PulledKnot> found;
  for (const double wanted : shortenings) {
    const double window = 1e-3;  // of shortening, over which the pull is averaged
    double sum = 0;
    int count = 0;
    ThreadReport report;
    for (int k = 0; k < 20000; ++k) {
      const double shortening = m.length - length(holds[1].x - holds[0].x);
      if (shortening <= wanted - 0.5 * window) break;
      holds[0].x.x += speed * m.tick, holds[1].x.x -= speed * m.tick;
      report = advance(m, {.holds = holds}, {.holds = pulls}, s, w);
      if (shortening <= wanted + 0.5 * window) sum += std::fabs(pulls[0].force.x), ++count;
    }
    PulledKnot knot{.pull = sum / count, .radius = 1, .shortening = wanted, .gap = 2};
    for (int i = 4; i + 4 < m.nodes; ++i) {
      const Vec3d a = s.x[i - 4], b = s.x[i], c = s.x[i + 4];
      const double area = 0.5 * length(cross(b - a, c - a));
      knot.radius = std::min(knot.radius, length(b - c) * length(a - c) * length(a - b) / (4 * area + 1e-30));
    }
    for (int k = 0; k < report.contacts; ++k) {
      const Touch& q = w.self[k];
      const Vec3d p = (1 - q.s) * s.x[q.a] + q.s * s.x[q.a + 1] - (1 - q.t) * s.x[q.b] - q.t * s.x[q.b + 1];
      knot.gap = std::min(knot.gap, length(p) / stuff.diameter);
    }
    found.push_back(knot);
  }
  return found;
}

// K6
TEST(ThreadKnots, AnOverhandKnotPullsAsItsLoopAndItsFrictionSay) {
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const double h = 0.5 * stuff.diameter;
  for (const double friction : {0.1, 0.2, 0.3})
    for (const PulledKnot& knot : pull_knot(1, friction, {0.04, 0.03, 0.024}, 0.02)) {
      const double epsilon = std::sqrt(h / knot.radius);
      const double law = std::pow(epsilon, 4) / 2 + 0.492 * friction * std::pow(epsilon, 3);
      const double ratio = knot.pull * h * h / stuff.bend / law;
      char what[80];
      std::snprintf(what, sizeof what, "K6, overhand, friction %.1f, R/h = %.0f: pull over law", friction,
                    knot.radius / h);
      expect_between(what, ratio, 0.75, 1.33);
      EXPECT_GT(knot.gap, 0.8);
    }
}

// K7
TEST(ThreadKnots, OverhandKnotsOfSeveralTurnsPullAsTheirBraidSays) {
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const double h = 0.5 * stuff.diameter, friction = 0.1;
  for (const int turns : {2, 3, 4})
    for (const PulledKnot& knot : pull_knot(turns, friction, {0.05, 0.04}, 0.01)) {
      double low = 1e-6, high = 1 - 1e-9, x = 0;
      for (int i = 0; i < 200; ++i) {
        const double mean = 0.5 * (low + high);
        double k, e;
        elliptic(mean, k, e);
        x = 8 * (k - e) / mean - 4 * k;
        const double found = x * x / (x + 4 * k) / (8 * std::sqrt(3.0) * kPi * kPi);
        (found > turns * turns * h / knot.shortening ? high : low) = mean;
      }
      const double law = friction * x * x * x / (96 * std::sqrt(3.0) * kPi * kPi);
      const double ratio = turns * turns * knot.pull * h * h / stuff.bend / law;
      char what[96];
      std::snprintf(what, sizeof what, "K7, %d turns, %.0f mm in the knot: pull over law", turns,
                    1000 * knot.shortening);
      expect_between(what, ratio, 0.84, 1.22);
    }
}

struct Loaded {
  double most = 0;  ///< force that the loop bore until it opened, or what was asked for [N]
  double kept = 0;  ///< opening in the time it was kept [m]
  double slipped = 0;
};
/// Ties throws round a post, lets the tails go, and draws the loop open by two posts.
Loaded load(const char* make, std::vector<Throw> throws_, double tying, double force, int ticks, std::uint32_t* flags) {
  Tying rig({.stuff = find_thread("3-0", make)->stuff, .tension = tying, .gravity = {0, 0, 0}});
  rig.tie_throws(throws_);
  rig.let_go();
  rig.begin_loop();
  Loaded loaded;
  loaded.most = rig.draw_to(force, 0.02);
  const auto before = rig.knot_ends();
  if (loaded.most >= force) loaded.kept = rig.keep(force, ticks, 0.02);
  const auto after = rig.knot_ends();
  loaded.slipped = (std::abs(after.first - before.first) + std::abs(after.second - before.second)) * rig.m.spacing;
  if (flags) *flags = rig.flags;
  return loaded;
}

// K12
TEST(ThreadKnots, AReefKnotHoldsFiveNewtonAndAGrannySlipsMore) {
  for (const char* make : {"PDS", "silk"}) {
    std::uint32_t flags = 0;
    const Loaded reef = load(make, {{1, 1}, {1, -1}}, 2, 5, 3000, &flags);
    const Loaded granny = load(make, {{1, 1}, {1, 1}}, 2, 5, 3000, nullptr);
    say(std::string("K12, reef of ") + make + ": opens at 5 N in 3 s [mm]", 1000 * reef.kept, "allowed 1");
    say(std::string("K12, granny of ") + make + ": opens at 5 N in 3 s [mm]", 1000 * granny.kept, "more");
    EXPECT_GE(reef.most, 5);
    EXPECT_LE(reef.kept, 1e-3);
    EXPECT_GT(granny.kept, reef.kept);
    EXPECT_EQ(flags & ThreadReport::kIndefinite, 0u);
  }
  const double reef = load("PDS", {{1, 1}, {1, -1}}, 2, 28, 0, nullptr).most;
  const double granny = load("PDS", {{1, 1}, {1, 1}}, 2, 28, 0, nullptr).most;
  say("K12, reef of PDS, tied with 2 N: bears at most [N]", reef, "28: did not open");
  say("K12, granny of PDS", granny, "less");
  EXPECT_LT(granny, 0.8 * reef);
}

// A surgeon's knot; what the same bears with its throws alike is told, not claimed: with a double throw first it holds,
// too.
TEST(ThreadKnots, ASurgeonsKnotHoldsFiveNewtonForThreeSeconds) {
  const std::vector<Throw> opposed{{2, 1}, {1, -1}, {1, 1}}, alike{{2, 1}, {1, 1}, {1, 1}};
  for (const char* make : {"PDS", "silk"}) {
    const Loaded square = load(make, opposed, 2, 5, 3000, nullptr), granny = load(make, alike, 2, 5, 3000, nullptr);
    say(std::string("surgeon's knot of ") + make + ", tied with 2 N: opens at 5 N in 3 s [mm]", 1000 * square.kept,
        "allowed 1");
    say("its ends are drawn into it by [mm]", 1000 * square.slipped, "allowed 1");
    say("of throws that are alike: opens by [mm]", 1000 * granny.kept, "no figure");
    EXPECT_GE(square.most, 5);
    EXPECT_LE(square.kept, 1e-3);
    EXPECT_LE(square.slipped, 1e-3);
  }
}

// K11: of its order, what is met. How far the forces themselves are from those of Koninckx et al. stands in
// docs/science/validation.md.
TEST(ThreadKnots, OpposedThrowsHoldMoreThanTurnsOfOneThrow) {
  for (const char* make : {"PDS", "silk"}) {
    const double single = load(make, {{1, 1}}, 8, 28, 0, nullptr).most;
    const double twice = load(make, {{2, 1}}, 8, 28, 0, nullptr).most;
    const double opposed = load(make, {{1, 1}, {1, -1}}, 8, 28, 0, nullptr).most;
    const std::string of = std::string("K11, ") + make + ", tied with 8 N: ";
    say(of + "single throw bears at most [N]", single, "no figure");
    say(of + "double throw", twice, "10 in braid, 7 in monofilament");
    say(of + "two opposed throws (28: did not open)", opposed, "28 and 18");
    EXPECT_LT(std::max(single, twice), 0.5 * opposed);
    EXPECT_GE(opposed, 18);
  }
}

// K13
TEST(ThreadKnots, AKnotOfThreeThrowsAtHalfItsLoadDoesNotCreep) {
  Tying rig({.stuff = find_thread("3-0", "PDS")->stuff, .tension = 3});
  const Throw throws_[] = {{1, 1}, {1, -1}, {1, 1}};
  rig.tie_throws(throws_);
  rig.let_go();
  rig.begin_loop();
  rig.draw_to(4, 0.02);
  while (rig.loop_force() > 2) rig.draw_loop(-0.002);  // down to half of that
  for (int k = 0; k < 3000; ++k) rig.tick();           // until the tails hang still
  const double before = rig.loop_force();
  const std::vector<Vec3d> x = rig.s.x;
  bool slept = false;
  for (int k = 0; k < 60000; ++k) slept = rig.tick().asleep || slept;
  double most = 0;
  for (int i = rig.knot_ends().first; i <= rig.knot_ends().second; ++i)
    most = std::max(most, length(rig.s.x[i] - x[i]));
  expect_between("K13, a knot at half its load for 60 s: moves by [um]", 1e6 * most, 0, 10);
  expect_ratio("K13, the force it keeps", rig.loop_force(), before, 0.001);
  EXPECT_TRUE(slept);
  // and it wakes
  const double asleep = rig.loop_force();
  for (int k = 0; k < 20; ++k) rig.draw_loop(0.002);
  EXPECT_GT(rig.loop_force(), asleep + 0.1);
  EXPECT_FALSE(rig.last.asleep);
}

/// Both ends drawn apart until it is overloaded.
struct Overloaded {
  double pull = 0;    ///< then [N]
  double beside = 1;  ///< how near thread lies there that is 5 diameters on along it [m]
};
Overloaded overload(const std::vector<Vec3d>& path) {
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const ThreadModel m = build({.stuff = stuff, .length = 0.15, .gravity = {0, 0, 0}, .most_solves = 32});
  ThreadState s = laid(m, path);
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  HoldReaction pulls[2];
  holds[0].x = s.x.front(), holds[1].x = s.x.back();
  for (int k = 0; k < 12000; ++k) {
    holds[0].x.x += 2e-5, holds[1].x.x -= 2e-5;
    const ThreadReport report = advance(m, {.holds = holds}, {.holds = pulls}, s, w);
    if (!(report.flags & ThreadReport::kOverloaded)) continue;
    Overloaded found{std::fabs(pulls[0].force.x), 1};
    const int at = place_at(m, report.weakest).element;
    for (int i = 0; i < m.nodes; ++i)
      if (std::abs(i - at) * m.spacing > 5 * stuff.diameter)
        found.beside = std::min(found.beside, length(s.x[i] - s.x[at]));
    return found;
  }
  return {};
}

TEST(ThreadKnots, AKnottedThreadIsOverloadedAtItsKnotPullAndInItsKnotAStraightOneAtItsOwn) {  // [knot pull]
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const Overloaded knotted = overload(laid_overhand(1, 0.15, 0.012, stuff.diameter));
  expect_ratio("pull that overloads an overhand knot, over the knot pull", knotted.pull, stuff.knotted_break_force,
               0.05);
  EXPECT_LT(knotted.beside, 2 * stuff.diameter) << "thread lies on thread there";
  const std::vector<Vec3d> path{{0.15, 0, 0}, {0, 0, 0}};  // as the other lies: its first end is drawn to +x
  const Overloaded straight = overload(path);
  expect_ratio("pull that overloads a straight thread, over its breaking force", straight.pull, stuff.break_force,
               0.05);
  EXPECT_GT(straight.beside, 4 * stuff.diameter);
}

/// A straight thread, tied to itself near its beginning, that is held at two places beyond and drawn apart there.
TEST(ThreadKnots, AKnotOutsideOfThePulledStretchWeakensNothing) {  // [knot pull]
  const ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  const ThreadModel m = build({.stuff = stuff, .length = 0.15, .gravity = {0, 0, 0}, .most_solves = 32});
  const std::vector<Vec3d> path{{0, 0, 0}, {0.15, 0, 0}};
  const auto overloads_at = [&](double held_from) {
    ThreadState s = laid(m, path);
    ThreadWork w = make_work(m);
    tie(m, s, 0, 0.010, 0.012);
    take_hold(m, s, 0, held_from), take_hold(m, s, 1, m.length);
    Hold holds[2];
    HoldReaction pulls[2];
    holds[0].x = {held_from, 0, 0}, holds[1].x = s.x.back();
    for (int k = 0; k < 12000; ++k) {
      holds[1].x.x += 2e-5;
      const ThreadReport report = advance(m, {.holds = holds}, {.holds = pulls}, s, w);
      if (report.flags & ThreadReport::kOverloaded) return std::fabs(pulls[1].force.x);
    }
    return 0.0;
  };
  expect_ratio("pull that overloads it beyond its knot, over its breaking force", overloads_at(0.05), stuff.break_force,
               0.05);
  expect_ratio("pull that overloads it with the knot in the pulled stretch, over the knot pull", overloads_at(0),
               stuff.knotted_break_force, 0.05);
}

}  // namespace
