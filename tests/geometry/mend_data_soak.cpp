// Surfaces of the data folder, mended: a row of docs/log/meshes.md for each file, and what single ones are known to be.
//
//   build/release/tests/geometry/geometry_soak --gtest_filter='MendedData.*'
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

namespace trocar::geometry {
namespace {

namespace fs = std::filesystem;

const fs::path kDataFolder = fs::path(TROCAR_SOURCE_DIR) / "../shared/data";

double ms_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::vector<fs::path> surface_paths() {
  std::vector<fs::path> out;
  for (const char* folder : {"anatomy/hubmap_ccf", "anatomy/sofa", "anatomy/sofa_env_scenes", "instruments/sofa_env"})
    for (const auto& entry : fs::recursive_directory_iterator(kDataFolder / folder)) {
      const std::string ending = entry.path().extension().string();
      if (ending == ".glb" || ending == ".obj" || ending == ".stl" || ending == ".vtk" || ending == ".ply")
        out.push_back(entry.path());
    }
  std::sort(out.begin(), out.end());
  return out;
}

/// Sums over a file's parts.
struct Row {
  int parts = 0, vertices = 0, triangles = 0, holes = 0, crossings = 0, others = 0, bodies = 0, sheets = 0, anew = 0;
  double before = 0, after = 0;  ///< [ml] of the parts that are bodies in the end
  double read_ms = 0, mend_ms = 0;

  void add(const MendedMesh& m) {
    const Diagnosis& d = m.before;
    ++parts;
    vertices += d.vertices;
    triangles += d.triangles;
    holes += int(d.holes.size());
    crossings += int(d.crossings.size());
    others += int(d.degenerate.size() + d.duplicate_triangles.size() + d.crowded_edges.size() +
                  d.pinched_vertices.size() + d.turned_edges.size() + d.duplicate_vertices.size());
    anew += m.was_refilled;
    if (!m.after.is_body()) {
      ++sheets;
      return;
    }
    ++bodies;
    before += 1e6 * d.volume;
    after += 1e6 * m.after.volume;
  }
  void print(const std::string& name) const {
    std::printf("| `%s` | %d | %d | %d | %d | %d | %d | %d | %d | %.4g | %.4g | %.1f | %.0f |\n", name.c_str(), parts,
                vertices, triangles, holes, crossings, others, bodies, sheets, before, after, read_ms, mend_ms);
  }
};

class SharedSurface : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kDataFolder)) GTEST_SKIP() << "the data folder " << kDataFolder << " is absent";
  }
  static SurfaceFile file(const std::string& name) { return read_surface_file(kDataFolder / name); }
  static const TriMesh& part(const SurfaceFile& of, const std::string& name) {
    for (const SurfacePart& p : of.parts)
      if (p.name == name) return p.mesh;
    throw std::runtime_error("no part " + name);
  }
};

}  // namespace

TEST(MendedData, EveryPartOfEveryFileBecomesABodyOrSaysWhyNot) {
  if (!fs::exists(kDataFolder)) GTEST_SKIP() << "the data folder " << kDataFolder << " is absent";
  std::printf(
      "| file | parts | vertices | triangles | holes | crossings | other faults | bodies | left open | ml before "
      "| ml after | ms to read | ms to mend |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  Row all;
  int files = 0;
  for (const fs::path& path : surface_paths()) {
    Row row;
    const auto start = std::chrono::steady_clock::now();
    SurfaceFile file;
    try {
      file = read_surface_file(path);
    } catch (const core::BadInput& bad) {  // tetrahedra in VTK
      EXPECT_NE(std::string(bad.what()).find("expected POLYDATA, as surfaces need"), std::string::npos) << bad.what();
      continue;
    }
    row.read_ms = ms_since(start);
    const double metres = file.metres > 0 ? file.metres : guess_unit({bounds(joined(file).positions), 0}).metres;
    for (SurfacePart& part : file.parts) {
      for (Vec3d& p : part.mesh.positions) p *= metres > 0 ? metres : 1;
      const auto from = std::chrono::steady_clock::now();
      const MendedMesh mended = mend(part.mesh);
      row.mend_ms += ms_since(from);
      row.add(mended);
      all.add(mended);
      EXPECT_EQ(mended.left.empty(), mended.after.is_body()) << path << ' ' << part.name;
      EXPECT_TRUE(mended.after.is_body() || mended.left.front().substr(0, 10) == "a sheet of")
          << path << ' ' << part.name << '\n'
          << in_words(mended.after);
    }
    row.print(path.filename().string());
    all.read_ms += row.read_ms;
    all.mend_ms += row.mend_ms;
    ++files;
  }
  all.print("all");
  EXPECT_GT(files, 50);
  EXPECT_EQ(all.anew, 0) << "nothing had to be made anew";
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
