#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/numerics/portable.hpp>

#include "shapes.hpp"

using namespace trocar;
using namespace trocar::geometry;

TEST(TriMesh, AreaVolumeAndCentreOfABoxAreThoseOfTheBox) {
  TriMesh box = box_mesh({1, 2, 3});
  for (Vec3d& p : box.positions) p += Vec3d{10, 20, 30};
  EXPECT_NEAR(area(box), 2 * (2 + 6 + 3), 1e-12);
  EXPECT_NEAR(volume(box), 6, 1e-12);
  EXPECT_LT(length(centre_of_volume(box) - Vec3d{10.5, 21, 31.5}), 1e-12);
  const Bounds b = bounds(box.positions);
  EXPECT_EQ(b.low, (Vec3d{10, 20, 30}));
  EXPECT_EQ(b.high, (Vec3d{11, 22, 33}));
}

TEST(TriMesh, NormalsOfASphereAreRadialExactly) {
  const TriMesh sphere = sphere_mesh(0.05, 2);
  const auto normals = vertex_normals(sphere);
  for (std::size_t i = 0; i < normals.size(); ++i)
    EXPECT_LT(length(normals[i] - normalised(sphere.positions[i])), 1e-12);
}

TEST(TriMesh, EdgeCheckTellsHolesCrowdedEdgesAndTurnedTriangles) {
  TriMesh box = box_mesh({1, 1, 1});
  EXPECT_TRUE(check_edges(box).closed());
  EXPECT_EQ(check_edges(box).edges, 18);
  TriMesh holed = box;
  holed.triangles.pop_back();
  EXPECT_EQ(check_edges(holed).open, 3);
  TriMesh turned = box;
  std::swap(turned.triangles[0][1], turned.triangles[0][2]);
  EXPECT_EQ(check_edges(turned).inconsistent, 3);
  TriMesh crowded = box;
  crowded.triangles.push_back(box.triangles[0]);
  EXPECT_EQ(check_edges(crowded).crowded, 3);
  EXPECT_FALSE(check_edges(TriMesh{}).closed());
}

TEST(TriMesh, NeighboursAreMutualSortedAndThoseOfTheEdges) {
  const TriMesh sphere = sphere_mesh(1.0, 2);
  const Csr neighbours = vertex_neighbours(sphere);
  std::size_t total = 0;
  for (int i = 0; i < neighbours.rows(); ++i) {
    const auto row = neighbours.row(i);
    total += row.size();
    EXPECT_TRUE(std::is_sorted(row.begin(), row.end()));
    for (int j : row) {
      const auto back = neighbours.row(j);
      EXPECT_TRUE(std::binary_search(back.begin(), back.end(), i));
    }
  }
  EXPECT_EQ(total, 2 * edges(sphere).size());
  const int v = int(sphere.positions.size()), t = int(sphere.triangles.size());
  EXPECT_EQ(v - int(edges(sphere).size()) + t, 2);  // Euler
  const Csr triangles = vertex_triangles(sphere);
  for (int i = 0; i < triangles.rows(); ++i) EXPECT_EQ(triangles.row(i).size(), neighbours.row(i).size());
}

TEST(TriMesh, MergingVerticesClosesSeams) {
  const TriMesh box = box_mesh({1, 1, 1});
  TriMesh soup;
  for (const auto& t : box.triangles) {
    const int n = int(soup.positions.size());
    for (int k : t) soup.positions.push_back(box.positions[k]);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  EXPECT_FALSE(check_edges(soup).closed());
  const TriMesh merged = merged_vertices(soup, 1e-6);
  EXPECT_TRUE(check_edges(merged).closed());
  EXPECT_EQ(merged.positions.size(), 8u);
}
