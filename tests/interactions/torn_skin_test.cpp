// A lattice tears without coming apart, so its skin still spans the gap: what hangs in the gap is not to be touched,
// or an instrument would draw both sides along by a thread of nothing.
#include <gtest/gtest.h>

#include <trocar/interactions/instrument/tool_contact.hpp>

namespace trocar::interactions {
namespace {

constexpr double kCell = 0.003;  // [m]

/// Two triangles facing up whose two middle corners are carried half by the left and half by the right node.
struct Gap {
  std::vector<tissue::NodeState> rows = std::vector<tissue::NodeState>(2);
  std::vector<int> row_of_node{0, 1};
  tissue::Skin skin;
  tissue::SkinPose pose;
  Surface surface;

  explicit Gap(double apart) {
    rows[0].x = float(-0.5 * apart);
    rows[1].x = float(0.5 * apart);
    for (const float right : {0.0f, 0.5f, 0.5f, 1.0f}) {
      tissue::SkinWeights w = tissue::SkinWeights::at(0, 0);
      w.node[1] = w.row[1] = 1;
      w.weight[0] = 1 - right, w.weight[1] = right;
      skin.weights.push_back(w);
      skin.rest.push_back({float(kCell) * (right - 0.5f), 0, 0});
      skin.rest_normal.push_back({0, 0, 1});
    }
    skin.triangles = {{0, 1, 2}, {1, 3, 2}};
    index_skin(skin);
    pose = make_pose(skin);
    const tissue::NodeView nodes{rows, row_of_node, {}};
    pose_skin(nodes, skin, pose);
    surface = {&skin, &pose, nodes, torn_beyond(kCell)};
  }

  /// Loads of a shaft that comes down across the middle.
  size_t touched() const {
    ToolShape before, now;
    const Capsule away{{9, 9, 9}, {9, 9, 9.1}, 0.001};
    for (ToolShape* s : {&before, &now}) {
      const double z = s == &before ? 0.004 : 0.002;
      s->part[kJawA] = s->part[kJawB] = away;
      s->part[kShaft] = {{0, -0.05, z}, {0, 0.05, z}, 0.0025};
      s->pivot = s->frame.tip = s->part[kShaft].b;
    }
    TouchBook last, next;
    Touching touching(0.3, before, now, 0, last, next);
    NetworkLoads loads;
    loads.reserve(256);
    tool_on_surface(touching, BodyId::organ(0), surface, loads);
    loads.sort();
    return loads.sorted.size();
  }
};

TEST(TornSkin, IsWhereCarriersAreFartherApartThanTissueBears) {
  const double bears = 2 * double(torn_beyond(kCell));
  for (const double share : {0.1, 0.5, 0.99}) {
    const Gap whole(share * bears);
    for (int v = 0; v < 4; ++v) EXPECT_FALSE(whole.surface.torn(v)) << share;
  }
  const Gap torn(1.01 * bears);
  EXPECT_TRUE(torn.surface.torn(1));
  EXPECT_TRUE(torn.surface.torn(2));
  EXPECT_TRUE(torn.surface.torn(0, 3));
  EXPECT_FALSE(torn.surface.torn(0)) << "carried by one side alone";
  EXPECT_FALSE(torn.surface.torn(3));
  EXPECT_FALSE(torn.surface.torn(1, 2)) << "an edge along the gap";
}

TEST(TornSkin, IsNotTouched) {
  EXPECT_GT(Gap(kCell).touched(), 0u);
  EXPECT_GT(Gap(10 * kCell).touched(), 0u) << "drawn long, but not torn";
  EXPECT_EQ(Gap(60 * kCell).touched(), 0u);
}

TEST(TornSkin, IsNowhereOnBodiesThatDoNotTear) {
  Gap gap(60 * kCell);
  gap.surface.torn_beyond = 0;
  EXPECT_FALSE(gap.surface.torn(1));
  EXPECT_GT(gap.touched(), 0u);
}

}  // namespace
}  // namespace trocar::interactions
