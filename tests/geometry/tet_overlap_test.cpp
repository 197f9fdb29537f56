// Cells in each other that share no face are found; cells that touch are not, whatever they touch with.
#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/tets/tet_overlap.hpp>

#include "tets.hpp"

namespace trocar::geometry {
namespace {

/// The block and once more, shifted, with nodes of its own.
TetMesh twice(Vec3d shift) {
  TetMesh mesh = block_of_tets(2, 0.01);
  const TetMesh second = mesh;
  const int nodes = int(mesh.points.size());
  for (const Vec3d p : second.points) mesh.points.push_back(p + shift);
  for (const auto& c : second.cells) mesh.cells.push_back({c[0] + nodes, c[1] + nodes, c[2] + nodes, c[3] + nodes});
  return mesh;
}

TEST(TetOverlap, CellsThatOnlyTouchDoNotOverlap) {
  EXPECT_EQ(cell_overlaps(block_of_tets(4, 0.01)).pairs, 0);
  EXPECT_EQ(cell_overlaps(twice({0.02, 0, 0})).pairs, 0) << "faces, without shared nodes";
  EXPECT_EQ(cell_overlaps(twice({0.02, 0.0037, 0})).pairs, 0) << "faces that do not match";
  EXPECT_EQ(cell_overlaps(twice({0.02 - 1e-7, 0, 0})).pairs, 0) << "a file's rounding";
  EXPECT_EQ(cell_overlaps(twice({0.02, 0.02, 0.02})).pairs, 0) << "corners";
}

TEST(TetOverlap, TwoBodiesPushedIntoOneAnotherAreFoundWhereTheyAre) {
  const CellOverlaps found = cell_overlaps(twice({0.015, 0.001, 0.002}));
  EXPECT_GT(found.pairs, 10);
  EXPECT_NEAR(found.at.x, 0.0175, 0.006);
  EXPECT_EQ(repair(twice({0.015, 0.001, 0.002})).mended.size(), 0u) << "no face tells";
}

TEST(TetOverlap, ACellAcrossAnotherOneThatSharesACornerOrAnEdgeIsFound) {
  TetMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.4, 0.1, 0.1}, {0.1, 0.4, 0.1}, {0.1, 0.1, 0.4}};
  mesh.cells = {{0, 1, 2, 3}, {0, 4, 5, 6}};
  EXPECT_EQ(cell_overlaps(mesh).pairs, 1);
  mesh.cells[1] = {0, 1, 5, 6};
  EXPECT_EQ(cell_overlaps(mesh).pairs, 1);
  mesh.points[5] = {0.1, -0.4, 0.1}, mesh.points[6] = {0.1, -0.1, -0.4};
  EXPECT_EQ(cell_overlaps(mesh).pairs, 0);
}

TEST(TetOverlap, RandomCellsAreFoundAndHostileOnesBoundIt) {
  core::Random random(1);
  TetMesh mesh;
  const auto cells = [&](int count) {
    for (int i = 0; i < count; ++i) {
      const int n = int(mesh.points.size());
      for (int k = 0; k < 4; ++k) mesh.points.push_back({random.uniform(), random.uniform(), random.uniform()});
      mesh.cells.push_back({n, n + 1, n + 2, n + 3});
    }
  };
  cells(300);
  EXPECT_EQ(cell_overlaps(mesh).pairs, kMostOverlaps);
  cells(100'000);
  EXPECT_EQ(cell_overlaps(mesh).pairs, kMostOverlaps);
  EXPECT_EQ(in_words(cell_overlaps(mesh)).rfind("1000 or more pairs of cells", 0), 0u);
}

}  // namespace
}  // namespace trocar::geometry
