// mend() on meshes with everything wrong at once, and on the meshes of the data folder.
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/remesh/remeshed.hpp>
#include <trocar/geometry/remesh/simplified.hpp>
#include <trocar/geometry/remesh/smoothed.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>

#include "broken_meshes.hpp"

namespace trocar::geometry {
namespace {

namespace fs = std::filesystem;

/// A ball with seams, a hole, some turned, doubled and flat triangles, and crumbs of open sheets.
TriMesh wreck(std::uint64_t seed) {
  core::Random random(seed);
  TriMesh mesh = sphere_mesh(0.03, 4);
  const double height = random.uniform(0.025, 0.029);
  mesh = without(mesh, [&](Vec3d p) { return p.x + 0.1 * p.y > height; });
  for (auto& t : mesh.triangles)
    if (random.uniform() < 0.1) std::swap(t[0], t[1]);
  for (int i = 0; i < 10; ++i) {
    const auto t = mesh.triangles[std::size_t(random.uniform() * double(mesh.triangles.size()))];
    mesh.triangles.push_back(t);
    mesh.triangles.push_back({t[0], t[1], t[1]});
  }
  mesh = soup_of(mesh);
  for (Vec3d& p : mesh.positions) p += 1e-9 * Vec3d{random.uniform(), random.uniform(), random.uniform()};
  const int n = int(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {{0.05, 0, 0}, {0.0501, 0, 0}, {0.05, 0.0001, 0}, {0.1, 0.1, 0.1}});
  mesh.triangles.push_back({n, n + 1, n + 2});
  mesh.positions.push_back({std::nan(""), 0, 0});
  mesh.triangles.push_back({0, 1, n + 4});
  return mesh;
}

const fs::path kData = fs::path(TROCAR_SOURCE_DIR) / "../shared/data";

class SharedSurface : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kData)) GTEST_SKIP() << "the data folder " << kData << " is absent";
  }
  static SurfaceFile file(const std::string& name) { return read_surface_file(kData / name); }
  static const TriMesh& part(const SurfaceFile& of, const std::string& name) {
    for (const SurfacePart& p : of.parts)
      if (p.name == name) return p.mesh;
    throw std::runtime_error("no part " + name);
  }
};

}  // namespace

TEST(Mend, ABodyStaysAsItIsToTheBit) {
  const TriMesh ball = sphere_mesh(0.03, 3);
  const MendedMesh same = mend(ball);
  EXPECT_EQ(same.mesh.positions, ball.positions);
  EXPECT_EQ(same.mesh.triangles, ball.triangles);
  EXPECT_TRUE(same.changes.empty() && same.left.empty());
  EXPECT_TRUE(same.after.is_body());
}

TEST(Mend, WhateverIsWrongAtOnceABallComesOutOfIt) {
  const double exact = volume(sphere_mesh(0.03, 4));
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const MendedMesh good = mend(wreck(seed));
    EXPECT_TRUE(good.after.is_body()) << seed << '\n' << in_words(good.after);
    EXPECT_TRUE(good.left.empty());
    EXPECT_EQ(good.after.shells.list.size(), 1u);
    EXPECT_NEAR(good.after.volume, exact, 0.015 * exact);
    EXPECT_FALSE(good.was_refilled);
    EXPECT_TRUE(mend(good.mesh).changes.empty()) << "mending twice is mending once";
    EXPECT_GE(good.changes.size(), 5u);
  }
}

TEST(Mend, BodiesThatOverlapBecomeOneAndCavitiesStay) {
  const TriMesh two = together(sphere_mesh(0.03, 3), moved(sphere_mesh(0.03, 3), {0.04, 0, 0}));
  const TriMesh hollow = together(two, moved(turned_inside_out(sphere_mesh(0.01, 2)), {-0.005, 0, 0}));
  const MendedMesh one = mend(hollow);
  EXPECT_TRUE(one.after.is_body());
  EXPECT_EQ(one.after.shells.list.size(), 2u);
  EXPECT_NEAR(one.after.volume, volume(mend(two).mesh) - volume(sphere_mesh(0.01, 2)), 1e-12);
  EXPECT_STREQ(one.changes.front().remedy, "resolved");
}

TEST(Mend, WhatCannotBeMendedIsToldAndTheRestIsMended) {
  const TriMesh sheet = without(sphere_mesh(0.03, 4), [](Vec3d p) { return p.z < 0.025; });
  const TriMesh mesh = together(sheet, moved(soup_of(box_mesh({0.01, 0.01, 0.01})), {0.1, 0, 0}));
  const MendedMesh half = mend(mesh);
  EXPECT_FALSE(half.after.is_body());
  ASSERT_EQ(half.left.size(), 2u);
  EXPECT_NE(half.left[0].find("a sheet of"), std::string::npos);
  EXPECT_NE(half.left[1].find("1 hole"), std::string::npos);
  int closed = 0;
  for (const Shell& shell : half.after.shells.list) closed += shell.closed();
  EXPECT_EQ(closed, 1);
}

TEST(Mend, NothingStaysNothing) {
  for (const TriMesh& none : {TriMesh{}, TriMesh{{{0, 0, 0}}, {}}, TriMesh{{{0, 0, 0}, {1, 0, 0}}, {{0, 0, 1}}},
                              TriMesh{{{std::nan(""), 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}}) {
    const MendedMesh out = mend(none);
    EXPECT_TRUE(out.mesh.triangles.empty());
    EXPECT_FALSE(out.after.is_body());
  }
}

TEST(Mend, RandomSoupsAlwaysComeToAnEndAndTellTheTruth) {
  int bodies = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    core::Random random(seed);
    TriMesh mesh;
    const int vertices = 4 + int(random.uniform() * 20), triangles = 4 + int(random.uniform() * 40);
    const bool on_grid = seed % 2 == 0;  // much in one plane
    for (int v = 0; v < vertices; ++v) {
      const auto at = [&] { return on_grid ? double(int(random.uniform() * 4)) : random.uniform(); };
      const double x = at(), y = at(), z = at();
      mesh.positions.push_back({x, y, z});
    }
    for (int t = 0; t < triangles; ++t) {
      const auto corner = [&] { return int(random.uniform() * vertices); };
      const int a = corner(), b = corner(), c = corner();
      mesh.triangles.push_back({a, b, c});
    }
    MendOptions options;
    options.holes.sheets = seed % 3 == 0;
    options.refilling.most_cells = 20'000;
    const MendedMesh out = mend(mesh, options);
    EXPECT_EQ(examine(out.mesh).is_body(), out.after.is_body()) << seed;
    EXPECT_EQ(out.left.empty(), out.after.is_body() || out.mesh.triangles.empty()) << seed;
    bodies += out.after.is_body();
  }
  EXPECT_GT(bodies, 3);
}

TEST(Mend, GivesTheSameMeshEveryTime) {
  const TriMesh mesh = wreck(3);
  const MendedMesh a = mend(mesh), b = mend(mesh);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
}

// The value was printed once by gcc 12 on x86-64; every other compiler and machine must find the same.
TEST(Mend, GivesTheSameBitsOnEveryCompiler) {
  const TriMesh heap = together(together(box_mesh({1, 1, 1}), moved(sphere_mesh(0.6, 3), {0.9, 0.4, 0.3})),
                                moved(box_mesh({0.5, 1, 0.7}), {0.5, 0, 0.3}));
  const TriMesh bowl = together(without(sphere_mesh(0.03, 3), [](Vec3d p) { return p.z > 0.02; }),
                                turned_inside_out(without(sphere_mesh(0.025, 3), [](Vec3d p) { return p.z > 0.019; })));
  core::Hasher hasher;
  for (const TriMesh& mesh :
       {mend(wreck(3)).mesh, mend(heap).mesh, mend(bowl).mesh, simplified(sphere_mesh(0.03, 4), 500).mesh,
        remeshed(sphere_mesh(0.03, 3), 0.004).mesh, smoothed(sphere_mesh(0.03, 3), 5).mesh}) {
    hasher.add(mesh.positions);
    hasher.add(mesh.triangles);
  }
  EXPECT_EQ(hasher.value(), 0x8350b3ec83589fe1ull) << std::hex << hasher.value();
}

TEST_F(SharedSurface, TheGallbladderIsClosedWithItsMillilitresAndLosesItsCrossings) {
  const SurfaceFile glb = file("anatomy/hubmap_ccf/VH_F_Gallbladder.glb");
  ASSERT_EQ(glb.parts.size(), 1u);
  EXPECT_EQ(glb.format, "glTF 2.0, binary");
  EXPECT_EQ(glb.metres, 1);
  const MendedMesh good = mend(glb.parts[0].mesh);
  EXPECT_EQ(good.before.triangles, 2396);
  EXPECT_TRUE(good.before.holes.empty());
  EXPECT_GT(good.before.crossings.size(), 0u);
  EXPECT_NEAR(good.before.volume * 1e6, 5.17, 0.01);
  EXPECT_TRUE(good.after.is_body());
  EXPECT_NEAR(good.after.volume, good.before.volume, 1e-3 * good.before.volume);
}

TEST_F(SharedSurface, AnOvaryIsABodyAsItIs) {
  const SurfaceFile glb = file("anatomy/hubmap_ccf/VH_F_Ovary_L.glb");
  EXPECT_TRUE(mend(glb.parts.at(0).mesh).changes.empty());
  EXPECT_NEAR(examine(glb.parts.at(0).mesh).volume * 1e6, 1.0, 0.01);
}

TEST_F(SharedSurface, TheTransverseColonKeepsItsLumen) {
  const SurfaceFile glb = file("anatomy/hubmap_ccf/SBU_F_Intestine_Large.glb");
  const MendedMesh good = mend(part(glb, "VH_F_transverse_colon"));
  EXPECT_EQ(good.before.shells.list.size(), 2u);
  EXPECT_EQ(good.before.holes.size(), 4u);
  EXPECT_TRUE(good.after.is_body());
  EXPECT_EQ(good.after.shells.list.size(), 1u) << "outer and inner surface hang together by rings";
  EXPECT_EQ(good.changes.front().words, "2 walls closed by rings between their rims");
}

TEST_F(SharedSurface, AnImpressionOfTheLiverIsASheet) {
  const SurfaceFile glb = file("anatomy/hubmap_ccf/VH_F_Liver.glb");
  EXPECT_EQ(glb.parts.size(), 26u);
  const MendedMesh sheet = mend(part(glb, "VH_F_gastric_impression_of_liver"));
  EXPECT_FALSE(sheet.after.is_body());
  EXPECT_EQ(sheet.left.front().substr(0, 21), "a sheet of 80.8 cm2 i");
}

TEST_F(SharedSurface, JawsWithCrowdedEdgesBecomeBodies) {
  for (const char* name : {"forceps_jaw_left", "forceps_jaw_right", "single_action_forceps_jaw"}) {
    SCOPED_TRACE(name);
    const SurfaceFile stl = file(std::string("instruments/sofa_env/") + name + ".stl");
    TriMesh mesh = stl.parts.at(0).mesh;
    for (Vec3d& p : mesh.positions) p *= 0.001;
    const MendedMesh good = mend(mesh);
    EXPECT_GT(good.before.crowded_edges.size(), 0u);
    EXPECT_TRUE(good.after.is_body()) << in_words(good.after);
    EXPECT_NEAR(good.after.volume, good.before.volume, 1e-3 * good.before.volume);
  }
}

TEST_F(SharedSurface, ALiverOfVtkPolydataHasItsPieces) {
  const SurfaceFile vtk = file("anatomy/sofa/liver.vtk");
  EXPECT_EQ(vtk.format, "VTK 3.0, binary");
  EXPECT_EQ(vtk.parts.at(0).mesh.triangles.size(), 10000u);
}

TEST_F(SharedSurface, WhatWasReadIsWrittenAndReadAgain) {
  const SurfaceFile glb = file("anatomy/hubmap_ccf/VH_F_Pancreas.glb");
  const SurfaceFile obj = read_surfaces(to_obj(glb.parts), "a.obj");
  ASSERT_EQ(obj.parts.size(), glb.parts.size());
  for (std::size_t p = 0; p < obj.parts.size(); ++p) {
    EXPECT_EQ(obj.parts[p].name, glb.parts[p].name);
    EXPECT_EQ(obj.parts[p].mesh.positions, glb.parts[p].mesh.positions);
    EXPECT_EQ(obj.parts[p].mesh.triangles, glb.parts[p].mesh.triangles);
  }
  const TriMesh stl = read_surfaces(to_stl(glb.parts[0].mesh), "a.stl").parts.at(0).mesh;
  EXPECT_EQ(stl.triangles.size(), glb.parts[0].mesh.triangles.size());
  EXPECT_DOUBLE_EQ(area(stl), area(glb.parts[0].mesh)) << "the file had single precision";
}

}  // namespace trocar::geometry
