// OBJ, STL, PLY and VTK: what each of them has of its own, and how faults are told.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/remesh/remeshed.hpp>
#include <trocar/geometry/repair/examine.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>

#include "surface_bytes.hpp"

namespace trocar::geometry {
namespace {

std::string text_faults(const std::string& bytes, const std::string& path = "a") {
  try {
    read_surfaces(bytes, path);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}
std::string with(std::string text, const std::string& what, const std::string& in_its_place) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), in_its_place);
}
TriMesh only_mesh(const std::string& bytes) {
  const SurfaceFile file = read_surfaces(bytes, "a");
  EXPECT_EQ(file.parts.size(), 1u);
  return file.parts.at(0).mesh;
}
double area_of(const TriMesh& mesh) { return area(mesh); }

using Triangles = std::vector<std::array<int, 3>>;

}  // namespace

TEST(ObjFiles, ReadsPolygonsSlashesAndNegativeNumbers) {
  const TriMesh mesh = only_mesh("# c\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1/1/1 2//1 3/2 4\nf -4 -3 -2\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
}

TEST(ObjFiles, GroupsAndObjectsArePartsWithTheirVertices) {
  const SurfaceFile file = read_surfaces(kAxesObj, "a.obj");
  ASSERT_EQ(file.parts.size(), 2u);
  EXPECT_EQ(file.parts[0].name, "axes");
  EXPECT_EQ(file.parts[0].mesh.triangles, (Triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}}));
  EXPECT_EQ(file.parts[1].name, "axes/more");
  EXPECT_EQ(file.parts[1].mesh.positions, (std::vector<Vec3d>{{0, 0, 0}, {0, 2, 0}, {0, 0, 3}}));
  EXPECT_EQ(file.notes, (std::vector<std::string>{"1 lines left out"}));
  EXPECT_EQ(file.metres, 0);
}

TEST(ObjFiles, PolygonsThatAreNotConvexAreCutWithinThemselves) {
  // An L, a square with a square hole to which a cut leads, and the L lying on its back.
  const std::string l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\n";
  const std::string hole =
      "v 0 0 1\nv 4 0 1\nv 4 4 1\nv 0 4 1\nv 1 1 1\nv 1 3 1\nv 3 3 1\nv 3 1 1\nf 1 2 3 4 1 5 6 7 8 5\n";
  EXPECT_NEAR(area_of(only_mesh(l)), 3, 1e-12);
  EXPECT_EQ(only_mesh(l).triangles.size(), 4u);
  EXPECT_NEAR(area_of(only_mesh(hole)), 12, 1e-12);
  EXPECT_NEAR(area_of(only_mesh(with(l, "f 1 2 3 4 5 6", "f 6 5 4 3 2 1"))), 3, 1e-12);
  const TriMesh mesh = only_mesh(l);
  for (int t = 0; t < 4; ++t) EXPECT_GT(area_vector(mesh, t).z, 0) << "it runs around as the polygon does";
}

TEST(ObjFiles, AllFaultsAreToldWithTheirPlaces) {
  EXPECT_EQ(text_faults("v 0 0 zero\nv 1 0\nv 1 1 0\nf 1 2\nf 1 2 9\nf a 2 3\nf 1 2 0\nf -4 1 2\nv nan 0 0\n", "bad"),
            "bad:1:7: expected a z coordinate, got 'zero'\n"
            "bad:2:6: expected a z coordinate, got the end of the line\n"
            "bad:5:2: expected the number of a vertex from 1 to 4, got 9\n"
            "bad:6:3: expected the number of a vertex, from 1 or back from -1, got 'a'\n"
            "bad:7:7: expected the number of a vertex, from 1 or back from -1, got '0'\n"
            "bad:8:3: expected the number of a vertex, from 1 or back from -1, got '-4'\n"
            "bad:9:3: expected an x coordinate, got 'nan'");
  EXPECT_EQ(text_faults("v 0 2e9 0\n"), "a:1:5: expected a coordinate within 1000000000, got 2000000000");
}

TEST(StlFiles, BinaryFilesAreToldByTheirSizeAndNotByTheWordSolid) {
  const std::string bytes = axes_stl_binary();
  ASSERT_EQ(bytes.substr(0, 5), "solid");
  EXPECT_EQ(read_surfaces(bytes, "a.stl").format, "STL, binary");
  EXPECT_EQ(only_mesh(bytes).positions.size(), 4u) << "corners at one place are one vertex";
}

TEST(StlFiles, AHeadThatAnnouncesMoreThanThereIsIsRefused) {
  std::string bytes = axes_stl_binary();
  bytes[0] = 'S', bytes[1] = 'T';
  for (const char high : {'\x00', '\x7f', '\xff'}) {
    bytes[80] = 5, bytes[83] = high;  // one more than there is, or many
    const std::string told = text_faults(bytes, "a.stl");
    EXPECT_NE(told.find("at byte 80: expected 4 triangles, which is what 284 bytes are the size of, got "),
              std::string::npos)
        << told;
  }
  EXPECT_EQ(text_faults("xyz", "a.stl"),
            "a.stl:1:1: at byte 0: expected a head of 84 bytes of a binary STL, or the word solid, got 3 bytes");
}

TEST(StlFiles, FacetsWhoseCornersAreNoNumbersAreLeftOutAndNormalsAreNotLookedAt) {
  std::string bytes = axes_stl_binary();
  const std::string nan("\x00\x00\xc0\x7f", 4);
  bytes.replace(84, 4, nan);
  EXPECT_EQ(only_mesh(bytes).triangles.size(), 4u);
  bytes.replace(84 + 12 + 4, 4, nan);
  EXPECT_EQ(only_mesh(bytes).triangles.size(), 3u);
  EXPECT_EQ(read_surfaces(bytes, "a.stl").notes,
            (std::vector<std::string>{"1 facets with coordinates that are not numbers left out"}));
}

TEST(StlFiles, TextSaysWhatIsMissingWhere) {
  EXPECT_EQ(text_faults(with(kAxesStl, "endloop", "endlop")), "a:7:1: expected 'endloop', got 'endlop'");
  EXPECT_EQ(text_faults(with(kAxesStl, "vertex 0 2 0\n", "vertex 0 2\n")),
            "a:5:11: expected a z coordinate, got the end of the line");
  EXPECT_EQ(text_faults(with(kAxesStl, "endsolid axes\n", "")), "a:30:1: expected 'facet', got the end of the file");
  const SurfaceFile two = read_surfaces(kAxesStl + with(kAxesStl, "solid axes", "solid"), "b.stl");
  ASSERT_EQ(two.parts.size(), 2u);
  EXPECT_EQ(two.parts[1].name, "b");
}

TEST(StlFiles, SolidsMayBeginTwiceAndWordsStandApart) {
  const std::string two_heads = "solid model\n" + kAxesStl + "endsolid model\n";
  EXPECT_EQ(read_surfaces(two_heads, "a").parts.size(), 1u);
  EXPECT_EQ(read_surfaces(two_heads, "a").parts.at(0).name, "axes");
  EXPECT_EQ(only_mesh(two_heads).triangles.size(), 4u);
  std::string apart = kAxesStl;
  for (const char* word : {"endloop", "endfacet", "endsolid"})
    for (std::size_t at = 0; (at = apart.find(word, at)) != apart.npos; at += 4) apart.insert(at + 3, " ");
  EXPECT_EQ(only_mesh(apart).triangles.size(), 4u);
  const std::string without_end = with(kAxesStl, "endsolid axes\n", "");
  EXPECT_EQ(read_surfaces(without_end + kAxesStl, "a").parts.size(), 2u);
  EXPECT_EQ(text_faults(kAxesStl + "facet normal 0 0 1\nouter loop\nvertex 0 0\n"),
            "a:33:11: expected a z coordinate, got the end of the line\n"
            "a:34:1: expected 'vertex', got the end of the file");
}

TEST(PlyFiles, HeadersThatLieAreRefusedBeforeAnythingIsSetAside) {
  for (const char* lie : {"element vertex 4000000000", "element vertex 999999999999999999"})
    EXPECT_NE(text_faults(with(kAxesPly, "element vertex 4", lie)).find("items, for which the"), std::string::npos);
  EXPECT_EQ(text_faults(with(kAxesPly, "element vertex 4", "element vertex -1")),
            "a:4:16: expected the number of items, got -1");
  EXPECT_NE(text_faults(with(kAxesPly, "element vertex 4", "element vertex 40"))
                .find("a:4:9: expected at most 10 items, for which the 86 bytes that follow have room, got 40"),
            std::string::npos);
  std::string many = axes_ply_binary(false);
  many[many.find("end_header\n") + 11 + 3] = '\x7f';
  EXPECT_NE(text_faults(many).find("expected a list of at most "), std::string::npos);
}

TEST(PlyFiles, WhatIsMissingIsTold) {
  EXPECT_EQ(text_faults(with(kAxesPly, "property double z\n", "property double w\n")),
            "a:4:9: expected vertices with x, y and z, got others");
  EXPECT_EQ(text_faults(with(kAxesPly, "format ascii 1.0\n", "")),
            "a:1:1: expected a format, such as 'format ascii 1.0', got none");
  EXPECT_EQ(text_faults(with(kAxesPly, "float x", "half x")),
            "a:5:10: expected a type such as float or uchar, got 'half'");
  EXPECT_EQ(text_faults(with(kAxesPly, "uchar int vertex_indices", "uchar float vertex_indices")),
            "a:12:9: expected vertex_indices of whole numbers, got another type");
  EXPECT_EQ(text_faults(with(kAxesPly, "3 1 2 3 0\n", "3 1 2 4 0\n")),
            "a:24:1: expected the number of a vertex from 0 to 3, got 4");
  EXPECT_EQ(text_faults(with(kAxesPly, "3 1 2 3 0\n", "")),
            "a:24:1: expected 4 items of 'face', got the end of the file");
}

TEST(PlyFiles, StripsAreTrianglesThatAllFaceTheSameWay) {
  const TriMesh mesh = only_mesh(
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n6 0 1 2 3 4 5\n");
  ASSERT_EQ(mesh.triangles.size(), 4u);
  for (int t = 0; t < 4; ++t) EXPECT_EQ(area_vector(mesh, t).z, 1);
}

TEST(PolydataFiles, FieldsOfStringsMayStandInFrontOfPoints) {
  const std::string fields =
      "FIELD FieldData 3\nSPACE 1 1 string\nours\nNames 1 2 string\nleft%20lobe\n\nflags 1 9 bit\n"
      "1 0 1 0 1 0 1 0 1\nPOINTS";
  EXPECT_EQ(only_mesh(with(kAxesVtk, "POINTS", fields)).triangles.size(), 4u);
  MeshBytes f{true};
  f.text("FIELD FieldData 2\nNames 1 3 string\n").all<std::uint8_t>(0xc3).text("abc").all<std::uint8_t>(0x80, 70);
  f.text(std::string(70, 'x')).all<std::uint8_t>(0xc0).text("\nflags 1 9 bit\n").all<std::uint8_t>(0xff, 0x80);
  EXPECT_EQ(only_mesh(with(axes_vtk_binary(), "POINTS", f.bytes + "\nPOINTS")).triangles.size(), 4u);
  EXPECT_EQ(text_faults(with(kAxesVtk, "POINTS", "FIELD FieldData 1\nodd 1 1 variant\nx\nPOINTS")),
            "a:6:16: expected data of a type that is known, such as float, int or string, got 'odd'");
  EXPECT_NE(text_faults(with(kAxesVtk, "POINTS", "FIELD FieldData 1\nSPACE 1 99 string\nLPS\nPOINTS")), "");
}

TEST(PolydataFiles, PointsMayBeWholeNumbers) {
  EXPECT_EQ(only_mesh(with(kAxesVtk, "POINTS 4 float", "POINTS 4 int")).positions, axes_mesh().positions);
  EXPECT_NE(text_faults(with(kAxesVtk, "POINTS 4 float", "POINTS 4 bit")), "");
}

TEST(VtkGrids, FacesOfEveryKindAreASurfaceAndOtherCellsAreLeftOut) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n";
  const std::string cube = head + "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\n";
  // Two triangles, a quadrangle, a polygon, a pixel, a strip, a quadratic quadrangle; then a line.
  const std::string cells =
      "CELLS 8 40\n3 0 3 2\n3 0 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 5 6\n4 7 6 3 2\n"
      "8 0 4 7 3 0 4 7 3\n2 0 1\nCELL_TYPES 8\n5 5 9 7 8 6 23 3\n";
  const SurfaceFile file = read_surfaces(cube + cells, "a");
  EXPECT_NEAR(volume(joined(file)), 1, 1e-12);
  EXPECT_TRUE(check_edges(joined(file)).closed());
  EXPECT_EQ(file.notes, (std::vector<std::string>{"1 lines left out"}));
  EXPECT_EQ(
      text_faults(head + "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n"),
      "a:1:1: expected triangles, got 1 tetrahedra");
  EXPECT_EQ(text_faults(cube + "CELLS 1 3\n2 0 1\nCELL_TYPES 1\n5\n"),
            "a:8:3: expected 3 nodes of a cell of type 5, got 2");
}

TEST(VtkGrids, CellsWithAVolumeThatAreNoTetrahedraAreAFaultWithTheRemedy) {
  const std::string hexahedron =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
      "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n";
  EXPECT_NE(text_faults(hexahedron).find("got 1 other cells with a volume (hexahedra, polyhedra): convert"),
            std::string::npos)
      << text_faults(hexahedron);
}

TEST(SurfaceFiles, APointCloudIsAFaultWithTheRemedy) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
      "0 0 0\n1 0 0\n";
  for (const std::string& bytes : {ply, std::string("v 0 0 0\nv 1 0 0\np 1 2\n")})
    EXPECT_NE(text_faults(bytes).find("got points only (a point cloud): reconstruct a surface first"),
              std::string::npos)
        << bytes;
  EXPECT_NE(text_faults("v 0 0 0\nv 1 0 0\nl 1 2\n").find("1 lines left out"), std::string::npos)
      << "notes belong to the refusal";
}

TEST(ObjFiles, APolygonOfManyCornersIsCutInHalvesAndACylinderOfThemIsABody) {
  for (const int corners : {40, 3000}) {
    std::string obj, top = "f", bottom = "f";
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * 3.14159265358979 * i / corners;
      for (const int z : {0, 50})
        obj += fmt::format("v {:.6f} {:.6f} {}\n", 30 * std::cos(angle), 30 * std::sin(angle), z);
      top += fmt::format(" {}", 2 * i + 2);
      bottom += fmt::format(" {}", 2 * (corners - 1 - i) + 1);
    }
    for (int i = 0; i < corners; ++i) {
      const int next = (i + 1) % corners;
      obj += fmt::format("f {} {} {} {}\n", 2 * i + 1, 2 * next + 1, 2 * next + 2, 2 * i + 2);
    }
    TriMesh mesh = only_mesh(obj + top + '\n' + bottom + '\n');
    EXPECT_EQ(int(mesh.triangles.size()), 4 * corners - 4);
    for (Vec3d& p : mesh.positions) p = 1e-3 * p;
    EXPECT_TRUE(examine(mesh).is_body()) << corners;
    const Remeshed even = remeshed(mesh, 0.006);  // of 3000 corners in a second: needles are not split
    EXPECT_TRUE(examine(even.mesh).is_body()) << corners;
    EXPECT_NEAR(volume(even.mesh) / volume(mesh), 1, 0.02) << corners;
    EXPECT_LT(even.mesh.triangles.size(), 1500u) << corners;
    std::vector<int> at(mesh.positions.size());
    for (const auto& t : mesh.triangles)
      for (const int v : t) ++at[std::size_t(v)];
    EXPECT_LT(*std::max_element(at.begin(), at.end()), 40) << "no corner has them all";
  }
}

TEST(SurfaceFiles, AHeadMayNameTheUnit) {
  std::string stl = axes_stl_binary();
  const std::string head = "Binary STL UNITS=in";
  stl.replace(0, 40, head + std::string(40 - head.size(), ' '));
  const SurfaceFile file = read_surfaces(stl, "a");
  EXPECT_DOUBLE_EQ(file.metres, 0.0254);
  EXPECT_EQ(file.notes.back(), "its head names the unit: coordinates are units of 25.4 mm");
  EXPECT_EQ(read_surfaces("# File units = millimeters\n" + kAxesObj, "a").metres, 1e-3);
  EXPECT_EQ(read_surfaces(with(kAxesPly, "by hand", "Unit: cm"), "a").metres, 1e-2);
  for (const char* none : {"# units\n", "# unit cell: m\n", "# UNITS=parsec\n", "# communit=mm\n"})
    EXPECT_EQ(read_surfaces(none + kAxesObj, "a").metres, 0) << none;
}

TEST(SurfaceFiles, AllSignsOfThePatientsAxesAreObeyedAndAnotherOrderIsRefused) {
  const auto read = [](const std::string& space) {
    return joined(read_surfaces("# SPACE=" + space + "\n" + kAxesObj, "a")).positions;
  };
  const std::vector<Vec3d> plain = joined(read_surfaces(kAxesObj, "a")).positions;
  for (const std::string space : {"LPS", "LAS", "RPS", "RAS", "LPI", "LAI", "RPI", "RAI"}) {
    const double left = space[0] == 'L' ? 1 : -1, front = space[1] == 'A' ? 1 : -1, up = space[2] == 'S' ? 1 : -1;
    const std::vector<Vec3d> turned = read(space);
    for (std::size_t i = 0; i < plain.size(); ++i)
      EXPECT_EQ(turned[i], (Vec3d{left * plain[i].x, up * plain[i].z, front * plain[i].y})) << space;
    EXPECT_NEAR(volume(joined(read_surfaces("# SPACE=" + space + "\n" + kAxesObj, "a"))), 1, 1e-12)
        << space << ": triangles of a mirrored mesh run the other way round";
  }
  EXPECT_EQ(read("left-anterior-superior"), read("LAS"));
  EXPECT_NE(text_faults("# SPACE=SAL\n" + kAxesObj).find("save the mesh in LPS"), std::string::npos);
  EXPECT_EQ(read("sRGB"), plain);
  EXPECT_EQ(joined(read_surfaces("# COLORSPACE=RAS\n" + kAxesObj, "a")).positions, plain);
}

TEST(SurfaceFiles, ZeroBytesBehindATextAreCounted) {
  EXPECT_EQ(read_surfaces(kAxesStl + std::string("\0\0\x1a", 3), "a").notes,
            (std::vector<std::string>{"2 zero bytes behind the text left out"}));
}

TEST(PolydataFiles, OtherDataSetsAreRefused) {
  EXPECT_EQ(
      text_faults(with(kAxesVtk, "POLYDATA", "STRUCTURED_POINTS")),
      "a:4:9: expected a mesh (POLYDATA or UNSTRUCTURED_GRID), got an image (STRUCTURED_POINTS): save it as NRRD or "
      "MetaImage, and open it as a scan");
  EXPECT_EQ(text_faults(with(kAxesVtk, "POLYDATA", "RECTILINEAR_GRID")),
            "a:4:9: expected POLYDATA or UNSTRUCTURED_GRID, as surfaces need, got 'RECTILINEAR_GRID'");
  EXPECT_EQ(text_faults(with(kAxesVtk, "3 1 2 3\n", "3 1 2 4\n")),
            "a:13:7: expected the number of a point from 0 to 3, got 4");
  EXPECT_NE(text_faults(with(kAxesVtk, "POINTS 4", "POINTS 500000000")), "");
  EXPECT_NE(text_faults(with(kAxesVtk, "POLYGONS 4 16", "POLYGONS 4 15")), "");
}

TEST(PolydataFiles, CellsWithoutTypesAreRefused) {
  EXPECT_EQ(text_faults("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
                        "0 0 0 40 0 0 0 40 0 0 0 40\nCELLS 4 16\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n"),
            "a:1:1: expected POINTS, CELLS and as many CELL_TYPES, got 4 points, 4 cells, 0 types");
}

}  // namespace trocar::geometry
