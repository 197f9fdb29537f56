// A clip applier that closes where a clip is: it does not, as long as that clip lies between its legs.
#include <gtest/gtest.h>

#include <trocar/interactions/verbs/clip.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;
using small::kApplier;
using small::kTube;

namespace {

/// Hands that clip the tube at so many places, one after the other.
struct Clips : small::Table {
  Clips() : Table(small::bare()) {}

  /// Over the tube at arc length `s`, closed there and opened again, drawn back.
  void clip_at(double s) {
    const interactions::StrandBody& body = model.strand_bodies[kTube];
    const interactions::ToolModel& applier = model.placed(kApplier);
    const Vec3d at = interactions::point_at(body, state.strands[kTube], interactions::place_at(body, s));
    const Vec3d axis = normalised(at - applier.port), tip = at + 0.005 * axis, away = at - 0.03 * axis;
    const kinematics::FulcrumPose pose = kinematics::inverse(applier.port, tip, 0);
    input.tools[kApplier].roll = float(kinematics::roll_towards(
        pose, interactions::tangent_at(body, state.strands[kTube], interactions::place_at(body, s))));
    close(kApplier, 0);
    carry(kApplier, m_tip, away, 0.2);
    steps(400);
    carry(kApplier, away, tip, 0.1);
    steps(100);
    close_slowly(kApplier, 1, 400);
    steps(50);
    aperture = tool(kApplier).aperture;
    close_slowly(kApplier, 0, 200);
    steps(50);
    carry(kApplier, tip, away, 0.2);
    m_tip = away;
  }
  double aperture = 0;  ///< with the handle closed

 private:
  Vec3d m_tip{0.026, -0.02, 0.05};
};

}  // namespace

TEST(ClipOnClip, DoesNotCloseAtTheSamePlaceAndIsReported) {
  Clips c;
  c.clip_at(0.020);
  ASSERT_EQ(c.count(Event::clipped), 1);
  EXPECT_LT(c.aperture, 0.04);
  const int left = c.tool(kApplier).clips_left;
  c.clip_at(0.0202);
  EXPECT_EQ(c.count(Event::clipped), 1);
  EXPECT_EQ(c.count(Event::clip_blocked), 1);
  EXPECT_EQ(c.tool(kApplier).clips_left, left) << "the clip stays in the applier";
  EXPECT_GT(c.aperture, 0.3);
}

TEST(ClipOnClip, ClosesThreeMillimetresBesideIt) {
  Clips c;
  c.clip_at(0.020);
  c.clip_at(0.023);
  EXPECT_EQ(c.count(Event::clipped), 2);
  EXPECT_EQ(c.count(Event::clip_blocked), 0);
}
