// Nothing tunnels: instruments swept across strands and into organs, at the speed of the fastest hands and beyond it.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/nearest.hpp>

#include "../sim/small_scene.hpp"

using namespace trocar;
using namespace trocar::interactions;
using small::kGrasper;
using small::kTube;

namespace {

constexpr double kHandSpeed = 0.6;  // [m/s]

/// How far the tube lies on the far side of the grasper's axis, along `direction` [m].
double ahead_of_axis(const small::Table& t, Vec3d direction) {
  const ToolShape& shape = t.work.shapes[kGrasper];
  double nearest = 1e9, ahead = 0;
  const std::vector<Vec3d>& x = t.state.strands[kTube].x;
  for (size_t e = 0; e + 1 < x.size(); ++e) {
    const auto pair = geometry::closest_segments(shape.part[kShaft].a, shape.frame.tip, x[e], x[e + 1]);
    if (pair.distance2 >= nearest) continue;
    nearest = pair.distance2;
    ahead = dot(pair.on_second - pair.on_first, direction);
  }
  return ahead;
}

/// Moves the grasper there at any speed, around the limits of hands.
void put(small::Table& t, Vec3d tip, double roll) {
  const kinematics::FulcrumPose pose = kinematics::inverse(t.model.tools[kGrasper].port, tip, roll);
  t.input.tools[kGrasper] = sim::tool_input(pose, 1.0f);
  ToolState& tool = t.state.tools[kGrasper];
  tool.yaw = pose.yaw;
  tool.pitch = pose.pitch;
  tool.roll = pose.roll;
  tool.depth = pose.depth;
}

struct Sweeps {
  int passed = 0;      ///< trials in which the tube ended up behind the instrument
  double least = 1e9;  ///< [m] of the tube ahead of the axis, in any tick of any trial after the first touch
};

/// The closed grasper is swept across the tube so that the tube meets it `from_tip` behind its tip.
Sweeps sweep_across_tube(double speed, double from_tip_low, double from_tip_high, int trials, std::uint64_t seed) {
  core::Random random(seed);
  Sweeps result;
  for (int trial = 0; trial < trials; ++trial) {
    small::Table t(small::model());
    const double from_tip = random.uniform(from_tip_low, from_tip_high), side = random.uniform() < 0.5 ? 1 : -1;
    const double slant = random.uniform(-0.5, 0.5), roll = random.uniform(-3, 3);
    const Vec3d direction = normalised(Vec3d{slant, side, 0});
    const Vec3d crossing{random.uniform(0.015, 0.032), 0, -from_tip};
    t.close(kGrasper, 1);
    t.state.tools[kGrasper].handle = 1;
    const int ticks = int(0.019 / (speed * sim::kTick));
    bool touched = false;
    for (int i = 0; i <= ticks + 100; ++i) {
      const double way = std::min(0.019, speed * sim::kTick * i);
      put(t, crossing + (way - 0.012) * direction, roll);
      t.step();
      const ToolState& tool = t.tool(kGrasper);
      touched = touched || length(Vec3d{tool.contact_force[0], tool.contact_force[1], tool.contact_force[2]}) > 0;
      if (touched) result.least = std::min(result.least, ahead_of_axis(t, direction));
    }
    result.passed += ahead_of_axis(t, direction) <= 0;
  }
  return result;
}

TEST(Tunnel, TheShaftAtHandSpeedPushesTheTubeAheadOfIt) {
  const Sweeps s = sweep_across_tube(kHandSpeed, 0.030, 0.045, 40, 1);
  EXPECT_EQ(s.passed, 0);
  EXPECT_GT(s.least, 0.0015) << "[m] the tube's axis stays outside most of the shaft of 2.5 mm radius";
}

TEST(Tunnel, TheShaftAtTwoMetresASecondPushesTheTubeAheadOfIt) {
  const Sweeps s = sweep_across_tube(2.0, 0.030, 0.045, 60, 2);
  EXPECT_EQ(s.passed, 0);
  EXPECT_GT(s.least, 0);
}

TEST(Tunnel, ClosedJawsAtHandSpeedPushTheTubeAheadOfThem) {
  const Sweeps s = sweep_across_tube(kHandSpeed, 0.004, 0.020, 60, 3);
  EXPECT_EQ(s.passed, 0);
  EXPECT_GT(s.least, 0.0005) << "[m] the jaws are 1.8 mm thick";
}

TEST(Tunnel, ClosedJawsAtTwiceHandSpeedPushTheTubeAheadOfThem) {
  // Beyond 1.5 m/s the jaws do pass, which is why hands are bounded at 0.6 m/s.
  const Sweeps s = sweep_across_tube(2 * kHandSpeed, 0.004, 0.020, 60, 4);
  EXPECT_EQ(s.passed, 0);
  EXPECT_GT(s.least, 0);
}

}  // namespace
