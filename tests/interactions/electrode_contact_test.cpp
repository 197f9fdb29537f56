// Where a hook's current leaves: from the nearest of its bare metal.
#include <gtest/gtest.h>

#include <trocar/interactions/verbs/electrode_contact.hpp>

#include "few_bodies.hpp"
#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

constexpr double kRadius = 0.0008;  ///< of the tube [m]

/// A hook that points down, its tip at the origin, its foot to where x grows.
ToolModel hook(double foot) {
  ToolModel m;
  m.kind = ToolKind::hook;
  m.port = {0, 0, 0.1};
  m.jaw_length = 0.012;
  m.jaw_thickness = 0.0012;
  m.opening = 0;
  m.foot = foot;
  m.electrode.there = true;
  return m;
}

/// From a tube along y, across the plane of wire and foot at x and z.
ElectrodeTouch touch_at(double foot, double x, double z) {
  const test::StraightTube tube(kRadius, {x, -0.03, z}, {0, 1, 0});
  test::FewBodies few;
  few.models.strand_bodies.push_back(tube.body);
  few.states.strands.push_back(tube.state);
  const ToolModel model = hook(foot);
  return electrode_touch(model, shape_of(model, {0, 0, 0, 0.1}, 0), ToolState{}, few.all());
}

TEST(ElectrodeContact, AFootIsBareMetalToItsEnd) {
  // 0.2 mm above the foot near its end, 1 mm off the wire.
  const ElectrodeTouch on_foot = touch_at(0.0026, 0.0024, 0.0012 + kRadius + 0.0002);
  ASSERT_TRUE(on_foot.contact.body.exists());
  EXPECT_EQ(on_foot.contact.gap, 0) << "so near counts as touching";
  EXPECT_NEAR(on_foot.place.x, 0.0024, 0.0006) << "below the band, not at its side that the wire is nearest to";
  EXPECT_LT(on_foot.place.z, 0.0017);
  const ElectrodeTouch beyond = touch_at(0.0026, 0.0026 + kRadius + 0.0010, 0.0006);
  EXPECT_NEAR(beyond.contact.gap, 0.0010, 1e-6) << "to the foot's end, 3.6 mm off the wire";
}

TEST(ElectrodeContact, TheGapIsThatToTheNearerOfWireAndFoot) {
  const double off = 0.0007;
  EXPECT_NEAR(touch_at(0.0026, -0.0006 - kRadius - off, 0.0006).contact.gap, off, 1e-6) << "behind the wire";
  EXPECT_NEAR(touch_at(0.0026, 0.0015, -kRadius - off).contact.gap, off, 5e-5)
      << "below the foot, looked at from places 1 mm apart";
  EXPECT_NEAR(touch_at(0.0026, 0, 0.004).contact.gap, 0, 1e-6) << "in the wire";
}

TEST(ElectrodeContact, WithoutAFootClosedJawsAreOneRod) {
  EXPECT_NEAR(touch_at(0, 0.0012 + kRadius + 0.0010, 0).contact.gap, 0.0010, 1e-6);
}

}  // namespace
