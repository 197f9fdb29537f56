// Clips of known geometry: what the record says must be what was set. The tube is straight, the applier stands where
// the arithmetic is plain.
#include <gtest/gtest.h>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/numerics/portable.hpp>

#include "few_bodies.hpp"
#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

using test::StraightTube;

ToolModel applier() {
  ToolModel m;
  m.kind = ToolKind::clip_applier;
  m.port = {0.030, 0, 0.10};
  m.jaw_length = 0.018;
  m.jaw_width = 0.0045;
  m.jaw_thickness = 0.002;
  m.opening = 0;
  m.parallel_gap = 0.006;
  m.clip_length = 0.0085;
  m.clips = 20;
  return m;
}

/// An applier that closes over a tube along x, the tube `inside` from where the legs meet the jaws' ends.
struct Applying {
  ToolModel model = applier();
  test::FewBodies few;
  ToolState tool;
  std::array<Clip, kMaxClips> clips{};
  std::int32_t count = 0;
  std::uint64_t tick = 0;
  kinematics::FulcrumPose pose;

  explicit Applying(Vec3d tip, double turn = 0) {
    pose = kinematics::inverse(model.port, tip, 0);
    pose.roll = kinematics::roll_towards(pose, {portable::cos(turn), portable::sin(turn), 0});
    tool.clips_left = model.clips;
    const StraightTube tube;
    few.models.strand_bodies.push_back(tube.body);
    few.states.strands.push_back(tube.state);
  }
  /// Tip position such that the tube's centre, at z = 0, is `inside` from the jaws' hinge of a vertical applier.
  static Vec3d over(double x, double inside) { return {x, 0, inside - 0.018}; }

  bool at(double aperture) {
    tool.aperture = aperture;
    const ToolShape shape = shape_of(model, pose, aperture);
    return update_clip_applier(model, shape, 2, few.all(), few.states.strands, 2, tick++, tool, {clips, count});
  }
  /// Opens wide and closes evenly within `ticks`; true when a clip left the magazine.
  bool close(int ticks = 400) {
    at(1.0);
    bool set = false;
    for (int i = 1; i <= ticks; ++i) set = at(1.0 - double(i) / ticks) || set;
    return set;
  }
};

TEST(Clip, ItsPlaceIsTheArcLengthUnderTheJaws) {
  for (double x : {0.0137, 0.030, 0.0421}) {
    Applying a(Applying::over(x, 0.013));
    a.model.port.x = x;
    a.pose = kinematics::inverse(a.model.port, Applying::over(x, 0.013), 0);
    a.pose.roll = kinematics::roll_towards(a.pose, {1, 0, 0});
    ASSERT_TRUE(a.close());
    ASSERT_EQ(a.count, 1);
    EXPECT_EQ(a.clips[0].strand, 0);
    EXPECT_NEAR(a.clips[0].s, x, 1e-9);
    EXPECT_EQ(a.clips[0].tool, 2);
    EXPECT_EQ(a.clips[0].tips_visible, 2);
  }
}

TEST(Clip, ThetaIsTheTurnFromTheCrossSection) {
  for (double degrees : {0.0, 5.0, 15.0, 30.0, 45.0}) {
    const double turn = degrees * portable::pi / 180;
    Applying a(Applying::over(0.030, 0.013), turn);
    ASSERT_TRUE(a.close());
    ASSERT_EQ(a.clips[0].strand, 0) << degrees;
    EXPECT_NEAR(a.clips[0].theta, turn, 1e-7);
  }
}

TEST(Clip, ThetaIsTheSameForAnApplierTurnedByHalf) {
  Applying a(Applying::over(0.030, 0.013), 0.2);
  a.pose.roll -= portable::pi;
  ASSERT_TRUE(a.close());
  EXPECT_NEAR(a.clips[0].theta, 0.2, 1e-7);
}

TEST(Clip, CoverIsTheShareOfTheTubeBetweenTheLegs) {
  // The legs reach from 9.5 mm to 18 mm behind the hinge; the tube's radius is 1.6 mm.
  const struct {
    double inside, cover;
  } cases[] = {{0.0137, 1}, {0.0164, 1}, {0.0180, 0.5}, {0.0172, 0.75}, {0.0095, 0.5}, {0.0111, 1}};
  for (const auto& c : cases) {
    Applying a(Applying::over(0.030, c.inside));
    ASSERT_TRUE(a.close());
    ASSERT_EQ(a.clips[0].strand, 0) << c.inside;
    EXPECT_NEAR(a.clips[0].cover, c.cover, 1e-9) << c.inside;
    EXPECT_NEAR(a.clips[0].reach, c.inside - 0.0095, 1e-9);
  }
}

TEST(Clip, LegCoverIsAnIntersectionOfIntervals) {
  EXPECT_DOUBLE_EQ(leg_cover(0.004, 0.002, 0.0085), 1);
  EXPECT_DOUBLE_EQ(leg_cover(0, 0.002, 0.0085), 0.5);
  EXPECT_DOUBLE_EQ(leg_cover(-0.002, 0.002, 0.0085), 0);
  EXPECT_DOUBLE_EQ(leg_cover(0.0085, 0.002, 0.0085), 0.5);
  EXPECT_DOUBLE_EQ(leg_cover(0.012, 0.002, 0.0085), 0);
  EXPECT_DOUBLE_EQ(leg_cover(0.004, 0.008, 0.008), 0.5) << "a tube twice as wide as the clip";
}

TEST(Clip, ItsDirectionsAreThoseOfTheJawsInTheTubesFrame) {
  Applying a(Applying::over(0.030, 0.013), 0.25);
  ASSERT_TRUE(a.close());
  const Clip& c = a.clips[0];
  const StrandFrame f =
      frame_at(a.few.models.strand_bodies[0], a.few.states.strands[0], place_at(a.few.models.strand_bodies[0], c.s));
  const ToolShape shape = shape_of(a.model, a.pose, 0);
  const auto world = [&f](const double(&v)[3]) { return v[0] * f.tangent + v[1] * f.normal + v[2] * f.binormal; };
  EXPECT_LT(length(world(c.opening) - shape.frame.opening()), 1e-9);
  EXPECT_LT(length(world(c.axis) - shape.frame.axis()), 1e-9);
}

TEST(Clip, ClosingTimeCountsFromHalfOpenToShut) {
  for (int ticks : {200, 1000, 3000}) {
    Applying a(Applying::over(0.030, 0.013));
    ASSERT_TRUE(a.close(ticks));
    EXPECT_NEAR(a.clips[0].closing_time, 0.46 * ticks * 1e-3, 2.1e-3);
  }
}

TEST(Clip, OpeningAgainStartsTheClosingTimeAfresh) {
  Applying a(Applying::over(0.030, 0.013));
  a.at(1.0);
  for (int i = 0; i < 500; ++i) a.at(0.45);  // hesitates, half closed
  a.at(0.6);                                 // opens
  int ticks = 0;
  while (!a.at(0.5 - 0.001 * ticks)) ++ticks;
  EXPECT_NEAR(a.clips[0].closing_time, 0.46, 0.01);
}

TEST(Clip, ClosedOnNothingIsDroppedAndCounted) {
  Applying a(Applying::over(0.030, 0.013) + Vec3d{0, 0, 0.03});
  EXPECT_TRUE(a.close());
  ASSERT_EQ(a.count, 1);
  EXPECT_EQ(a.clips[0].strand, -1);
  EXPECT_EQ(a.tool.clips_left, 19);
  for (double scale : a.few.states.strands[0].scale) EXPECT_EQ(scale, 1);
}

TEST(Clip, JawsMustOpenWideForTheNextOne) {
  Applying a(Applying::over(0.030, 0.013));
  ASSERT_TRUE(a.close());
  for (double aperture : {0.3, 0.79, 0.3, 0.0}) EXPECT_FALSE(a.at(aperture));
  EXPECT_EQ(a.count, 1);
  EXPECT_TRUE(a.close());
  EXPECT_EQ(a.count, 2);
}

TEST(Clip, TheMagazineEmpties) {
  Applying a(Applying::over(0.030, 0.013));
  a.tool.clips_left = 2;
  EXPECT_TRUE(a.close());
  EXPECT_TRUE(a.close());
  EXPECT_EQ(a.tool.clips_left, 0);
  EXPECT_FALSE(a.close());
  EXPECT_EQ(a.count, 2);
  EXPECT_EQ(a.tool.clips_left, 0);
}

TEST(Clip, MoreClipsThanTheBufferHoldsAreNotWrittenPastItsEnd) {
  Applying a(Applying::over(0.030, 0.013));
  a.tool.clips_left = kMaxClips + 4;
  int set = 0;
  for (int i = 0; i < kMaxClips + 4; ++i) set += a.close();
  EXPECT_EQ(set, kMaxClips);
  EXPECT_EQ(a.count, kMaxClips);
}

TEST(Clip, StiffensTheTubeWhereItSits) {
  Applying a(Applying::over(0.0312, 0.013));
  a.model.port.x = 0.0312;
  a.pose = kinematics::inverse(a.model.port, Applying::over(0.0312, 0.013), a.pose.roll);
  ASSERT_TRUE(a.close());
  const int element = place_at(a.few.models.strand_bodies[0], a.clips[0].s).element;
  for (int e = 0; e + 1 < a.few.models.strand_bodies[0].nodes(); ++e)
    EXPECT_EQ(a.few.states.strands[0].scale[size_t(e)] > 1, e == element) << "element " << e;
}

TEST(Clip, DoesNotHealWhatIsHalfCut) {
  Applying whole(Applying::over(0.0312, 0.013)), half(Applying::over(0.0312, 0.013));
  for (Applying* a : {&whole, &half}) {
    a->model.port.x = 0.0312;
    a->pose = kinematics::inverse(a->model.port, Applying::over(0.0312, 0.013), a->pose.roll);
  }
  for (double& scale : half.few.states.strands[0].scale) scale = 0.1;
  ASSERT_TRUE(whole.close());
  ASSERT_TRUE(half.close());
  const size_t element = size_t(place_at(half.few.models.strand_bodies[0], half.clips[0].s).element);
  EXPECT_NEAR(half.few.states.strands[0].scale[element], 0.1 * whole.few.states.strands[0].scale[element], 1e-12);
}

}  // namespace
