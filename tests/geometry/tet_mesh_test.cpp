#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/tets/tet_mesh.hpp>

#include "tets.hpp"

namespace trocar::geometry {
namespace {

std::vector<std::string> words(const TetRepair& repair) {
  std::vector<std::string> out;
  for (const Mended& m : repair.mended) out.push_back(in_words(m));
  return out;
}
using Words = std::vector<std::string>;

bool same_bits(const TetMesh& a, const TetMesh& b) {
  return a.cells == b.cells && a.region == b.region && a.points.size() == b.points.size() &&
         std::memcmp(a.points.data(), b.points.data(), a.points.size() * sizeof(Vec3d)) == 0;
}

/// A block with everything wrong that repair() mends.
TetMesh spoilt(unsigned seed) {
  core::Random random(seed);
  TetMesh mesh = block_of_tets(3, 0.01);
  mesh.region.assign(mesh.cells.size(), 7);
  const auto any = [&](std::size_t count) { return int(random.uniform() * double(count)); };
  for (int i = 0; i < 10; ++i) {
    auto& cell = mesh.cells[any(mesh.cells.size())];
    std::swap(cell[any(4)], cell[any(4)]);  // upside down, or not
  }
  for (int i = 0; i < 5; ++i) mesh.cells.push_back(mesh.cells[any(mesh.cells.size())]);
  for (int i = 0; i < 5; ++i) {
    mesh.points.push_back(mesh.points[any(mesh.points.size())]);
    mesh.cells[any(mesh.cells.size())][any(4)] = int(mesh.points.size()) - 1;  // flat, overlapping, or torn off
  }
  for (int i = 0; i < 5; ++i)
    mesh.cells.push_back(
        {any(mesh.points.size()), any(mesh.points.size()), any(mesh.points.size()), any(mesh.points.size())});
  mesh.points.push_back({5, 5, 5});
  mesh.region.resize(mesh.cells.size(), 8);
  return mesh;
}

}  // namespace

TEST(TetMesh, FactsOfOneCellAreThoseOfGeometry) {
  const TetFacts f = inspect(corner_tet());
  EXPECT_EQ(f.nodes, 4);
  EXPECT_EQ(f.cells, 1);
  EXPECT_DOUBLE_EQ(f.volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(f.smallest_volume, 1.0 / 6);
  EXPECT_DOUBLE_EQ(f.largest_volume, 1.0 / 6);
  EXPECT_NEAR(f.smallest_dihedral, std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi, 1e-10);
  EXPECT_EQ(f.box.high, (Vec3d{1, 1, 1}));
  EXPECT_EQ(f.surface_triangles, 4);
  EXPECT_EQ(f.odd_edges, 0);
  EXPECT_EQ(f.parts, 1);
  EXPECT_TRUE(f.sound());
}

TEST(TetMesh, ABlockIsSoundClosedAndOne) {
  const TetFacts f = inspect(block_of_tets(4, 0.01));
  EXPECT_EQ(f.cells, 6 * 64);
  EXPECT_NEAR(f.volume, 64e-6, 1e-18);
  EXPECT_NEAR(f.smallest_dihedral, 45, 1e-9);
  EXPECT_EQ(f.surface_triangles, 6 * 16 * 2);
  EXPECT_EQ(f.odd_edges + f.crowded_faces, 0);
  EXPECT_EQ(f.parts, 1);
  EXPECT_TRUE(f.sound());
}

TEST(TetMesh, ASoundMeshIsLeftAsItIsToTheBit) {
  const TetMesh mesh = block_of_tets(3, 0.01);
  const TetRepair r = repair(mesh);
  EXPECT_EQ(words(r), Words{});
  EXPECT_TRUE(same_bits(r.mesh, mesh));
}

TEST(TetMesh, TheSurfaceIsClosedFacesOutwardsAndHoldsTheVolume) {
  TetMesh mesh = block_of_tets(3, 0.01);
  std::swap(mesh.cells[5][0], mesh.cells[5][1]);  // also where a cell is upside down
  std::swap(mesh.cells[100][2], mesh.cells[100][3]);
  const TetSurface s = surface_of(mesh);
  EXPECT_TRUE(check_edges(s.mesh).closed());
  EXPECT_NEAR(volume(s.mesh), 27e-6, 1e-18);
  ASSERT_EQ(s.node.size(), s.mesh.positions.size());
  EXPECT_EQ(s.node.size(), 64u - 8u);  // the inner nodes are not in it
  for (std::size_t v = 0; v < s.node.size(); ++v) EXPECT_EQ(s.mesh.positions[v], mesh.points[s.node[v]]);
  EXPECT_TRUE(std::is_sorted(s.node.begin(), s.node.end()));
}

TEST(TetMesh, InvertedCellsAreTurned) {
  TetMesh mesh = block_of_tets(2, 1);
  std::swap(mesh.cells[3][0], mesh.cells[3][1]);
  std::swap(mesh.cells[8][1], mesh.cells[8][3]);
  EXPECT_EQ(inspect(mesh).inverted, 2);
  EXPECT_NEAR(inspect(mesh).volume, 8, 1e-12);
  EXPECT_NEAR(inspect(mesh).smallest_dihedral, 45, 1e-9);
  const TetRepair r = repair(mesh);
  EXPECT_EQ(words(r), Words{"2 inverted cells turned"});
  for (int c = 0; c < int(r.mesh.cells.size()); ++c) EXPECT_GT(volume(r.mesh, c), 0);
  EXPECT_TRUE(inspect(r.mesh).sound());
}

TEST(TetMesh, FlatCellsAreLeftOutWhateverTheirSize) {
  TetMesh mesh = corner_tet();
  const auto add = [&](Vec3d a, Vec3d b, Vec3d c, Vec3d d) {
    const int n = int(mesh.points.size());
    for (const Vec3d p : {a, b, c, d}) mesh.points.push_back(p);
    mesh.cells.push_back({n, n + 1, n + 2, n + 3});
  };
  add({2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {2, 1, 0});               // in a plane
  add({2, 0, 1}, {3, 0, 1}, {3, 1, 1 + 1e-9}, {2, 1, 1});        // nearly
  add({4, 0, 0}, {4 + 1e-4, 0, 0}, {4, 1e-4, 0}, {4, 0, 1e-4});  // well shaped, but next to nothing
  add({5, 0, 0}, {5.02, 0, 0}, {5, 0.02, 0}, {5, 0, 0.02});      // small and good
  mesh.cells.push_back({0, 1, 1, 3});                            // a corner twice
  EXPECT_EQ(inspect(mesh).flat, 4);
  const TetRepair r = repair(mesh);
  EXPECT_EQ(words(r), (Words{"4 flat cells left out", "12 nodes without a cell left out"}));
  EXPECT_EQ(r.mesh.cells.size(), 2u);
  EXPECT_TRUE(inspect(r.mesh).sound());
}

TEST(TetMesh, NodesOfASeamBecomeOneAndPartsHangTogether) {
  const TetMesh block = block_of_tets(2, 1);
  TetMesh loose;  // every cell with nodes of its own
  for (const auto& cell : block.cells) {
    const int n = int(loose.points.size());
    for (const int node : cell) loose.points.push_back(block.points[node]);
    loose.cells.push_back({n, n + 1, n + 2, n + 3});
  }
  EXPECT_EQ(inspect(loose).parts, 48);
  EXPECT_EQ(inspect(loose).duplicate_nodes, 4 * 48 - 27);
  const TetRepair r = repair(loose);
  EXPECT_EQ(words(r), Words{"165 duplicate nodes merged"});
  EXPECT_EQ(r.mesh.points.size(), 27u);
  EXPECT_EQ(inspect(r.mesh).parts, 1);
  EXPECT_EQ(inspect(r.mesh).odd_edges, 0);
}

TEST(TetMesh, MergingTakesWhatIsWithinTheToleranceAndNothingElse) {
  const auto two_cells = [](double gap) {
    TetMesh mesh = corner_tet();
    for (const Vec3d p : corner_tet().points) mesh.points.push_back({-p.x - gap, p.y, p.z});
    mesh.cells.push_back({4, 5, 7, 6});
    return mesh;
  };
  const double size = length(Vec3d{2, 1, 1});
  EXPECT_EQ(inspect(two_cells(0.99e-6 * size)).duplicate_nodes, 3);
  EXPECT_EQ(inspect(two_cells(1.01e-6 * size)).duplicate_nodes, 0);
  EXPECT_EQ(inspect(two_cells(0.009 * size), 0.01).duplicate_nodes, 3);
  EXPECT_EQ(inspect(two_cells(0), 0).duplicate_nodes, 3);
  EXPECT_EQ(inspect(two_cells(1e-12), 0).duplicate_nodes, 0);
}

TEST(TetMesh, AChainOfNearNodesDoesNotBecomeOnePlace) {
  TetMesh mesh = corner_tet();
  const double tolerance = 1e-3, step = 0.6 * tolerance * std::sqrt(3.0);
  for (int i = 0; i <= 10; ++i) {  // in a row, 0.6 tolerances apart: every second one stays
    mesh.points.push_back({0.1 + step * i, 0, 0});
    mesh.cells.push_back({4 + i, 1, 2, 3});
  }
  EXPECT_EQ(inspect(mesh, tolerance).duplicate_nodes, 5);
}

TEST(TetMesh, DuplicateCellsGoAndTheFirstStays) {
  TetMesh mesh = corner_tet();
  mesh.cells = {{0, 1, 2, 3}, {3, 1, 2, 0}, {1, 2, 0, 3}};
  mesh.region = {5, 6, 7};
  EXPECT_EQ(inspect(mesh).duplicate_cells, 2);
  const TetRepair r = repair(mesh);
  EXPECT_EQ(words(r), Words{"2 duplicate cells left out"});
  EXPECT_EQ(r.mesh.region, std::vector<int>{5});
}

TEST(TetMesh, OfCellsThatOverlapAtAFaceTheFirstStays) {
  TetMesh mesh = corner_tet();
  mesh.points.push_back({0.5, 0.5, 2});
  mesh.cells.push_back({0, 1, 2, 4});  // on the same side of (0, 1, 2)
  EXPECT_EQ(inspect(mesh).overlapping_faces, 1);
  EXPECT_EQ(inspect(mesh).crowded_faces, 0);
  mesh.points.push_back({0, 0, -1});
  mesh.cells.push_back({0, 2, 1, 5});
  EXPECT_EQ(inspect(mesh).crowded_faces, 1);
  const TetRepair r = repair(mesh);
  EXPECT_EQ(words(r), (Words{"1 cell that overlaps its neighbour left out", "1 node without a cell left out"}));
  EXPECT_EQ(r.mesh.cells.size(), 2u);
}

TEST(TetMesh, PartsThatTouchInAnEdgeAreCountedAndLeft) {
  TetMesh mesh = corner_tet();  // the second one has edge (0, 3) in common with it
  mesh.points.push_back({-1, 0, 0});
  mesh.points.push_back({0, -1, 0});
  mesh.cells.push_back({0, 4, 5, 3});
  const TetFacts f = inspect(mesh);
  EXPECT_EQ(f.parts, 2);
  EXPECT_EQ(f.odd_edges, 1);
  EXPECT_EQ(words(repair(mesh)), Words{});
}

TEST(TetMesh, AFarNodeThatNothingUsesDoesNotMakeTheMeshSmall) {
  TetMesh mesh = block_of_tets(2, 1e-3);
  mesh.points.push_back({1e6, 0, 0});
  EXPECT_EQ(inspect(mesh).flat + inspect(mesh).duplicate_nodes, 0);
  EXPECT_EQ(inspect(mesh).unused_nodes, 1);
  EXPECT_EQ(words(repair(mesh)), Words{"1 node without a cell left out"});
}

TEST(TetMesh, WhateverIsWrongRepairMendsItAndTwiceIsAsGoodAsOnce) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const TetMesh mesh = spoilt(seed);
    const TetRepair once = repair(mesh);
    EXPECT_FALSE(inspect(mesh).sound());
    EXPECT_TRUE(inspect(once.mesh).sound());
    EXPECT_EQ(inspect(once.mesh).crowded_faces, 0);
    EXPECT_EQ(once.mesh.region.size(), once.mesh.cells.size());
    const TetRepair twice = repair(once.mesh);
    EXPECT_EQ(words(twice), Words{});
    EXPECT_TRUE(same_bits(twice.mesh, once.mesh));
    EXPECT_TRUE(same_bits(repair(mesh).mesh, once.mesh));
    EXPECT_EQ(check_edges(surface_of(once.mesh).mesh).open, 0);
    EXPECT_NEAR(volume(surface_of(once.mesh).mesh), inspect(once.mesh).volume, 1e-12 * inspect(mesh).volume);
  }
}

TEST(TetMesh, NoCellsAndNoNodesAreFactsToo) {
  EXPECT_EQ(inspect({}).cells, 0);
  EXPECT_EQ(inspect({{{1, 2, 3}}, {}, {}}).unused_nodes, 1);
  EXPECT_TRUE(repair({{{1, 2, 3}}, {}, {}}).mesh.points.empty());
  const TetMesh point{{{1, 1, 1}}, {{0, 0, 0, 0}}, {}};
  EXPECT_EQ(inspect(point).flat, 1);
  EXPECT_TRUE(repair(point).mesh.cells.empty());
  EXPECT_TRUE(surface_of({}).mesh.triangles.empty());
}

}  // namespace trocar::geometry
