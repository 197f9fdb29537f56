// What every format of surfaces has in common: the same shape, hostile bytes, what is written is read.
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/geometry/surface_files/unit_guess.hpp>

#include "shapes.hpp"
#include "surface_bytes.hpp"

namespace trocar::geometry {
namespace {

std::string surface_faults(const std::string& bytes, const std::string& path = "a") {
  try {
    read_surfaces(bytes, path);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

/// The places of every triangle's corners.
std::vector<std::array<Vec3d, 3>> corners_of(const TriMesh& mesh) {
  std::vector<std::array<Vec3d, 3>> out;
  for (const auto& [a, b, c] : mesh.triangles) out.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  return out;
}
/// In an order that does not depend on which triangle came first.
std::vector<std::array<Vec3d, 3>> sorted_corners(const TriMesh& mesh) {
  const auto key = [](Vec3d p) { return std::array<double, 3>{p.x, p.y, p.z}; };
  auto out = corners_of(mesh);
  for (auto& t : out) {
    const auto least = std::min_element(t.begin(), t.end(), [&](Vec3d a, Vec3d b) { return key(a) < key(b); });
    std::rotate(t.begin(), least, t.end());
  }
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    return std::array{key(a[0]), key(a[1]), key(a[2])} < std::array{key(b[0]), key(b[1]), key(b[2])};
  });
  return out;
}

TriMesh scattered(std::uint64_t seed) {
  core::Random random(seed);
  TriMesh mesh = sphere_mesh(0.05, 2);
  for (Vec3d& p : mesh.positions) p += {random.uniform(-1e-3, 1e-3), random.uniform() * 1e-17, -random.uniform()};
  return mesh;
}

}  // namespace

TEST(SurfaceFiles, OneShapeIsTheSameFromEveryFormat) {
  const auto expected = sorted_corners(axes_mesh());
  for (const std::string& bytes : axes_in_all_formats()) {
    const SurfaceFile file = read_surfaces(bytes, "axes.any");
    SCOPED_TRACE(file.format);
    const TriMesh mesh = merged_equal(joined(file));
    EXPECT_EQ(sorted_corners(mesh), expected);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_TRUE(check_edges(mesh).closed());
    EXPECT_DOUBLE_EQ(volume(mesh), 1);
    EXPECT_EQ(file.parts.front().name.substr(0, 4), "axes");
  }
}

TEST(SurfaceFiles, FormatsAreToldByTheirBytesWhateverTheNameSays) {
  const char* formats[] = {
      "OBJ",           "STL, text",       "STL, binary",    "PLY, text",       "PLY, binary", "PLY, binary, big-endian",
      "VTK 3.0, text", "VTK 5.1, binary", "glTF 2.0, text", "glTF 2.0, binary"};
  const std::vector<std::string> files = axes_in_all_formats();
  for (std::size_t i = 0; i < files.size(); ++i)
    EXPECT_EQ(read_surfaces(files[i], "wrong.name.stl").format, formats[i]);
}

TEST(SurfaceFiles, LineEndsOfOtherSystemsAreLineEnds) {
  for (const std::string& bytes : {kAxesObj, kAxesStl, kAxesPly, kAxesVtk, axes_gltf_embedded()}) {
    std::string other;
    for (const char c : bytes) other += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(sorted_corners(joined(read_surfaces(other, "a"))), sorted_corners(axes_mesh()));
  }
}

TEST(SurfaceFiles, WhatIsWrittenReadsAsTheSameBits) {
  const TriMesh mesh = scattered(4);
  for (const double scale : {1.0, 0.5})
    for (const std::string& bytes : {to_obj(mesh, scale), to_ply(mesh, scale), to_polydata(mesh, scale)}) {
      TriMesh back = read_surfaces(bytes, "a").parts.at(0).mesh;
      for (Vec3d& p : back.positions) p *= scale;
      EXPECT_EQ(back.positions, mesh.positions);
      EXPECT_EQ(back.triangles, mesh.triangles);
    }
}

TEST(SurfaceFiles, StlKeepsSinglePrecision) {
  TriMesh mesh = scattered(5);
  const TriMesh back = read_surfaces(to_stl(mesh, 0.001), "a").parts.at(0).mesh;
  for (Vec3d& p : mesh.positions) p = vec_cast<double>(vec_cast<float>(p / 0.001));
  EXPECT_EQ(corners_of(back), corners_of(mesh));
  EXPECT_EQ(back.positions.size(), mesh.positions.size());
}

TEST(SurfaceFiles, ObjKeepsPartsAndTheirNames) {
  const std::vector<SurfacePart> parts{{"liver left", scattered(1)}, {"liver", axes_mesh()}, {"x\ny", axes_mesh()}};
  const SurfaceFile back = read_surfaces(to_obj(parts), "a");
  ASSERT_EQ(back.parts.size(), 3u);
  for (std::size_t p = 0; p < 3; ++p) {
    EXPECT_EQ(back.parts[p].mesh.positions, parts[p].mesh.positions);
    EXPECT_EQ(back.parts[p].mesh.triangles, parts[p].mesh.triangles);
  }
  EXPECT_EQ(back.parts[0].name, "liver left");
  EXPECT_EQ(back.parts[2].name, "x y");
}

TEST(SurfaceFiles, AFileCutOffAnywhereIsAFaultOrASmallerSurface) {
  for (const std::string& bytes : axes_in_all_formats())
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string part = bytes.substr(0, size);
      if (!surface_faults(part).empty()) continue;
      const SurfaceFile file = read_surfaces(part, "a");
      EXPECT_LE(joined(file).triangles.size(), 4u);
      EXPECT_TRUE(file.format == "OBJ" || joined(file).triangles.size() == 4u) << file.format << ' ' << size;
    }
}

TEST(SurfaceFiles, AnyChangedByteIsAFaultOrASurface) {
  core::Random random(11);
  for (const std::string& good : axes_in_all_formats())
    for (int round = 0; round < 1000; ++round) {
      std::string bytes = good;
      bytes[std::size_t(random.uniform() * double(bytes.size()))] = char(int(random.uniform() * 256));
      try {
        for (const SurfacePart& part : read_surfaces(bytes, "a").parts) {
          EXPECT_FALSE(part.mesh.triangles.empty());
          for (const auto& t : part.mesh.triangles)
            for (const int v : t) EXPECT_TRUE(v >= 0 && v < int(part.mesh.positions.size()));
          for (const Vec3d& p : part.mesh.positions)
            for (int k = 0; k < 3; ++k) EXPECT_LE(std::fabs(p[k]), kMostSurfaceCoordinate);
        }
      } catch (const core::BadInput& bad) {
        EXPECT_FALSE(bad.faults().empty());
      }
    }
}

TEST(SurfaceFiles, WhatIsNoSurfaceIsSaidToBeNone) {
  const std::string expected = "a:1:1: expected a surface in OBJ, STL, PLY, glTF 2.0 or legacy VTK, got ";
  EXPECT_EQ(surface_faults(""), expected + "the end of the file");
  EXPECT_EQ(surface_faults("hello"), expected + "'hello'");
  EXPECT_EQ(surface_faults("<?xml version=\"1.0\"?>"), expected + "XML");
  EXPECT_EQ(surface_faults("\x1b[31mred"), expected + "'?[31mred'");
  EXPECT_EQ(surface_faults("v 0 0 0\n"), "a:1:1: expected triangles, got none");
}

TEST(SurfaceFiles, VerticesAtTheSamePlaceBecomeTheFirstOfThem) {
  const TriMesh seam{{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {4, 3, 5}}};
  const TriMesh merged = merged_equal(seam);
  EXPECT_EQ(merged.positions, (std::vector<Vec3d>{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(merged.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 1, 3}}));
}

TEST(SurfaceFiles, FilesAreReadFromTheirFolderAndOthersOnlyBesideThem) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "trocar_surfaces";
  std::filesystem::create_directories(folder);
  const auto write = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
  };
  write("a b.bin", axes_buffer());
  write("good.gltf", axes_gltf(R"(, "uri": "a%20b.bin")"));
  write("bad.gltf", axes_gltf(R"(, "uri": "../a.bin")"));
  write("worse.gltf", axes_gltf(R"(, "uri": "/etc/passwd")"));
  const SurfaceFile file = read_surface_file(folder / "good.gltf");
  EXPECT_EQ(joined(file).triangles.size(), 4u);
  EXPECT_THROW(read_surface_file(folder / "bad.gltf"), core::BadInput);
  EXPECT_THROW(read_surface_file(folder / "worse.gltf"), core::BadInput);
  EXPECT_THROW(read_surface_file(folder / "absent.stl"), core::BadInput);
  std::filesystem::remove_all(folder);
}

TEST(UnitGuess, TheExtentOfAnOrganSuggestsItsUnit) {
  const auto guess = [](double longest) { return guess_unit({{0, 0, 0}, {longest, longest / 2, longest / 3}}); };
  EXPECT_EQ(guess(0.247).metres, 1);
  EXPECT_EQ(guess(380.5).metres, 0.001);
  EXPECT_EQ(guess(6.4).metres, 0.01);
  EXPECT_EQ(guess(6.4).also, (std::vector<double>{0.001}));
  EXPECT_TRUE(guess(380.5).also.empty());
  EXPECT_EQ(guess(28.3).metres, 0.001) << "a jaw: few programs write centimetres";
  EXPECT_EQ(guess(28.3).also, (std::vector<double>{0.01}));
  EXPECT_EQ(guess(1e6).metres, 0);
  EXPECT_EQ(guess(380.5).words, "longest side 380.5: 38 cm in millimetres, 3.81 m in centimetres, 380 m in metres");
  EXPECT_EQ(guess_unit(bounds({})).metres, 0);
}

}  // namespace trocar::geometry
