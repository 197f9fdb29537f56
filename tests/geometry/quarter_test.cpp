#include <gtest/gtest.h>

#include <trocar/geometry/curves/quarter.hpp>
#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry {
namespace {

TriMesh tetrahedron() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}};
}

TriMesh divided(TriMesh mesh) {
  const Quartered finer = quartered(mesh.triangles, int(mesh.positions.size()));
  for (const auto& [a, b] : finer.halved)
    mesh.positions.push_back(0.5 * (mesh.positions[std::size_t(a)] + mesh.positions[std::size_t(b)]));
  mesh.triangles = finer.triangles;
  return mesh;
}

TEST(Quarter, KeepsSurfaceAndOrientation) {
  const TriMesh whole = tetrahedron(), fine = divided(divided(whole));
  EXPECT_EQ(fine.triangles.size(), 16 * whole.triangles.size());
  EXPECT_TRUE(check_edges(fine).closed());
  EXPECT_NEAR(volume(fine), volume(whole), 1e-15);
  EXPECT_NEAR(area(fine), area(whole), 1e-15);
}

TEST(Quarter, HalvesEachEdgeOnce) {
  const TriMesh whole = tetrahedron();
  const Quartered finer = quartered(whole.triangles, 4);
  EXPECT_EQ(finer.halved.size(), edges(whole).size());
  for (const auto& [a, b] : finer.halved) EXPECT_LT(a, b);
}

TEST(Quarter, FourAlike) {
  const TriMesh fine = divided({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}, {{{0, 1, 2}}}});
  for (int t = 0; t < 4; ++t) EXPECT_EQ(area_vector(fine, t), (Vec3d{0, 0, 1}));
}

TEST(Quarter, NothingGivesNothing) {
  const Quartered finer = quartered({}, 7);
  EXPECT_TRUE(finer.triangles.empty());
  EXPECT_TRUE(finer.halved.empty());
}

}  // namespace
}  // namespace trocar::geometry
