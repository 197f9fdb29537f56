// Instruments push each other aside, in every scene.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/collision/rods.hpp>

#include "crossed_instruments.hpp"
#include "shipped.hpp"
#include "small_scene.hpp"

namespace trocar::sim {
namespace {

constexpr int kLeft = 1, kRight = 2;

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
Met meet(double speed) {
  const Model& m = small::model();
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

TEST(InstrumentsPush, NeitherGetsThroughTheOtherAndBothFeelTheSame) {
  for (const double speed : {0.02, 0.2, 0.5}) {
    const Met met = meet(speed);
    std::printf("    %.2f m/s: overlap %.3f mm, most %.1f N\n", speed, 1e3 * met.overlap, met.most);
    EXPECT_LT(met.overlap, 0.0003) << speed;
    EXPECT_LT(met.crossed, 0.006) << speed;
    EXPECT_GT(met.most, 1) << speed;
    EXPECT_LE(met.most, 15.001) << speed;
    EXPECT_LT(met.unequal, 1e-9) << speed;
  }
}

class CrossedInstruments : public testing::TestWithParam<const char*> {};

TEST_P(CrossedInstruments, OfAShippedSceneAreNeverDeeperThan1mmForLongerThan50ms) { expect_apart(shipped(GetParam())); }
INSTANTIATE_TEST_SUITE_P(Scenes, CrossedInstruments,
                         testing::Values("box_reach", "calot", "cholecystectomy_operation", "gynaecology", "bowel"),
                         [](const auto& scene) { return std::string(scene.param); });

// Where one is met next to its trocar and the other far from it, the near one hardly turns.
TEST(InstrumentsPush, OneThatIsMetNextToItsTrocarIsNotThrownAside) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  Input in = m.start;
  const Vec3d near = m.hands[kRight].port + Vec3d{0, 0, -0.02};  // 2 cm along a shaft that points straight down
  in.tools[kRight] = tool_input(kinematics::inverse(m.hands[kRight].port, near + Vec3d{0, 0, -0.10}, 0), 1);
  double fastest = 0, deepest = -1;
  Vec3d last = kinematics::forward(m.hands[kRight].port, s.tools[kRight].pose()).tip;
  for (int t = 0; t < 1500; ++t) {
    const double at = t < 700 ? 0.03 : std::max(-0.01, 0.03 - 0.0002 * (t - 700));
    const Vec3d port = m.hands[kLeft].port;
    const Vec3d over = near + Vec3d{at, 0, 0};
    in.tools[kLeft] = tool_input(kinematics::inverse(port, over + 0.02 * normalised(over - port), 0), 1);
    step(m, in, s, w);
    const Vec3d tip = kinematics::forward(m.hands[kRight].port, s.tools[kRight].pose()).tip;
    if (t > 700) fastest = std::max(fastest, length(tip - last));
    deepest = std::max(deepest, overlap(m, s));
    last = tip;
  }
  EXPECT_GT(deepest, -1e-4) << "they have not met";
  EXPECT_LT(deepest, 0.001);
  EXPECT_LT(fastest, 0.0012) << "[m] in a tick";
}

}  // namespace
}  // namespace trocar::sim
