// Where a suction-irrigator's bore ends, and what places of film belong to.
#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/verbs/irrigate.hpp>

using namespace trocar;
using namespace trocar::interactions;

namespace {

using core::kTick;

ToolModel tube() {
  ToolModel t;
  t.kind = ToolKind::suction_irrigator;
  t.jaw_length = 0.005;
  t.jaw_thickness = 0.0025;
  t.opening = 0;
  return t;
}

}  // namespace

TEST(Irrigator, ItsBoreEndsWhereTissueMeetsItsEnd) {
  const ToolModel t = tube();
  const ToolShape shape = shape_of(t, {0.3, -0.2, 0.1, 0.120}, 0);
  const Bore bore = bore_of(t, shape, shape, kTick);
  for (const int jaw : {kJawA, kJawB}) {
    const Vec3d reach = shape.part[jaw].b + shape.part[jaw].radius * bore.axis;
    EXPECT_NEAR(dot(bore.end - reach, bore.axis), 0, 1e-12);
  }
  EXPECT_EQ(length(bore.velocity), 0);
}

TEST(Irrigator, ItsBoreMovesAsItIsLed) {
  const ToolModel t = tube();
  const ToolShape before = shape_of(t, {0, 0, 0, 0.120}, 0), now = shape_of(t, {0, 0, 0, 0.1205}, 0);
  const Bore bore = bore_of(t, now, before, kTick);
  EXPECT_NEAR(dot(bore.velocity, bore.axis), 0.5, 1e-9);
}

TEST(Irrigator, NoDropIsBornInsideItsTube) {
  const ToolModel t = tube();
  const ToolShape shape = shape_of(t, {0.3, -0.2, 0.1, 0.120}, 0);
  const fluids::Capsule c = tube_of(t, shape, shape, kTick);
  ASSERT_TRUE(sound(c));
  const Vec3f end = vec_cast<float>(bore_of(t, shape, shape, kTick).end);
  const float share = nearest_share(c, end);
  EXPECT_NEAR(length(end - (c.a + share * (c.b - c.a))), c.radius, 1e-6f);
}

TEST(WetTarget, EveryPlaceOfFilmBelongsToOneBodyAndNothingElseToAny) {
  const std::vector<std::int32_t> first{0, 5, 5, 11, 14};  // an organ of 5 vertices, an empty wall, a fold, a strand
  const auto target = [&](int body, int place) { return target_of(first, {2, 1}, body, place); };
  EXPECT_EQ(target(0, 4).kind, WetTarget::surface);
  EXPECT_EQ(target(0, 4).vertex, 4);
  EXPECT_EQ(target(2, 8).kind, WetTarget::sheet);
  EXPECT_EQ(target(2, 8).index, 0);
  EXPECT_EQ(target(2, 8).vertex, 1) << "two sides a node";
  EXPECT_EQ(target(3, 13).kind, WetTarget::strand);
  EXPECT_EQ(target(3, 13).vertex, 2);
  EXPECT_EQ(target(0, 5).kind, WetTarget::none) << "beyond the body's own";
  EXPECT_EQ(target(0, -1).kind, WetTarget::none);
  EXPECT_EQ(target(4, -1).kind, WetTarget::none) << "an instrument";
  EXPECT_EQ(target(-1, 0).kind, WetTarget::none);
}
