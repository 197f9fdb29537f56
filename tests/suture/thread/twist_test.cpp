// Twist: rods that are twisted leave their plane where theory says.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/suture/thread/thread.hpp>

#include "figures.hpp"

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

namespace {

constexpr double kPi = 3.14159265358979;

ThreadStuff elastic_pds() {
  ThreadStuff stuff = find_thread("3-0", "PDS")->stuff;
  stuff.yield_curvature = 0;
  return stuff;
}

Vec3d round(Vec3d axis, Vec3d side, double angle) {
  return std::cos(angle) * side + std::sin(angle) * cross(axis, side);
}

/// A ring closed by two holds, twisted by `angle`, bent out of its plane a little: does it go on, and lose its twist?
bool ring_leaves(double angle) {
  const ThreadStuff stuff = elastic_pds();
  const double total = 0.09;
  const ThreadModel m = build({.stuff = stuff, .length = total, .gravity = {0, 0, 0}, .drag = 20, .most_solves = 16});
  const double gap = 1.3 * stuff.diameter, radius = (total + gap) / (2 * kPi);
  std::vector<Vec3d> path;
  for (int i = 0; i <= 2000; ++i) {
    const double a = gap / radius / 2 + (2 * kPi - gap / radius) * i / 2000;
    path.push_back({radius * std::cos(a), radius * std::sin(a), 0});
  }
  ThreadState s = laid(m, path);
  ThreadWork w = make_work(m);
  take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
  Hold holds[2];
  const int last = m.nodes - 2;
  const Vec3d t0 = normalised(s.x[1] - s.x[0]), t1 = normalised(s.x[last + 1] - s.x[last]);
  const Vec3d d0 = s.director[0], d1 = s.director[last];
  holds[0] = {.x = s.x[0], .direction = t0, .side = d0};
  holds[1] = {.x = s.x[last + 1], .direction = t1, .side = d1};
  const int twisting = int(100 * angle);
  for (int k = 1; k <= twisting; ++k) {
    holds[1].side = round(t1, d1, angle * k / twisting);
    advance(m, {.holds = holds}, {}, s, w);
    for (Vec3d& x : s.x) x.z = 0;  // kept plane while it is twisted
    for (Vec3d& v : s.v) v.z = 0;
  }
  for (int i = 0; i < m.nodes; ++i) s.x[i].z = 1e-5 * std::sin(2 * 2 * kPi * i / m.nodes);
  for (int k = 0; k < 1000; ++k) advance(m, {.holds = holds}, {}, s, w);
  double left = 0;
  for (const double twist : s.twist) left += twist;
  return left < 0.7 * angle;
}

// K8
TEST(ThreadTwist, ARingLeavesItsPlaneAtMichellsTwist) {
  const ThreadStuff stuff = elastic_pds();
  const double critical = 2 * kPi * std::sqrt(3.0) * stuff.bend / stuff.twist;
  double low = 0.8, high = 1.2;
  for (int i = 0; i < 5; ++i) {
    const double share = 0.5 * (low + high);
    (ring_leaves(share * critical) ? high : low) = share;
  }
  expect_ratio("K8, twist at which a ring buckles", 0.5 * (low + high), 1, 0.03);
}

// K9. A rod twisted beyond what its tension keeps straight coils, which tightens it between its fixed ends until the
// tension is again the one that its moment asks for.
TEST(ThreadTwist, ATautRodCoilsUntilItsMomentIsTwiceTheRootOfItsStiffnessAndTension) {
  const ThreadStuff stuff = elastic_pds();
  for (const double beyond : {1.2, 1.6}) {
    const double tension_before = 0.01;
    const ThreadModel m = build({.stuff = stuff, .length = 0.1, .gravity = {0, 0, 0}, .drag = 20});
    ThreadState s = laid(m, std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}});
    ThreadWork w = make_work(m);
    take_hold(m, s, 0, 0), take_hold(m, s, 1, m.length);
    Hold holds[2];
    const double angle = beyond * 2 * std::sqrt(stuff.bend * tension_before) * m.length / stuff.twist;
    const Vec3d d = s.director[0];
    holds[0] = {.x = {0, 0, 0}, .direction = {1, 0, 0}, .side = d};
    holds[1] = {.x = {m.length * (1 + tension_before / stuff.stretch), 0, 0}, .direction = {1, 0, 0}, .side = d};
    const int twisting = int(60 * angle);
    for (int k = 1; k <= twisting; ++k) {
      holds[1].side = round({1, 0, 0}, d, angle * k / twisting);
      advance(m, {.holds = holds}, {}, s, w);
    }
    for (int i = 1; i + 1 < m.nodes; ++i)
      s.x[i].y += 1e-6 * std::sin(kPi * i / m.nodes) * std::cos(std::sqrt(tension_before / stuff.bend) * i * m.spacing);
    for (int k = 0; k < 1500; ++k) advance(m, {.holds = holds}, {}, s, w);
    double twist = 0, pull = 0;
    for (int i = 1; i + 1 < m.nodes; ++i) twist += s.twist[i];
    for (int e = 0; e + 1 < m.nodes; ++e) pull += tension(m, s, e) / (m.nodes - 1);
    const double moment = twist * stuff.twist / m.length;
    EXPECT_GT(pull, 1.2 * tension_before);
    expect_ratio("K9, moment of a coiled rod, wound to " + std::to_string(beyond) + " of its own", moment,
                 2 * std::sqrt(stuff.bend * pull), 0.03);
  }
}

}  // namespace
