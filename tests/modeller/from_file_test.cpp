// Bodies from files of other programs: triangles, tetrahedra, STEP and IGES.
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/operations/cad_file.hpp>
#include <trocar/volumes/image/grid.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

/// Asked for in a test, not before: where a test program runs is settled by its main().
fs::path data(const char* name) { return fs::absolute(fs::path(TROCAR_SOURCE_DIR) / "tests/modeller/data" / name); }

Document empty(const Workplace& place) { return begun(place / "scene.json", false, "mine"); }

/// A block of 30 mm.
geometry::TriMesh block() {
  geometry::TriMesh out;
  for (int i = 0; i < 8; ++i) out.positions.push_back(Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * 0.03);
  for (const auto& [a, b, c, d] :
       {std::array{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}})
    out.triangles.push_back({a, b, c}), out.triangles.push_back({a, c, d});
  return out;
}

class FromCad : public testing::Test {
 protected:
  void SetUp() override {
    const fs::path program = fs::path(TROCAR_BINARY_DIR) / "trocar_cad";
    if (!fs::exists(program)) GTEST_SKIP() << "trocar_cad was not built: Open CASCADE is not installed";
    setenv("TROCAR_CAD", fs::absolute(program).c_str(), 1);
  }
  void TearDown() override { unsetenv("TROCAR_CAD"); }
};

TEST(FromFile, AMeshWithAHoleFromElsewhereIsMendedAndKeptBesideTheDocument) {
  const Workplace place;
  Document document = empty(place);
  geometry::TriMesh mesh = block();
  const double whole = geometry::volume(mesh);
  mesh.triangles.pop_back();
  fs::create_directories(place / "elsewhere");
  std::ofstream(place / "elsewhere/part.obj") << geometry::to_obj(mesh, 1e-3);
  apply(
      document, "from_file",
      R"({"file": "elsewhere/part.obj", "name": "lump", "tissue": "uterus", "unit_mm": 1, "place_mm": [0, -150, -110]})");
  EXPECT_TRUE(fs::exists(place / "lump.stl"));
  EXPECT_NEAR(built_mL(document, "lump") / (1e6 * whole), 1, 0.03);
}

TEST(FromFile, WhatCannotBeABodyIsToldAndLeavesNothing) {
  const Workplace place;
  Document document = empty(place);
  const std::string before = document.text(document.root());
  EXPECT_NE(fault_of(document, "from_file", R"({"file": "none.stl", "name": "a", "tissue": "uterus"})"), "");
  std::ofstream(place / "block.obj") << geometry::to_obj(block(), 1e-3);
  EXPECT_NE(fault_of(document, "from_file", R"({"file": "block.obj", "name": "a", "tissue": "uterus", "as": "nurbs"})")
                .find("fit_spline"),
            std::string::npos);
  EXPECT_EQ(document.text(document.root()), before);
  EXPECT_FALSE(fs::exists(place / "a.stl"));
}

std::string said_of(Document& document, const std::string& parameters) {
  return modeller::apply(*find_operation("from_file"), json(parameters), "step", document);
}

TEST(FromFile, TheUnitIsGuessedFromTheSizeAndTold) {
  const Workplace place;
  std::ofstream(place / "metres.obj") << geometry::to_obj(block());
  std::ofstream(place / "mm.obj") << geometry::to_obj(block(), 1e-3);
  for (const auto& [file, unit] : {std::pair{"metres.obj", "metres"}, std::pair{"mm.obj", "millimetres"}}) {
    Document document = empty(place);
    const std::string said =
        said_of(document, fmt::format(R"({{"file": "{}", "name": "a", "tissue": "uterus"}})", file));
    EXPECT_NE(said.find("27.00 mL in 12 triangles; coordinates are taken as " + std::string(unit)), std::string::npos)
        << said;
    EXPECT_NE(said.find("\"unit_mm\" sets another unit"), std::string::npos) << said;
  }
}

TEST(FromFile, ASizeThatIsNoOrgansAsksForTheUnit) {
  const Workplace place;
  Document document = empty(place);
  std::ofstream(place / "small.ply") << geometry::to_ply(block(), 0.01);  // 3 units long
  std::ofstream(place / "km.obj") << geometry::to_obj(block(), 1e-8);
  const std::string fault = fault_of(document, "from_file", R"({"file": "km.obj", "name": "a", "tissue": "uterus"})");
  EXPECT_NE(fault.find("expected the unit of its coordinates by \"unit_mm\""), std::string::npos) << fault;
  EXPECT_NE(fault.find("in metres"), std::string::npos) << fault;
  EXPECT_FALSE(fs::exists(place / "a.stl"));
  const std::string said = said_of(document, R"({"file": "km.obj", "name": "a", "tissue": "uterus", "unit_mm": 1e-5})");
  EXPECT_NE(said.find("27.00 mL"), std::string::npos) << said;
  const std::string tiny = said_of(document, R"({"file": "small.ply", "name": "b", "tissue": "uterus", "unit_mm": 1})");
  EXPECT_NE(tiny.find("organs hold 0.1 mL to 20 L"), std::string::npos) << tiny;
}

TEST(FromFile, SurfacesThatEncloseNothingAreRefused) {
  const Workplace place;
  Document document = empty(place);
  const geometry::TriMesh sheet{{{0, 0, 0}, {40, 0, 0}, {40, 40, 0}, {0, 40, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  geometry::TriMesh folded = sheet;  // both sides of a sheet, cut along the other diagonal behind
  folded.triangles.insert(folded.triangles.end(), {{1, 0, 3}, {1, 3, 2}});
  for (const geometry::TriMesh& mesh : {sheet, folded}) {
    std::ofstream(place / "sheet.obj") << geometry::to_obj(mesh);
    EXPECT_NE(fault_of(document, "from_file", R"({"file": "sheet.obj", "name": "a", "tissue": "uterus"})"), "");
  }
  EXPECT_FALSE(fs::exists(place / "a.stl"));
}

TEST(FromFile, TheNamesOfAFilesPartsAreToldWhereNoneIsOfThatName) {
  const Workplace place;
  Document document = empty(place);
  std::ofstream(place / "two.obj") << geometry::to_obj(
      std::vector<geometry::SurfacePart>{{"left lobe", block()}, {"right lobe", block()}}, 1e-3);
  EXPECT_NE(
      fault_of(document, "from_file", R"({"file": "two.obj", "name": "a", "tissue": "uterus", "part": "left_lobe"})")
          .find("got \"left_lobe\" (did you mean \"left lobe\"?); known: left lobe, right lobe"),
      std::string::npos);
}

TEST(FromFile, TetrahedraAreReadAndTheirUnitIsKeptWithThem) {
  const Workplace place;
  Document document = empty(place);
  const std::string mesh =
      "$NOD\n4\n1 0 0 0\n2 0.04 0 0\n3 0 0.04 0\n4 0 0 0.04\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 4\n"
      "$ENDELM\n";
  std::ofstream(place / "metres.msh") << mesh;
  const std::string said = said_of(document, R"({"file": "metres.msh", "name": "a", "tissue": "uterus"})");
  EXPECT_NE(said.find("10.67 mL in 1 tetrahedra; coordinates are taken as metres"), std::string::npos) << said;
  const scene::JsonValue body = value_of(document, thing_named(document, "a"));
  EXPECT_EQ(body.find("mesh")->value.find("unit_mm")->value.number, 1000);
  std::ofstream(place / "bad.msh") << "$NOD\n";
  EXPECT_NE(fault_of(document, "from_file", R"({"file": "bad.msh", "name": "b", "tissue": "uterus"})"), "");
  EXPECT_FALSE(fs::exists(place / "b.msh"));
}

TEST(FromFile, AMeshOf3dSlicerLiesWhereTheScanDoes) {
  const Workplace place;
  Document document = empty(place);
  geometry::TriMesh mesh = block();
  for (Vec3d& p : mesh.positions) p = p * 1e3 + Vec3d{5, 7, 11};  // [mm] L P S
  std::string stl = geometry::to_stl(mesh);
  stl.replace(0, 27, "3D Slicer output. SPACE=LPS");
  std::ofstream(place / "block.stl", std::ios::binary) << stl;
  EXPECT_NE(said_of(document, R"({"file": "block.stl", "name": "a", "tissue": "uterus"})").find("SPACE=LPS"),
            std::string::npos);
  std::vector<core::Fault> faults;
  const auto described = document.description(faults);
  ASSERT_TRUE(described && faults.empty());
  const geometry::Bounds box = geometry::bounds(described->solids.back().shape.surface->mesh.positions);
  const Vec3d corner = volumes::scene_from_patient({5, 7, 11}), other = volumes::scene_from_patient({35, 37, 41});
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(box.low[k], std::min(corner[k], other[k]), 1e-6);
    EXPECT_NEAR(box.high[k], std::max(corner[k], other[k]), 1e-6);
  }
}

TEST(FromFile, WithoutTheProgramForItACadFileSaysWhatToDo) {
  const Workplace place;
  Document document = empty(place);
  setenv("TROCAR_CAD", "/nowhere/trocar_cad", 1);
  std::string said;
  try {
    apply(document, "from_file",
          fmt::format(R"({{"file": "{}", "name": "egg", "tissue": "uterus"}})", data("egg.step").string()));
  } catch (const core::EnvironmentLacks& lacks) {
    said = lacks.what();
  }
  unsetenv("TROCAR_CAD");
  EXPECT_NE(said.find("./run.sh modeller"), std::string::npos) << said;
}

TEST_F(FromCad, AnEllipsoidInStepIsTheNurbsThatTheFileHasWithTheVolumeOfOne) {
  const Workplace place;
  Document document = empty(place);
  const std::string said = modeller::apply(
      *find_operation("from_file"),
      json(fmt::format(R"({{"file": "{}", "name": "egg", "tissue": "uterus"}})", data("egg.step").string())), "step",
      document);
  EXPECT_NE(said.find("exactly"), std::string::npos) << said;
  std::vector<core::Fault> faults;
  const auto described = document.description(faults);
  ASSERT_TRUE(described && faults.empty());
  const scene::Solid& egg = described->solids.back();
  ASSERT_TRUE(egg.shape.nurbs);
  const geometry::nurbs::Surface surface = scene::surface_of(*egg.shape.nurbs);
  const Vec3d middle{0.010, -0.150, -0.110}, half{0.020, 0.032, 0.016};
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const Vec3d p = geometry::nurbs::point(surface, i / 20.0, (j + 0.5) / 20) - middle;
      EXPECT_NEAR(
          std::sqrt(p.x * p.x / (half.x * half.x) + p.y * p.y / (half.y * half.y) + p.z * p.z / (half.z * half.z)), 1,
          1e-7);
    }
  EXPECT_NEAR(built_mL(document, "egg") / (4e6 / 3 * M_PI * half.x * half.y * half.z), 1, 0.03);
}

/// A known fault of an exporter: numbers in millimetres, said to be metres.
TEST_F(FromCad, ADrawingOfTheSizeOfAHouseAsksForItsUnit) {
  const Workplace place;
  Document document = empty(place);
  std::string step = read(data("egg.step"));
  const std::size_t at = step.find("SI_UNIT(.MILLI.,.METRE.)");
  ASSERT_NE(at, std::string::npos);
  std::ofstream(place / "house.step") << step.replace(at, 24, "SI_UNIT($,.METRE.)");
  const std::string fault =
      fault_of(document, "from_file", R"({"file": "house.step", "name": "egg", "tissue": "uterus"})");
  EXPECT_NE(fault.find("expected an organ of 0.1 mL to 20 L, got 64 m and "), std::string::npos) << fault;
  EXPECT_NE(fault.find("\"unit_mm\" sets another unit"), std::string::npos) << fault;
  apply(document, "from_file", R"({"file": "house.step", "name": "egg", "tissue": "uterus", "unit_mm": 1})");
  EXPECT_NEAR(built_mL(document, "egg") / (4.0 / 3 * M_PI * 20 * 32 * 16 * 1e-3), 1, 0.03);
}

TEST_F(FromCad, ATorusInIgesIsARingOfItsVolume) {
  const Workplace place;
  const std::vector<CadPart> parts = read_cad_file(data("ring.igs"), 5e-5);
  ASSERT_EQ(parts.size(), 1u);
  EXPECT_TRUE(parts[0].nurbs);
  EXPECT_NEAR(std::fabs(geometry::volume(parts[0].mesh)) / (2 * M_PI * M_PI * 0.03 * 0.008 * 0.008), 1, 0.01);
}

TEST_F(FromCad, OfTwoPartsOneIsChosenAndABoredBlockIsABodyOfItsTriangles) {
  const Workplace place;
  Document document = empty(place);
  const std::string file = data("two.step").string();
  EXPECT_NE(fault_of(document, "from_file", fmt::format(R"({{"file": "{}", "name": "a", "tissue": "uterus"}})", file))
                .find("2, one closed NURBS"),
            std::string::npos);
  EXPECT_NE(
      fault_of(document, "from_file",
               fmt::format(R"({{"file": "{}", "name": "a", "tissue": "uterus", "part": "1", "as": "nurbs"}})", file))
          .find("7 faces"),
      std::string::npos);
  apply(
      document, "from_file",
      fmt::format(
          R"({{"file": "{}", "name": "block", "tissue": "uterus", "part": "1", "cell_mm": 2, "place_mm": [0, -150, -110]}})",
          file));
  const double mL = (20 * 30 * 40 - M_PI * 25 * 40) * 1e-3;
  EXPECT_NEAR(built_mL(document, "block") / mL, 1, 0.03);
}

TEST_F(FromCad, DamagedFilesAreRefusedWithAReason) {
  const Workplace place;
  std::mt19937 random(7);
  for (const char* name : {"egg.step", "ring.igs"}) {
    const std::string whole = read(data(name));
    ASSERT_FALSE(whole.empty()) << name;
    for (int i = 0; i < 12; ++i) {
      std::string bytes = whole.substr(0, i % 3 == 0 ? random() % whole.size() : whole.size());
      for (int k = 0; k < 1 + i * 3 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = char(32 + random() % 95);
      std::ofstream(place / name, std::ios::binary) << bytes;
      try {
        for (const CadPart& part : read_cad_file(place / name, 1e-4))
          for (const Vec3d& p : part.mesh.positions) EXPECT_TRUE(std::isfinite(p.x + p.y + p.z));
      } catch (const core::BadInput& bad) {
        EXPECT_FALSE(bad.faults().front().message.empty());
      }
    }
  }
}

}  // namespace
}  // namespace trocar::modeller
