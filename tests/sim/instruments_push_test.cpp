// Instruments that push each other aside, in scenes that ask for it.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/collision/rods.hpp>

#include "small_scene.hpp"

namespace trocar::sim {
namespace {

constexpr int kLeft = 1, kRight = 2;

const Model& model(bool push) {
  const auto made = [](bool on) {
    scene::Description d = small::description();
    d.instruments_push = on;
    return scene::compile(d);
  };
  static const Model with = made(true), without = made(false);
  return push ? with : without;
}

double overlap(const Model& m, const State& s) {
  const auto shape = [&](size_t t) {
    return interactions::shape_of(m.tool(s, t), s.tools[t].pose(), s.tools[t].aperture);
  };
  const interactions::ToolShape a = shape(kLeft), b = shape(kRight);
  double most = -1;
  for (const collision::Capsule& p : a.part)
    for (const collision::Capsule& q : b.part) {
      Vec3f side{};
      most = std::max(most, collision::touch(p, q, side).depth);
    }
  return most;
}

struct Met {
  double overlap = -1;           ///< deepest [m]
  double unequal = 0, most = 0;  ///< of forces across [N]
  double crossed = 0;            ///< how far one tip is beyond the other at the end [m]
};

/// High above everything two shafts that cross each other, seen from the side, go against each other and press on.
Met meet(bool push, double speed) {
  const Model& m = model(push);
  State s = initial_state(m);
  Work w = make_work(m);
  Input in = m.start;
  const Vec3d pa = m.hands[kLeft].port, pb = m.hands[kRight].port, middle = 0.5 * (pa + pb) + Vec3d{0, 0, -0.055};
  const Vec3d way{1, 0, 0}, over{0, pa.y > 0 ? -0.02 : 0.02, 0};
  Met met;
  double at = -0.03;
  for (int t = 0; t < 3000; ++t) {
    if (t > 500) at = std::min(at + speed * kTick, 0.015);
    in.tools[kLeft] = tool_input(kinematics::inverse(pa, middle + at * way + over, 0), 1);
    in.tools[kRight] = tool_input(kinematics::inverse(pb, middle - at * way - over, 0), 1);
    step(m, in, s, w);
    met.overlap = std::max(met.overlap, overlap(m, s));
    const double(&f)[3] = s.tools[kLeft].contact_force;
    const double(&g)[3] = s.tools[kRight].contact_force;
    const Vec3d sum{f[0] + g[0], f[1] + g[1], f[2] + g[2]};
    met.unequal = std::max(met.unequal, length(sum));
    met.most = std::max(met.most, length(Vec3d{f[0], f[1], f[2]}));
  }
  const auto tip = [&](size_t t) { return kinematics::forward(m.hands[t].port, s.tools[t].pose()).tip; };
  met.crossed = dot(tip(kLeft) - tip(kRight), way);
  return met;
}

TEST(InstrumentsPush, WhereTheSceneAsksForItNeitherGetsThroughTheOtherAndBothFeelTheSame) {
  for (const double speed : {0.02, 0.2, 0.5}) {
    const Met met = meet(true, speed);
    std::printf("    %.2f m/s: overlap %.3f mm, most %.1f N\n", speed, 1e3 * met.overlap, met.most);
    EXPECT_LT(met.overlap, 0.0003) << speed;
    EXPECT_LT(met.crossed, 0.006) << speed;
    EXPECT_GT(met.most, 1) << speed;
    EXPECT_LE(met.most, 15.001) << speed;
    EXPECT_LT(met.unequal, 1e-9) << speed;
  }
}

TEST(InstrumentsPush, WhereItDoesNotTheyPassAndFeelNothing) {
  const Met met = meet(false, 0.2);
  EXPECT_GT(met.overlap, 0.001);
  EXPECT_GT(met.crossed, 0.02);
  EXPECT_EQ(met.most, 0);
}

TEST(InstrumentsPush, ScenesThatDoNotAskKeepTheHashThatTheyHad) {
  EXPECT_NE(model(true).hash, model(false).hash);
  EXPECT_EQ(model(false).hash, small::model().hash);
}

}  // namespace
}  // namespace trocar::sim
