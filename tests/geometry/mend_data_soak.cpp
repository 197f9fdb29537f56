// Every surface in the data folder, mended: a row of docs/guides/meshes.md for each file.
//
//   build/release/tests/geometry/geometry_soak --gtest_filter='MendedData.*'
#include <chrono>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/repair/mend.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
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

}  // namespace trocar::geometry
