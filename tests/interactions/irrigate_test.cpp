// Where a suction-irrigator's bore ends, and what places of film belong to.
#include <gtest/gtest.h>

#include <trocar/core/tick.hpp>
#include <trocar/interactions/verbs/irrigate.hpp>

#include "few_bodies.hpp"
#include "straight_tube.hpp"

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

TEST(FilmPoint, EveryPlaceOfFilmBelongsToOneBodyAndNothingElseToAny) {
  test::FewBodies few;  // an organ of 5 vertices, an empty wall, a fold, a rod
  few.models.solids.resize(1);
  for (int v = 0; v < 5; ++v) few.models.solids[0].skin.weights.push_back(tissue::SkinWeights::at(v, v));
  few.models.membranes.resize(1);
  few.add(test::StraightTube().body);
  few.work.organs.resize(1);
  few.work.organs[0].skin = &few.models.solids[0].skin;
  const std::vector<std::int32_t> first{0, 5, 5, 11, 36};
  const auto point = [&](int body, int place) { return film_point(few.all(), first, {2, 1}, body, place); };
  EXPECT_EQ(point(0, 4).body, BodyId::organ(0));
  EXPECT_EQ(point(0, 4).node[0], 4);
  EXPECT_EQ(point(2, 8).body, BodyId::membrane(0));
  EXPECT_EQ(point(2, 8).node[0], 1) << "two sides a node";
  EXPECT_EQ(point(3, 13).body, BodyId::strand(0));
  EXPECT_EQ(point(3, 13).element, 2);
  EXPECT_EQ(point(3, 35).element, 23) << "the last node ends the last element";
  EXPECT_EQ(point(3, 35).weight[0], 1);
  EXPECT_TRUE(point(0, 5).in_space()) << "beyond the body's own";
  EXPECT_TRUE(point(0, -1).in_space());
  EXPECT_TRUE(point(4, -1).in_space()) << "an instrument";
  EXPECT_TRUE(point(-1, 0).in_space());
}
