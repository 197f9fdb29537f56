// All links of an instrument that bends count where others look at it: in sights, for pulses, for its place.
#include <gtest/gtest.h>

#include <trocar/sim/stages/pulse_feel.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "bent_scene.hpp"

namespace trocar::sim {
namespace {

using small::Bent;
using small::kGrasper;

/// Shapes as a tick would have them, for who looks at those.
void pose(Bent& b) {
  step(b.model, b.model.start, b.state, b.work);
  for (size_t t = 0; t < b.model.hands.size(); ++t) b.work.shapes[t] = shape_of(b.model, b.state, t);
}

TEST(BentLinks, HideWhatLiesBehindThemAndNothingOnceTheyAreStraight) {
  Bent b(0.05);
  const Vec3d link = b.grasper().link[0].b - b.grasper().link[0].a;
  const Vec3d across = normalised(cross(link, b.beside()));
  const Vec3d eye = b.middle() + 0.03 * across, point = b.middle() - 0.015 * across;
  const auto free = [&] {
    pose(b);
    return unoccluded(b.model, b.state, b.work, eye, point, 0.0005, -1, -1);
  };
  const Bent kept = b;
  EXPECT_FALSE(free());
  b.state = kept.state;
  b.straighten();
  EXPECT_TRUE(free());
}

TEST(BentLinks, TheTipIsLookedForWhereItIs) {
  Bent b(0.05);
  const Vec3d bent = b.grasper().part[interactions::kJawA].b;
  b.straighten();
  const Vec3d straight = b.grasper().part[interactions::kJawA].b;
  EXPECT_GT(length(bent - straight), 0.015);
  // the endoscope looks along a line on which the straight tip is, and from which the bent one is far away
  Bent bending_now(0.05);
  const int jaw = b.model.target_index(b.model.hands[kGrasper].name + ".jaw_a");
  ASSERT_GE(jaw, 0);
  const auto seen = [&](bool bent_now) {
    State s = bending_now.state;
    if (!bent_now) s.joints[kGrasper] = {};
    Input in = b.model.start;
    const Vec3d port = b.model.scope.port;
    const kinematics::FulcrumPose at = kinematics::inverse(port, straight, 0);
    in.scope = {float(at.yaw), float(at.pitch), 0, float(at.depth - 0.012), 0};
    s.scope = in.scope;
    in.tools[kGrasper] = tool_input(s.tools[kGrasper].pose(), 1);
    in.wrists[kGrasper] = {float(s.joints[kGrasper].angle[0]), 0};
    for (size_t i = 0; i <= b.model.samples.size() / size_t(kLooksPerTick) + 1; ++i) step(b.model, in, s, b.work);
    return visible(b.model, s, jaw);
  };
  EXPECT_TRUE(seen(false));
  EXPECT_FALSE(seen(true)) << "15 mm off a field that is 17 mm wide there";
}

TEST(BentLinks, FeelAVesselThatRunsPastThem) {
  Bent b(0.05);
  const Vec3d at = b.middle() + (b.model.placed(kGrasper).shaft_radius + 0.002) * b.beside();
  EXPECT_GT(pulse_touch(b.grasper(), at, 0.001).share, 0.5);
  b.straighten();
  EXPECT_EQ(pulse_touch(b.grasper(), at, 0.001).share, 0);
}

}  // namespace
}  // namespace trocar::sim
