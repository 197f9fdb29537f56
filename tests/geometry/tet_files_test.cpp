#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/formats/tet_files.hpp>

#include "mesh_bytes.hpp"
#include "tets.hpp"

namespace trocar::geometry {
namespace {

/// All faults, a line each; empty where the file reads.
std::string faults_of(const std::string& bytes, double scale = 1) {
  try {
    read_tets(bytes, "a.msh", scale);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

std::string with_crlf(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return out;
}

/// The two cells of mesh_bytes.hpp.
void expect_two_cells(const TetFile& file, const std::vector<int>& regions) {
  SCOPED_TRACE(file.format);
  ASSERT_EQ(file.mesh.points.size(), 5u);
  ASSERT_EQ(file.mesh.cells.size(), 2u);
  EXPECT_EQ(file.mesh.region, regions);
  const TetFacts f = inspect(file.mesh);
  EXPECT_TRUE(f.sound());
  EXPECT_EQ(f.parts, 1);
  EXPECT_DOUBLE_EQ(f.volume, 2.0 / 6);
  EXPECT_EQ(f.box.low, (Vec3d{0, 0, -1}));
  EXPECT_EQ(f.box.high, (Vec3d{1, 1, 1}));
}

using Notes = std::vector<std::string>;

}  // namespace

TEST(TetFiles, EveryGenerationOfGmshReadsAsText) {
  expect_two_cells(read_tets(kGmsh1, "a.msh"), {5, 6});
  expect_two_cells(read_tets(kGmsh2, "a.msh"), {5, 6});
  expect_two_cells(read_tets(kGmsh40, "a.msh"), {5, 6});
  expect_two_cells(read_tets(kGmsh41, "a.msh"), {5, 6});
  EXPECT_EQ(read_tets(kGmsh1, "a.msh").format, "Gmsh 1, text");
  EXPECT_EQ(read_tets(kGmsh2, "a.msh").format, "Gmsh 2.2, text");
  EXPECT_EQ(read_tets(kGmsh40, "a.msh").format, "Gmsh 4.0, text");
  EXPECT_EQ(read_tets(kGmsh41, "a.msh").format, "Gmsh 4.1, text");
}

TEST(TetFiles, GmshReadsAsBinaryOfEitherByteOrder) {
  for (const bool swapped : {false, true}) {
    expect_two_cells(read_tets(gmsh2_binary(swapped), "a.msh"), {5, 6});
    expect_two_cells(read_tets(gmsh40_binary(swapped), "a.msh"), {5, 6});
    expect_two_cells(read_tets(gmsh41_binary(swapped), "a.msh"), {5, 6});
  }
  EXPECT_EQ(read_tets(gmsh41_binary(true), "a.msh").format, "Gmsh 4.1, binary, other byte order");
}

TEST(TetFiles, NumbersThatLookLikeBlanksAreNumbers) {
  for (const int blocks : {' ', '\n', '\r', '\t', '$'})
    for (const bool swapped : {false, true})
      expect_two_cells(read_tets(gmsh41_binary(swapped, blocks - 1), "a.msh"), {5, 6});
}

TEST(TetFiles, NodesMayHaveParametersOfTheirEntities) {
  const auto with_parameters = [](std::string text) {
    text = replaced(text, "10 0 0 0\n", "10 0 0 0 0 4\n");
    text = replaced(text, "3 1 0 0\n", "3 1 0 0 1 4 0.5\n");
    text = replaced(text, "77 0 1 0\n", "77 0 1 0 2 4 0.5 -0.5\n");
    return replaced(text, "4 0 0 1\n", "4 0 0 1 3 4\n");
  };
  expect_two_cells(read_tets(with_parameters(kGmsh1), "a.msh"), {5, 6});
  const std::string text =
      replaced(with_parameters(replaced(kGmsh2, "12 0 0 -1\n", "12 0 0 -1 0 4\n")), "$Nodes", "$ParametricNodes");
  expect_two_cells(read_tets(replaced(text, "$EndNodes", "$EndParametricNodes"), "a.msh"), {5, 6});
  for (const bool swapped : {false, true}) {
    const std::string good = gmsh2_binary(swapped);
    const std::size_t nodes = good.find("$Nodes\n5\n") + 9, end = good.find("\n$EndNodes");
    MeshBytes f{swapped};
    f.text(replaced(good.substr(0, nodes), "$Nodes", "$ParametricNodes"));
    f.text(good.substr(nodes, 28)).all<std::int32_t>(0, 1);
    f.text(good.substr(nodes + 28, 28)).all<std::int32_t>(1, 1).all<double>(0.5);
    f.text(good.substr(nodes + 56, 28)).all<std::int32_t>(2, 1).all<double>(0.5, 0.5);
    f.text(good.substr(nodes + 84, 28)).all<std::int32_t>(3, 1);
    f.text(good.substr(nodes + 112, 28)).all<std::int32_t>(0, 1);
    f.text(replaced(good.substr(end), "$EndNodes", "$EndParametricNodes"));
    expect_two_cells(read_tets(f.bytes, "a.msh"), {5, 6});
  }
}

TEST(TetFiles, VtkReadsInBothLayoutsAsTextAndBinary) {
  for (const std::string& bytes : {kVtk, kVtk5, vtk_binary(), vtk5_binary()}) {
    const TetFile file = read_tets(bytes, "a.vtk");
    expect_two_cells(file, {5, 6});
    EXPECT_EQ(file.notes, Notes{"1 triangles left out"});
  }
  EXPECT_EQ(read_tets(vtk5_binary(), "a.vtk").format, "VTK 5.1, binary");
}

TEST(TetFiles, LineEndsOfOtherSystemsAreLineEnds) {
  for (const std::string& bytes : {kGmsh1, kGmsh2, kGmsh40, kGmsh41, kVtk, kVtk5})
    expect_two_cells(read_tets(with_crlf(bytes), "a.msh"), {5, 6});
}

TEST(TetFiles, OtherCellsAreCountedAndLeftOut) {
  EXPECT_EQ(read_tets(kGmsh2, "a.msh").notes, (Notes{"1 points left out", "1 triangles left out"}));
  EXPECT_EQ(read_tets(replaced(kGmsh2, "1 15 2 1 1 10", "1 999 2 1 1 10"), "a.msh").notes,
            (Notes{"1 elements of type 999 left out", "1 triangles left out"}));
}

TEST(TetFiles, OfTetrahedraOfHigherOrderTheCornersAreTaken) {
  const TetFile file =
      read_tets(replaced(kGmsh2, "3 4 2 5 1 10 3 77 4", "3 11 2 5 1 10 3 77 4 12 12 12 12 12 12"), "a.msh");
  expect_two_cells(file, {5, 6});
  EXPECT_EQ(file.notes.front(), "1 tetrahedra of 10 nodes: only their corners are used");
  const std::string vtk =
      replaced(replaced(kVtk, "CELLS 3 14\n3 0 1 2\n4 0 1 2 3", "CELLS 3 20\n3 0 1 2\n10 0 1 2 3 4 4 4 4 4 4"),
               "5 10 10", "5 24 10");
  EXPECT_EQ(read_tets(vtk, "a.vtk").notes.front(), "1 tetrahedra of 10 nodes: only their corners are used");
}

TEST(TetFiles, TheScaleMakesMetres) {
  const TetFacts f = inspect(read_tets(kGmsh1, "a.msh", 0.001).mesh);
  EXPECT_DOUBLE_EQ(f.volume, 2e-9 / 6);
}

TEST(TetFiles, WhatIsWrittenReadsAsTheSameBits) {
  core::Random random(4);
  TetMesh mesh = block_of_tets(3, 0.01);
  for (Vec3d& p : mesh.points) p += {random.uniform(-1e-3, 1e-3), random.uniform() * 1e-17, -random.uniform()};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) mesh.region.push_back(int(c % 5) - 2);
  for (const std::string& bytes : {to_gmsh(mesh), to_vtk(mesh)}) {
    const TetMesh back = read_tets(bytes, "a").mesh;
    EXPECT_EQ(back.points, mesh.points);
    EXPECT_EQ(back.cells, mesh.cells);
    EXPECT_EQ(back.region, mesh.region);
  }
  mesh.region.clear();
  EXPECT_TRUE(read_tets(to_vtk(mesh), "a").mesh.region.empty());
  EXPECT_EQ(read_tets(to_vtk(mesh, 0.5), "a", 0.5).mesh.points, mesh.points);
}

TEST(TetFiles, FaultsSayWhereAndWhatWasExpected) {
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", "3 1 abc 0\n")), "a.msh:4:5: expected a y coordinate, got 'abc'");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", "3 1 0\n")),
            "a.msh:4:6: expected a z coordinate, got the end of the line");
  EXPECT_EQ(faults_of(replaced(kGmsh2, "3 1 0 0\n", "3 1 0 0 0\n")),
            "a.msh:11:9: expected the end of the line, got '0'");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", "3 1 0 0 0\n")),
            "a.msh:4:10: expected the node's entity, got the end of the line");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "4 0 0 1\n", "3 0 0 1\n")),
            "a.msh:6:1: expected every node's number once, got 3 again\n"
            "a.msh:13:11: expected the number of a node that is there, got 4");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "4 10 3 77 4\n", "4 10 3 78 4\n")),
            "a.msh:13:11: expected the number of a node that is there, got 78");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 4 5 1 4 10", "3 4 5 1 5 10")),
            "a.msh:13:9: expected 4 nodes of an element of type 4, got 5");
  EXPECT_EQ(faults_of(replaced(kGmsh2, "2.2 0 8", "3.0 0 8")),
            "a.msh:2:1: expected version 2.0 to 2.2, 4.0 or 4.1, got '3.0'");
  EXPECT_EQ(faults_of(replaced(kGmsh2, "2.2 0 8", "2.2 0 4")), "a.msh:2:7: expected numbers of 8 bytes, got 4");
  EXPECT_EQ(faults_of(replaced(kVtk, "4 0 2 1 4\n", "4 0 2 1 5\n")),
            "a.msh:11:9: expected the number of a point from 0 to 4, got 5");
  EXPECT_EQ(faults_of(replaced(kVtk, "ASCII", "ascii or not")), "a.msh:3:1: expected ASCII or BINARY, got 'ascii'");
  EXPECT_EQ(faults_of(replaced(kVtk, "UNSTRUCTURED_GRID", "POLYDATA")),
            "a.msh:4:9: expected UNSTRUCTURED_GRID, as tetrahedra need, got 'POLYDATA'");
  EXPECT_EQ(faults_of(replaced(kVtk, "5 10 10", "5 9 9")),
            "a.msh:1:1: expected tetrahedra, got 2 quadrangles, 1 triangles: convert other cells to "
            "tetrahedra, for instance by Tetrahedralize in ParaView");
  EXPECT_EQ(faults_of(replaced(kVtk, "5 10 10", "10 10 10")),
            "a.msh:9:3: expected 4 nodes of a cell of type 10, got 3");
}

TEST(TetFiles, AllFaultsAreToldInOnePass) {
  std::string bytes = replaced(kGmsh1, "10 0 0 0\n", "10 0 zero 0\n");
  bytes = replaced(bytes, "77 0 1 0\n", "77 0 1\n");
  bytes = replaced(bytes, "$ENDNOD", "$ENDNODES");
  bytes = replaced(bytes, "10 77 3 12\n", "10 77 3 13\n");
  EXPECT_EQ(faults_of(bytes),
            "a.msh:3:6: expected a y coordinate, got 'zero'\n"
            "a.msh:5:7: expected a z coordinate, got the end of the line\n"
            "a.msh:8:1: expected '$ENDNOD', got '$ENDNODES'\n"
            "a.msh:8:8: expected a section such as $Nodes, got 'ES'\n"
            "a.msh:14:11: expected the number of a node that is there, got 13");
}

TEST(TetFiles, FaultsAreBounded) {
  std::string bytes = "$NOD\n1000\n";
  for (int i = 0; i < 1000; ++i) bytes += "x y z w\n";
  try {
    read_tets(bytes + "$ENDNOD\n", "a.msh");
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_EQ(bad.faults().size(), kMaxMeshFaults + 1);
    EXPECT_EQ(bad.faults().back().message, "expected fewer faults: further ones are not reported");
  }
}

TEST(TetFiles, NumbersThatAreNotFiniteOrAbsurdAreFaults) {
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "0x10", "1,5"})
    EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", std::string("3 1 ") + bad + " 0\n")),
              std::string("a.msh:4:5: expected a y coordinate, got '") + bad + "'");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", "3 1 1e10 0\n")),
            "a.msh:4:5: expected a y coordinate within 1000000000 m, got 10000000000 m");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "3 1 0 0\n", "3 1 1e10 0\n"), 0.001), "");
  MeshBytes nan{false};
  nan.all<double>(std::nan(""));
  std::string binary = gmsh2_binary(false);
  const std::size_t at = binary.find("$Nodes\n5\n") + 9 + 4 + 8;
  const std::size_t line_feed = binary.rfind('\n', at),
                    line = 1 + std::count(binary.begin(), binary.begin() + at, '\n');
  EXPECT_EQ(faults_of(binary.replace(at, 8, nan.bytes)), "a.msh:" + std::to_string(line) + ":" +
                                                             std::to_string(at - line_feed) + ": at byte " +
                                                             std::to_string(at) + ": expected a y coordinate, got nan");
}

TEST(TetFiles, AnnouncedCountsAreBelievedAsFarAsTheFileReaches) {
  EXPECT_EQ(faults_of(replaced(kGmsh1, "$NOD\n5\n", "$NOD\n4000000000\n")).substr(0, 46),
            "a.msh:2:1: expected at most 20 nodes, for whic");
  EXPECT_NE(faults_of(replaced(kGmsh1, "$NOD\n5\n", "$NOD\n-1\n")), "");
  EXPECT_NE(faults_of(replaced(kGmsh1, "$NOD\n5\n", "$NOD\n99999999999999999999\n")), "");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "$NOD\n5\n", "$NOD\n6\n")),
            "a.msh:8:1: expected 6 nodes, got '$ENDNOD' after 5");
  EXPECT_EQ(faults_of(replaced(kGmsh1, "$NOD\n5\n", "$NOD\n4\n")).substr(0, 39),
            "a.msh:7:1: expected '$ENDNOD', got '12'");
  for (const std::string& bytes : {gmsh41_binary(false), gmsh41_binary(true)}) {
    std::string many = bytes;
    std::fill_n(many.begin() + std::ptrdiff_t(many.find("$Nodes\n") + 7), 16, '\x7f');
    EXPECT_NE(faults_of(many), "");
  }
  EXPECT_NE(faults_of(replaced(kVtk, "POINTS 5", "POINTS 500000000")), "");
  EXPECT_NE(faults_of(replaced(kVtk, "CELLS 3 14", "CELLS 3 15")), "");
  EXPECT_NE(faults_of(replaced(kVtk5, "0 3 7 11\n", "0 7 3 11\n")), "");
  EXPECT_NE(faults_of(replaced(kVtk5, "0 3 7 11\n", "0 3 7 900\n")), "");
}

TEST(TetFiles, AFileCutOffAnywhereIsAFaultOrHasLostNoCell) {
  for (const std::string& bytes : {kGmsh1, kGmsh2, kGmsh40, kGmsh41, gmsh2_binary(false), gmsh40_binary(true),
                                   gmsh41_binary(false), kVtk, kVtk5, vtk_binary(), vtk5_binary()})
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const std::string part = bytes.substr(0, size);
      if (faults_of(part).empty()) {
        EXPECT_EQ(read_tets(part, "a").mesh.cells, read_tets(bytes, "a").mesh.cells) << size;
      }
    }
}

TEST(TetFiles, AnyChangedByteIsAFaultOrAMeshThatCanBeMended) {
  core::Random random(11);
  for (const std::string& good : {kGmsh1, kGmsh2, kGmsh40, kGmsh41, gmsh2_binary(false), gmsh40_binary(false),
                                  gmsh41_binary(true), kVtk, kVtk5, vtk_binary(), vtk5_binary()})
    for (int round = 0; round < 400; ++round) {
      std::string bytes = good;
      bytes[std::size_t(random.uniform() * double(bytes.size()))] = char(int(random.uniform() * 256));
      try {
        EXPECT_TRUE(inspect(repair(read_tets(bytes, "a").mesh).mesh).sound());
      } catch (const core::BadInput& bad) {
        EXPECT_FALSE(bad.faults().empty());
      }
    }
}

TEST(TetFiles, TextIsReadWithCarriageReturnsByteOrderMarksCommentsAndWhatEndsOldTexts) {
  for (const std::string& bytes : {kGmsh1, kGmsh2, kGmsh40, kGmsh41, kVtk, kVtk5}) {
    std::string other;
    for (const char c : bytes) other += c == '\n' ? '\r' : c;
    const std::vector<std::array<int, 4>> cells = read_tets(bytes, "a").mesh.cells;
    for (const std::string& text : {other, "\xef\xbb\xbf" + bytes, bytes + std::string("\x1a\0\0", 3)})
      EXPECT_EQ(read_tets(text, "a").mesh.cells, cells) << bytes.substr(0, 20);
  }
  EXPECT_EQ(read_tets(replaced(kGmsh2, "3 1 0 0\n", "# a comment\n3 1 0 0 # another\n"), "a").mesh.cells.size(), 2u);
  EXPECT_EQ(faults_of(std::string("\xff\xfe$\0N\0", 6)),
            "a.msh:1:1: expected text in UTF-8, got UTF-16: save the file as UTF-8");
}

TEST(TetFiles, MeshesAlongThePatientsAxesAreTurnedIntoOurs) {
  const TetFile plain = read_tets(kVtk, "a"), turned = read_tets(replaced(kVtk, "any title", "SPACE=RAS"), "a");
  for (std::size_t i = 0; i < plain.mesh.points.size(); ++i) {
    const Vec3d p = plain.mesh.points[i];
    EXPECT_EQ(turned.mesh.points[i], (Vec3d{-p.x, p.z, p.y}));
  }
  EXPECT_EQ(turned.notes.size(), plain.notes.size() + 1);
}

TEST(TetFiles, AMirroredSpaceTurnsTheCellsToo) {
  const TetFacts plain = inspect(read_tets(kVtk, "a").mesh);
  const TetFacts turned = inspect(read_tets(replaced(kVtk, "any title", "SPACE=LAS"), "a").mesh);
  EXPECT_EQ(turned.inverted, plain.inverted);
  EXPECT_DOUBLE_EQ(turned.volume, plain.volume);
}

TEST(TetFiles, AGridOfFacesIsASurfaceAndOneWithTetrahedraIsNot) {
  EXPECT_TRUE(holds_tetrahedra(kGmsh2));
  EXPECT_TRUE(holds_tetrahedra(kVtk));
  EXPECT_FALSE(holds_tetrahedra(replaced(kVtk, "5 10 10", "5 9 9")));
  EXPECT_FALSE(holds_tetrahedra("v 0 0 0\n"));
  EXPECT_TRUE(holds_tetrahedra(kVtk.substr(0, 120))) << "its own reader says what is wrong with it";
}

TEST(TetFiles, WhatIsNoMeshFileIsSaidToBeNone) {
  const std::string formats =
      "a.msh:1:1: expected a Gmsh file ($MeshFormat, $NOD) or a legacy VTK file (# vtk DataFile Version), got ";
  EXPECT_EQ(faults_of(""), formats + "the end of the file");
  EXPECT_EQ(faults_of("{}"), formats + "'{}'");
  EXPECT_EQ(faults_of("<?xml version=\"1.0\"?>"), formats + "XML");
  EXPECT_EQ(faults_of("\x1b[31mred"), formats + "'?[31mred'");
  EXPECT_EQ(faults_of("$Nodes\n0\n$EndNodes\n"), "a.msh:1:1: expected $MeshFormat in front of $Nodes, got none");
  EXPECT_EQ(faults_of("$Comments\n$EndComments\n"), "a.msh:1:1: expected $MeshFormat or $NOD, got neither");
}

}  // namespace trocar::geometry
