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

TEST(SurfaceFiles, TextIsReadWithCarriageReturnsAndByteOrderMarks) {
  for (const std::string& bytes : {kAxesObj, kAxesStl, kAxesPly, kAxesVtk, axes_gltf_embedded()}) {
    std::string other;
    for (const char c : bytes) other += c == '\n' ? '\r' : c;
    for (const std::string& text : {other, "\xef\xbb\xbf" + bytes, "\xef\xbb\xbf" + other})
      EXPECT_EQ(sorted_corners(joined(read_surfaces(text, "a"))), sorted_corners(axes_mesh())) << text.substr(0, 20);
  }
}

TEST(SurfaceFiles, BinaryDataBehindATextHeadBeginWhereItsLastLineEnds) {
  for (const char first : {'\n', '\r'})
    for (const char* end : {"\n", "\r", "\r\n"}) {
      std::string head;
      for (const char c : std::string("ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n"
                                      "property uchar y\nproperty uchar z\nelement face 1\n"
                                      "property list uchar uchar vertex_index\nend_header\n"))
        head += c == '\n' ? std::string(end) : std::string(1, c);
      const std::string data = std::string(1, first) + std::string("\0\0\1\0\0\0\1\0\3\0\1\2", 12);
      const SurfaceFile file = read_surfaces(head + data, "a");
      EXPECT_EQ(file.parts.at(0).mesh.positions.at(0), (Vec3d{double(first), 0, 0})) << int(end[0]);
      EXPECT_TRUE(file.notes.empty());
    }
}

TEST(SurfaceFiles, TextInOtherEncodingsIsRefusedByName) {
  const auto wide = [](const std::string& text, bool big, const std::string& mark) {
    std::string out = mark;
    for (const char c : text) out += big ? std::string{'\0', c} : std::string{c, '\0'};
    return out;
  };
  for (const std::string& text : {kAxesObj, kAxesStl, kAxesPly}) {
    EXPECT_EQ(surface_faults(wide(text, false, "\xff\xfe")),
              "a:1:1: expected text in UTF-8, got UTF-16: save the file as UTF-8");
    EXPECT_EQ(surface_faults(wide(text, true, "\xfe\xff")), surface_faults(wide(text, false, "\xff\xfe")));
    EXPECT_EQ(surface_faults(wide(text, false, "")), surface_faults(wide(text, false, "\xff\xfe")));
  }
}

TEST(SurfaceFiles, FacesWithFewerThanThreeCornersAreLeftOutAndCounted) {
  const std::string obj = kAxesObj + "f 1 2\nf 3\nf 1 1 2\nf 2 3 2\nf 1 2 2 3 3 1\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n2 0 1\n3 1 1 2\n";
  const std::string vtk =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n0 0 0 1 0 0 0 1 0\n"
      "POLYGONS 3 11\n3 0 1 2\n2 0 1\n3 1 2 2\n";
  const auto note = [](const std::string& bytes) { return read_surfaces(bytes, "a").notes.back(); };
  EXPECT_EQ(note(obj), "4 faces with fewer than three different corners left out");
  EXPECT_EQ(joined(read_surfaces(obj, "a")).triangles.size(), 5u);
  EXPECT_EQ(note(ply), "2 faces with fewer than three different corners left out");
  EXPECT_EQ(note(vtk), "2 faces with fewer than three different corners left out");
}

TEST(SurfaceFiles, BytesBehindTheLastItemAreLeftOutAndCounted) {
  const auto notes = [](const std::string& bytes) { return read_surfaces(bytes, "a.stl").notes; };
  const auto only = [](const std::string& words) { return std::vector<std::string>{words}; };
  std::string stl = axes_stl_binary();
  EXPECT_EQ(notes(stl + "junk"), only("4 bytes behind the last triangle left out")) << "begins with solid";
  stl[0] = 'S', stl[1] = 'X';
  EXPECT_EQ(notes(stl + std::string(92, '\0')), only("92 bytes behind the last triangle left out"));
  EXPECT_EQ(notes(kAxesStl + "made by hand\n"), only("13 bytes behind the last solid left out"));
  EXPECT_EQ(notes(axes_ply_binary(false) + "xyz"), only("3 bytes behind the last item left out"));
  EXPECT_EQ(notes(axes_glb() + "xyz"), only("3 bytes behind the file's end left out"));
  EXPECT_EQ(notes(kAxesStl + std::string("\x1a\0\0", 3)), std::vector<std::string>{}) << "the end sign of old systems";
  EXPECT_EQ(notes(kAxesPly + "\n\n\x1a"), std::vector<std::string>{});
}

TEST(SurfaceFiles, CommentsMayStandBehindDataAndBetweenThem) {
  const std::string obj =
      "v 0 0 0 # one\nv 1 0 0#two\nv 0 2 0\n# between\nv 0 0 3\nf 1 3 2 # bottom\nf 1 2 4 #f 9\n"
      "f 1 4 3\nf 2 3 4\n";
  std::string stl = kAxesStl, ply = kAxesPly, vtk = kAxesVtk;
  stl.replace(stl.find("vertex 0 2 0\n"), 13, "# a comment\nvertex 0 2 0 # another\n");
  ply.replace(ply.find("1 0 9 0\n"), 8, "# a comment\n1 0 9 0 # another\n");
  vtk.replace(vtk.find("3 0 1 3\n"), 8, "# a comment\n3 0 1 3 # another\n");
  for (const std::string& bytes : {obj.substr(0, obj.find("#two")) + obj.substr(obj.find("#two") + 4), stl, ply, vtk})
    EXPECT_EQ(sorted_corners(joined(read_surfaces(bytes, "a"))), sorted_corners(axes_mesh())) << bytes.substr(0, 20);
}

/// The corner on the axes at 1, 2 and 3, as a program that writes patient's axes has it: (1, 0, 0) is to the left in
/// LPS.
TEST(SurfaceFiles, MeshesAlongThePatientsAxesAreTurnedIntoOursAndThatIsTold) {
  const auto with_head = [](std::string bytes, const std::string& from, const std::string& to) {
    const std::size_t at = bytes.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return bytes.replace(at, from.size(), to);
  };
  for (const std::string space : {"LPS", "RAS"}) {
    const std::string tag = "3D Slicer output. SPACE=" + space;
    std::string stl = axes_stl_binary();
    stl.replace(0, tag.size(), tag);
    const std::string field = "FIELD FieldData 1\nSPACE 1 1 string\n" + space + "\nPOINTS";
    const std::vector<std::string> files{stl,
                                         with_head(kAxesStl, "solid axes", "solid " + tag),
                                         with_head(kAxesObj, "# a tetrahedron", "# " + tag),
                                         with_head(kAxesPly, "comment by hand", "comment " + tag),
                                         with_head(kAxesVtk, "any title", tag),
                                         with_head(kAxesVtk, "POINTS", field)};
    TriMesh expected = axes_mesh();
    const double side = space == "LPS" ? 1 : -1;
    for (Vec3d& p : expected.positions) p = {side * p.x, p.z, -side * p.y};
    for (const std::string& bytes : files) {
      const SurfaceFile file = read_surfaces(bytes, "a");
      SCOPED_TRACE(file.format + ' ' + space);
      EXPECT_EQ(sorted_corners(joined(file)), sorted_corners(expected));
      EXPECT_NEAR(volume(joined(file)), 1, 1e-12) << "turned, not mirrored";
      EXPECT_EQ(file.metres, 0.001);
      EXPECT_EQ(file.notes.back(), "its head says SPACE=" + space +
                                       ": turned so that x is to the patient's left, y to the head, z to the front");
    }
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
  EXPECT_EQ(surface_faults("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">"),
            expected + "VTK's XML format (.vtp, .vtu, .vti): save it as legacy VTK (.vtk)");
  EXPECT_EQ(surface_faults("PK\x03\x04..."),
            expected + "a ZIP archive: unpack it. Of 3MF, save the mesh as STL or OBJ");
  EXPECT_EQ(surface_faults("version https://git-lfs.github.com/spec/v1\n" + std::string(80, '1')),
            expected + "a pointer of Git LFS: fetch the file itself (git lfs pull)");
  EXPECT_EQ(surface_faults("OFF\n8 6 0\n"), expected + "OFF: save the mesh as glTF, OBJ or STL");
  EXPECT_EQ(surface_faults("ISO-10303-21;\n"), expected + "STEP: name the file .step, and import it as a drawing");
  EXPECT_EQ(surface_faults("\x1b[31mred"), expected + "'?[31mred'");
  EXPECT_EQ(surface_faults("vn 0 0 1\n"), "a:1:1: expected triangles, got none");
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
  const auto guess = [](double longest, double volume = 0) {
    return guess_unit({{{0, 0, 0}, {longest, longest / 2, longest / 3}}, volume});
  };
  EXPECT_EQ(guess(0.247).metres, 1);
  EXPECT_EQ(guess(380.5).metres, 0.001);
  EXPECT_EQ(guess(6.4).metres, 0.01);
  EXPECT_EQ(guess(6.4).also, (std::vector<double>{0.001}));
  EXPECT_TRUE(guess(380.5).also.empty());
  EXPECT_EQ(guess(28.3).metres, 0.001) << "a jaw: few programs write centimetres";
  EXPECT_EQ(guess(28.3).also, (std::vector<double>{0.01}));
  EXPECT_EQ(guess(1e6).metres, 0);
  EXPECT_EQ(guess(380.5).words, "longest side 380.5: 38 cm in millimetres, 3.81 m in centimetres, 380 m in metres");
  EXPECT_EQ(guess_unit({bounds({}), 0}).metres, 0);
  EXPECT_EQ(guess(20).metres, 0.001);
  EXPECT_EQ(guess(20, 30).metres, 0.01) << "30 cubic millimetres are no organ's volume";
  EXPECT_EQ(
      guess(20, 30).words,
      "longest side 20: 2 cm and 0.03 mL in millimetres, 20 cm and 30 mL in centimetres, 20 m and 30 m3 in metres");
}

TEST(UnitGuess, WhatIsTakenIsToldAndASizeThatIsNoOrgansIsAQuestion) {
  const Bounds box{{0, 0, 0}, {0.16, 0.16, 0.16}};
  const UnitChoice metres = choose_unit({box, 0.004}, 0, "--unit-mm");
  EXPECT_EQ(metres.metres, 1);
  EXPECT_EQ(metres.question, "");
  EXPECT_EQ(
      metres.note,
      "coordinates are taken as metres, guessed from the size (longest side 0.16: 16 cm and 4000 mL in metres, "
      "1.6 mm and 0.004 mL in centimetres, 0.16 mm and less than 0.001 mL in millimetres); --unit-mm sets another "
      "unit");
  EXPECT_EQ(choose_unit({box, 0.004}, 1, "--unit-mm").note, "") << "the file says so";
  EXPECT_NE(
      choose_unit({box, 0.004}, 0.001, "--unit-mm")
          .question.find("expected an organ of 0.1 mL to 20 L, got 0.16 mm and less than 0.001 mL with coordinates in "
                         "millimetres; --unit-mm sets another unit (longest side 0.16: "),
      std::string::npos);
  EXPECT_NE(choose_unit({{{0, 0, 0}, {1e6, 1, 1}}, 0}, 0, "--unit-mm").question.find("expected the unit"),
            std::string::npos);
  EXPECT_EQ(choose_unit({{{0, 0, 0}, {25.4, 20, 20}}, 98322}, 1, "k").question.substr(0, 65),
            "expected an organ of 0.1 mL to 20 L, got 25.4 m and 98322 m3 with");
  EXPECT_EQ(unit_in_words(0.0254), "units of 25.4 mm");
}

}  // namespace trocar::geometry
