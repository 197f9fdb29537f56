// Weights of nodes about a place: exact for affine motions, bounded where tissue is crushed.
#include <gtest/gtest.h>

#include <trocar/interactions/bodies/material_point.hpp>

#include "few_bodies.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

/// A cell of 2.5 mm and a ninth node, flattened across z to `share` of its height; a body of its own.
struct Cell {
  test::FewBodies few;
  std::vector<tissue::NodeState>& rows;

  explicit Cell(double share) : rows((few.states.solids.resize(1), few.states.solids[0].nodes)) {
    few.models.solids.resize(1);
    constexpr double kEdge = 0.0025;
    for (int i = 0; i < 9; ++i) {
      tissue::NodeState n{};
      const double z = i == 8 ? 2 : i / 4;
      n.x = float(kEdge * (i % 2)), n.y = float(kEdge * (i / 2 % 2)), n.z = float(kEdge * share * z);
      rows.push_back(n);
      few.models.solids[0].network.row_of_node.push_back(i);
    }
  }
  Bodies bodies() { return few.all(); }
};
double weights(const MaterialPoint& p) {
  double sum = 0;
  for (int i = 0; i < p.count; ++i) sum += std::fabs(double(p.weight[std::size_t(i)]));
  return sum;
}

TEST(AffineFit, GoesWithEveryAffineMotionOfItsNodes) {
  Cell cell(1);
  const Vec3d at{0.0009, 0.0014, 0.0017};
  const MaterialPoint point = attach(cell.bodies(), BodyId::organ(0), at);
  EXPECT_LT(weights(point), 1.5);
  const auto moved = [](Vec3d p) {
    return Vec3d{0.001 + 1.2 * p.x + 0.3 * p.z, 0.9 * p.y - 0.2 * p.x, p.z + 0.1 * p.y};
  };
  for (tissue::NodeState& n : cell.rows) {
    const Vec3d to = moved({double(n.x), double(n.y), double(n.z)});
    n.x = float(to.x), n.y = float(to.y), n.z = float(to.z);
  }
  EXPECT_LT(length(place_of(cell.bodies(), point) - moved(at)), 1e-6);
}

TEST(AffineFit, InACrushedCellFollowsItsNodesAndIsNotFlungAbout) {
  for (const double share : {0.1, 0.02, 0.004, 0.0}) {
    Cell cell(share);
    const Vec3d at{0.0009, 0.0014, 0.0015};  // above all of them
    const MaterialPoint point = attach(cell.bodies(), BodyId::organ(0), at);
    EXPECT_LE(weights(point), 8) << share;
    EXPECT_LT(length(place_of(cell.bodies(), point) - at), 1e-8);
    cell.rows[3].z += 0.0005f;
    EXPECT_LT(length(place_of(cell.bodies(), point) - at), 0.002) << share;
  }
}

}  // namespace
