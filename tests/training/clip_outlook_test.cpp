#include <gtest/gtest.h>

#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/exercise/clip_outlook.hpp>

#include "two_sides.hpp"

namespace trocar::training {
namespace {

using two_sides::Attempt;
using two_sides::kApplier;
using two_sides::kCord;
using two_sides::kLeft;

/// Open jaws of a loaded applier around a place on a strand, `inside` from the ends of the legs, turned by `off` from
/// straight across.
void reach_around(Attempt& a, int strand, double s, double inside, double off) {
  const interactions::StrandBody& body = a.model.strand_bodies[size_t(strand)];
  const tissue::StrandState& shape = a.state.strands[size_t(strand)];
  const interactions::StrandPlace place = interactions::place_at(body, s);
  const Vec3d point = interactions::point_at(body, shape, place);
  const Vec3d along = interactions::tangent_at(body, shape, place);
  const Vec3d port = a.model.hands[kApplier].port;
  const Vec3d tip = point + inside * normalised(point - port);

  interactions::ToolState& tool = a.state.tools[kApplier];
  double best = 0, least = 2;
  for (int degree = -180; degree < 180; ++degree) {  // the roll whose jaws open across the strand
    const double roll = degree * portable::pi / 180;
    const kinematics::TipFrame frame = kinematics::forward(port, kinematics::inverse(port, tip, roll));
    const double slant = std::fabs(dot(frame.opening(), along));
    if (slant < least) {
      least = slant;
      best = roll;
    }
  }
  const kinematics::FulcrumPose pose = kinematics::inverse(port, tip, best + off);
  tool.yaw = pose.yaw;
  tool.pitch = pose.pitch;
  tool.roll = pose.roll;
  tool.depth = pose.depth;
  tool.aperture = 1;
  tool.armed = 1;
}

std::optional<ClipOutlook> outlook(const Attempt& a) {
  return clip_outlook(two_sides::exercise().goal, a.model, a.state, kApplier);
}

constexpr double kInside = 0.006;

TEST(ClipOutlook, AGoodPlaceIsToldBeforeTheClipIsSet) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0);
  const auto o = outlook(a);
  ASSERT_TRUE(o);
  EXPECT_TRUE(o->tube);
  EXPECT_NEAR(o->s, 0.016, 1e-3);
  EXPECT_TRUE(o->in_place && o->encloses && o->seen()) << o->s << " " << o->cover;
}

TEST(ClipOutlook, EachFaultIsToldByItself) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0.5);
  ASSERT_TRUE(outlook(a));
  EXPECT_FALSE(outlook(a)->across);
  reach_around(a, kLeft, 0.045, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_FALSE(outlook(a)->in_place) << "the ampulla";
  reach_around(a, kLeft, 0.016, 0.0005, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_FALSE(outlook(a)->encloses) << "half of the tube lies before the tips";
  reach_around(a, kLeft, 0.016, kInside, 0);
  a.look_away();
  ASSERT_TRUE(outlook(a));
  EXPECT_EQ(outlook(a)->tips_visible, 0);
}

TEST(ClipOutlook, ASecondClipBelongsAtItsDistanceFromTheFirst) {
  Attempt a;
  a.clip(a.good_clip(kLeft, 0.016));
  reach_around(a, kLeft, 0.018, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_FALSE(outlook(a)->in_place);
  reach_around(a, kLeft, 0.025, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_TRUE(outlook(a)->in_place);
}

TEST(ClipOutlook, AFaultyClipIsNoPartnerAndTheJudgesPairsAreTheOutlooks) {
  Attempt a;
  interactions::Clip oblique = a.good_clip(kLeft, 0.016);
  oblique.theta = 0.4;
  a.clip(oblique);
  reach_around(a, kLeft, 0.017, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_TRUE(outlook(a)->in_place) << "beside one that does not count";

  Attempt b;
  b.clip(b.good_clip(kLeft, 0.022));
  reach_around(b, kLeft, 0.029, kInside, 0);
  ASSERT_TRUE(outlook(b));
  EXPECT_FALSE(outlook(b)->in_place) << "two outer clips are no pair";
}

TEST(ClipOutlook, AWrongStructureIsNamed) {
  Attempt a;
  reach_around(a, kCord, 0.02, kInside, 0);
  const auto o = outlook(a);
  ASSERT_TRUE(o);
  EXPECT_EQ(o->strand, kCord);
  EXPECT_FALSE(o->tube || o->good());
}

TEST(ClipOutlook, WithoutAClipOrATubeThereIsNone) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0);
  a.state.tools[kApplier].armed = 0;
  EXPECT_FALSE(outlook(a)) << "no clip in the jaws";
  a.state.tools[kApplier].armed = 1;
  a.state.tools[kApplier].depth = 0.03;
  EXPECT_FALSE(outlook(a)) << "nothing between the jaws";
  EXPECT_FALSE(clip_outlook(two_sides::exercise().goal, a.model, a.state, two_sides::kGrasper)) << "no applier";
}

TEST(ClipOutlook, WhatIsForetoldIsWhatIsSet) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0.1);
  const auto o = outlook(a);
  ASSERT_TRUE(o);
  interactions::ToolState& tool = a.state.tools[kApplier];
  tool.clips_left = 1;
  tool.aperture = 0.03;
  const interactions::ToolModel& applier = a.model.tool(a.state, kApplier);
  const interactions::TissueView view{a.model.strand_bodies, a.state.strands, {}};
  ASSERT_TRUE(interactions::update_clip_applier(applier, interactions::shape_of(applier, tool.pose(), tool.aperture),
                                                kApplier, view, a.state.strands, 2, 1, tool,
                                                {a.state.clips, a.state.clip_count}));
  const interactions::Clip& set = a.state.clips[0];
  EXPECT_EQ(set.strand, o->strand);
  EXPECT_NEAR(set.s, o->s, 5e-4);
  EXPECT_NEAR(set.theta, o->theta, 1e-3);
  EXPECT_NEAR(set.cover, o->cover, 0.02);
}

}  // namespace
}  // namespace trocar::training
