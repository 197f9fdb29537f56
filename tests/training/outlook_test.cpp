#include <gtest/gtest.h>

#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/kinematics/fulcrum.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/exercise/outlook.hpp>

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

std::optional<Foretold> outlook(const Attempt& a) {
  Outlook o(two_sides::exercise(), a.model);
  const auto identified = std::make_unique<bool[]>(2);
  identified[0] = identified[1] = true;  // survey; identify on the left
  return o.of(a.model, a.state, {identified.get(), 2});
}

bool has(const std::optional<Foretold>& o, const std::string& code) {
  return o && std::find(o->codes.begin(), o->codes.end(), code) != o->codes.end();
}

constexpr double kInside = 0.006;

TEST(Outlook, AGoodPlaceIsToldBeforeTheClipIsSet) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0);
  const auto o = outlook(a);
  ASSERT_TRUE(o);
  EXPECT_EQ(o->on, "tube_left");
  EXPECT_TRUE(o->good()) << o->codes[0];
  ASSERT_EQ(o->steps.size(), 1u);
  EXPECT_EQ(a.monitor.steps()[size_t(o->steps[0])].task, "first_clip");
  EXPECT_GE(o->findings.size(), 4u) << "place, angle, cover, tips";
  for (const Foretold::Finding& f : o->findings) EXPECT_TRUE(f.fits) << f.text;
}

TEST(Outlook, FindingsShowTheLimitsOfTheFile) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0);
  std::string all;
  const auto o = outlook(a);
  for (const Foretold::Finding& f : o->findings) all += f.text + "\n";
  EXPECT_NE(all.find("(at most 15)"), std::string::npos) << all;
  EXPECT_NE(all.find("(10 to 30)"), std::string::npos) << all;
}

TEST(Outlook, EachFaultIsToldByItself) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0.5);
  EXPECT_TRUE(has(outlook(a), "A1.4") || has(outlook(a), "A1.5"));
  reach_around(a, kLeft, 0.045, kInside, 0);
  EXPECT_TRUE(has(outlook(a), "A1.1")) << "the ampulla";
  reach_around(a, kLeft, 0.016, 0.0005, 0);
  EXPECT_TRUE(has(outlook(a), "A1.3")) << "half of the tube lies before the tips";
  reach_around(a, kLeft, 0.016, kInside, 0);
  a.look_away();
  EXPECT_TRUE(has(outlook(a), "E4.2"));
}

TEST(Outlook, ASecondClipBelongsAtItsDistanceFromTheFirst) {
  Attempt a;
  a.clip(a.good_clip(kLeft, 0.016));
  reach_around(a, kLeft, 0.018, kInside, 0);
  EXPECT_TRUE(has(outlook(a), "A1.9"));
  reach_around(a, kLeft, 0.025, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_TRUE(outlook(a)->good());
}

TEST(Outlook, AFaultyClipIsNoPartner) {
  Attempt a;
  interactions::Clip oblique = a.good_clip(kLeft, 0.016);
  oblique.theta = 0.4;
  a.clip(oblique);
  reach_around(a, kLeft, 0.017, kInside, 0);
  ASSERT_TRUE(outlook(a));
  EXPECT_FALSE(has(outlook(a), "A1.9")) << "beside one that does not count";

  Attempt b;
  b.clip(b.good_clip(kLeft, 0.022));
  reach_around(b, kLeft, 0.029, kInside, 0);
  EXPECT_TRUE(has(outlook(b), "A1.9")) << "two outer clips are no pair";
}

TEST(Outlook, AWrongStructureIsNamed) {
  Attempt a;
  reach_around(a, kCord, 0.02, kInside, 0);
  const auto o = outlook(a);
  EXPECT_TRUE(has(o, "E11"));
  EXPECT_EQ(o->on, "the cord");
  EXPECT_NE(o->findings.back().text.find("the cord"), std::string::npos);
}

TEST(Outlook, WhatItForetellsIsWhatIsJudged) {
  for (const double s : {0.011, 0.016, 0.024, 0.028, 0.045}) {
    Attempt a;
    a.survey();
    a.identify();
    a.clip(a.good_clip(kLeft, 0.016));
    const size_t before = a.monitor.errors().size();
    reach_around(a, kLeft, s, kInside, 0);
    const auto o = outlook(a);
    ASSERT_TRUE(o);
    Foreseen f;
    ASSERT_TRUE(kClipped.foresee({a.model, a.state}, kApplier, f));
    f.clip.closing_time = 2;
    a.clip(f.clip);
    std::vector<std::string> made;
    for (size_t i = before; i < a.monitor.errors().size(); ++i) made.push_back(a.monitor.errors()[i].code);
    EXPECT_EQ(made, o->codes) << s;
  }
}

TEST(Outlook, WithoutAClipOrATubeThereIsNone) {
  Attempt a;
  reach_around(a, kLeft, 0.016, kInside, 0);
  a.state.tools[kApplier].armed = 0;
  EXPECT_FALSE(outlook(a)) << "no clip in the jaws";
  a.state.tools[kApplier].armed = 1;
  a.state.tools[kApplier].depth = 0.03;
  EXPECT_FALSE(outlook(a)) << "nothing between the jaws";
}

}  // namespace
}  // namespace trocar::training
