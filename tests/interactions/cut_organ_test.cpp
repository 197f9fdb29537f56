// Scissors in an organ: what the closed blades cross is severed, the network falls apart along it and nowhere else.
#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>

namespace trocar::interactions {
namespace {

/// A block of 6 x 6 x 4 cells of 3 mm under the origin, its top at z = 0, with a skin of two triangles a top square.
struct Block {
  tissue::NetworkModel network;
  tissue::NetworkState state;
  tissue::Skin skin;
  std::vector<std::uint8_t> parted;
  std::vector<std::int32_t> scratch;

  Block() {
    const tissue::BoxLattice box = tissue::box_lattice(6, 6, 4, 0.003, {-0.009, -0.0105, -0.012});
    tissue::LatticeMaterial material;
    material.youngs_modulus = 8e3;
    material.density = 1050;
    network = tissue::build(tissue::lattice_network(box.corners, box.cells, {}, material).network, 1e-3);
    state = tissue::rest_state(network);
    for (int j = 0; j <= 6; ++j)
      for (int i = 0; i <= 6; ++i) {
        const int node = box.corner(i, j, 4);
        tissue::SkinWeights w;
        w.node.fill(node);
        w.row.fill(network.row_of_node[size_t(node)]);
        w.weight = {1, 0, 0, 0, 0, 0, 0, 0};
        skin.weights.push_back(w);
        skin.rest.push_back(vec_cast<float>(box.corners[size_t(node)]));
        skin.rest_normal.push_back({0, 0, 1});
      }
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        const int a = i + 7 * j;
        skin.triangles.push_back({a, a + 1, a + 7});
        skin.triangles.push_back({a + 1, a + 8, a + 7});
      }
    parted.assign(skin.triangles.size(), 0);
    scratch.assign(size_t(network.nodes), 0);
  }
};

ToolModel scissors() {
  ToolModel t;
  t.kind = ToolKind::scissors;
  t.port = {0, 0, 0.1};
  t.jaw_length = 0.015;
  t.jaw_width = 0.0025;
  t.opening = 0.8;
  return t;
}

TEST(CutOrgan, BladesInTheTissueSeverOnlyWhatTheyCross) {
  Block block;
  // Straight down into the top: the blades' plane is y = 0 (between two rows of nodes), their tips 6 mm deep.
  const ToolShape shape = shape_of(scissors(), {0, 0, 0, 0.106}, 0.2);
  const int severed =
      cut_organ(closed_blades(scissors(), shape), block.network, block.skin, block.state, block.parted, block.scratch);
  EXPECT_GT(severed, 4);
  for (int s = 0; s < block.network.springs; ++s) {
    if (tissue::spring_scale(block.network, block.state, s) > 0) continue;
    const Vec3d a = block.network.rest[size_t(block.network.spring_nodes[size_t(2 * s)])];
    const Vec3d b = block.network.rest[size_t(block.network.spring_nodes[size_t(2 * s) + 1])];
    EXPECT_LT(a.y * b.y, 0) << "a severed spring crosses the blades' plane";
    EXPECT_GT(std::max(a.z, b.z), -0.0061) << "none below the tips";
  }
  int open = 0;
  for (std::uint8_t p : block.parted) open += p;
  EXPECT_GE(open, 1);
  EXPECT_LE(open, 6) << "the skin opens at the blades, not elsewhere";
}

TEST(CutOrgan, BladesBesideTheOrganCutNothing) {
  Block block;
  const ToolShape shape = shape_of(scissors(), {0, 0, 0, 0.095}, 0.2);
  EXPECT_EQ(
      cut_organ(closed_blades(scissors(), shape), block.network, block.skin, block.state, block.parted, block.scratch),
      0);
  EXPECT_EQ(block.state.version, 0u);
}

TEST(CutOrgan, BladesAreAskedBeforehandWhatTheyWillCut) {
  int cut = 0;
  core::Random random(2);
  for (int bite = 0; bite < 60; ++bite) {
    Block block;
    const kinematics::FulcrumPose pose{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), random.uniform(-3, 3),
                                       random.uniform(0.096, 0.106)};
    const geometry::Blade blade = closed_blades(scissors(), shape_of(scissors(), pose, 0.2));
    const geometry::BladePlane plane(blade);
    const bool will = crosses(plane, block.network, block.state);
    std::vector<bool> each;
    for (int s = 0; s < block.network.springs; ++s) each.push_back(crosses(plane, block.network, block.state, s));
    const int severed = cut_organ(blade, block.network, block.skin, block.state, block.parted, block.scratch);
    EXPECT_EQ(severed > 0, will);
    for (int s = 0; s < block.network.springs; ++s) {
      if (tissue::spring_scale(block.network, block.state, s) > 0) continue;
      EXPECT_TRUE(each[size_t(s)]);
      EXPECT_FALSE(crosses(plane, block.network, block.state, s)) << "what is severed is crossed no more";
    }
    cut += will;
  }
  EXPECT_GT(cut, 15);
  EXPECT_LT(cut, 60) << "some end above it";
}

TEST(CutOrgan, WhoLeavesRoomAsksOfALongerBlade) {
  const Block block;
  const ToolShape shape = shape_of(scissors(), {0, 0, 0, 0.099}, 0.2);  // the tips 1 mm above it
  const auto any = [&](double beyond) {
    const geometry::Blade blade = closed_blades(scissors(), shape, beyond);
    return crosses(geometry::BladePlane(blade), block.network, block.state);
  };
  EXPECT_FALSE(any(0));
  EXPECT_FALSE(any(0.0005));
  EXPECT_TRUE(any(0.002));
}

TEST(CutOrgan, WhatWouldComeLooseStaysOnAThread) {
  // Bite after bite, until the block is full of cuts in every direction: it still hangs together.
  Block block;
  core::Random random(1);
  int severed = 0;
  for (int bite = 0; bite < 300; ++bite) {
    const kinematics::FulcrumPose pose{random.uniform(-0.08, 0.08), random.uniform(-0.08, 0.08), random.uniform(-3, 3),
                                       random.uniform(0.100, 0.115)};
    severed += cut_organ(closed_blades(scissors(), shape_of(scissors(), pose, 0.2)), block.network, block.skin,
                         block.state, block.parted, block.scratch);
  }
  EXPECT_GT(severed, block.network.springs / 3);
  std::vector<int> reached{0};
  std::vector<bool> seen(size_t(block.network.nodes), false);
  seen[0] = true;
  for (size_t i = 0; i < reached.size(); ++i)
    for (int s = 0; s < block.network.springs; ++s) {
      if (tissue::spring_scale(block.network, block.state, s) <= 0) continue;
      const int a = block.network.spring_nodes[size_t(2 * s)], b = block.network.spring_nodes[size_t(2 * s) + 1];
      const int other = a == reached[i] ? b : b == reached[i] ? a : -1;
      if (other < 0 || seen[size_t(other)]) continue;
      seen[size_t(other)] = true;
      reached.push_back(other);
    }
  EXPECT_EQ(int(reached.size()), block.network.nodes);
}

}  // namespace
}  // namespace trocar::interactions
