// Closed shapes of solids and pouches: surfaces from files, NURBS, tubes, profiles. What is read is written again, what
// is wrong is told, and what is built fills its shape and hangs still.
#include <filesystem>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/geometry/nurbs/mesh.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "../sim/small_scene.hpp"
#include "one_body.hpp"

namespace trocar::scene {
namespace {

namespace nurbs = geometry::nurbs;

constexpr double kPi = portable::pi;

void expect_only(const std::vector<std::string>& faults, const std::string& part) {
  ASSERT_EQ(faults.size(), 1u) << (faults.empty() ? "" : faults.back());
  EXPECT_NE(faults[0].find(part), std::string::npos) << faults[0];
}

/// 8 columns, 6 rows, from pole to pole along z.
std::string net_of_an_egg() {
  std::string rows = "[";
  const double r[] = {0, 14, 22, 20, 11, 0}, z[] = {-25, -24, -10, 8, 22, 26};
  for (int row = 0; row < 6; ++row) {
    rows += row == 0 ? "[" : ",\n[";
    for (int i = 0; i < 8; ++i) {
      const double a = 2 * kPi * i / 8;
      rows += fmt::format("{}[{:.6f}, {:.6f}, {}]", i == 0 ? "" : ", ",
                          r[row] * portable::cos(a) + 0.02 * z[row] * z[row], 0.7 * r[row] * portable::sin(a), z[row]);
    }
    rows += "]";
  }
  return rows + "]";
}
std::string egg() { return R"("nurbs": {"net_mm": )" + net_of_an_egg() + "}"; }

const char* const kTube =
    R"("tube": {"line_mm": [[-30, 0, 0], [-10, 5, 0], [10, -5, 0], [30, 0, 0]],
       "stations": [{"s_mm": 0, "radius_mm": 8}, {"s_mm": 60, "radius_mm": 11}]})";
const char* const kFlatTube =
    R"("tube": {"line_mm": [[-30, 0, 0], [30, 0, 0]], "stations": [{"s_mm": 0, "radius_mm": 10}], "ends": "flat"})";
const char* const kHollowTube =
    R"("tube": {"line_mm": [[-30, 0, 0], [30, 0, 0]], "stations": [{"s_mm": 0, "radius_mm": 12, "wall_mm": 4}]})";
const char* const kSpindle = R"("revolved": {"profile_mm": [[0, -30], [12, -20], [16, 0], [8, 22], [0, 30]]})";
const char* const kCone =
    R"("revolved": {"profile_mm": [[15, -20], [6, 20]], "from_mm": [1, 2, 3], "axis": [0, 1, 0], "smooth": false})";
const char* const kRing = R"("revolved": {"profile_mm": [[20, -8], [28, 0], [20, 8], [12, 0], [20, -8]]})";

std::string torus_net() {
  std::string rows = "[";
  for (int row = 0; row < 6; ++row) {
    rows += row == 0 ? "[" : ", [";
    for (int i = 0; i < 8; ++i) {
      const double a = 2 * kPi * i / 8, b = -2 * kPi * row / 6;
      rows +=
          fmt::format("{}[{:.6f}, {:.6f}, {:.6f}]", i == 0 ? "" : ", ", (25 + 9 * portable::cos(b)) * portable::cos(a),
                      (25 + 9 * portable::cos(b)) * portable::sin(a), 9 * portable::sin(b));
    }
    rows += "]";
  }
  return rows + "]";
}
std::string torus() { return R"("nurbs": {"closed": "ring", "net_mm": )" + torus_net() + "}"; }

std::vector<std::string> all_shapes() {
  return {egg(), torus(), kTube, kFlatTube, kHollowTube, kSpindle, kCone, kRing};
}

TEST(ClosedShapes, WhatIsReadIsWrittenAndReadAgain) {
  OneBodyScene t;
  for (const std::string& shape : all_shapes()) {
    for (const auto& file : {t.solid(shape + R"(, "cell_mm": 6)"), t.pouch(shape)}) {
      EXPECT_EQ(t.faults(file), std::vector<std::string>{}) << shape;
      const std::string once = write_scene(read_scene(file));
      t.folder.write("again.json", once);
      EXPECT_EQ(write_scene(read_scene(t.folder.path() / "again.json")), once) << shape;
    }
  }
}

TEST(ClosedShapes, SeveralWaysToBeNoneAreTold) {
  OneBodyScene t;
  const std::string cell = R"(, "cell_mm": 6)";
  expect_only(t.faults(t.solid(R"("cell_mm": 6)")),
              "expected a shape (sections, mesh, voxels, surface, nurbs, tube or");
  expect_only(t.faults(t.solid(std::string(kTube) + ", " + kSpindle + cell)), "expected one shape, got a second one");
  expect_only(t.faults(t.solid(kTube)), "expected \"cell_mm\"");
  expect_only(t.faults(t.pouch(R"("spacing_mm": 4)")), "expected a shape (sections, surface, nurbs, tube or revolved)");
  const std::string open = R"("nurbs": {"net_mm": [[[0,0,0],[9,0,0],[9,9,0],[0,9,0]], [[0,0,9],[9,0,9],[9,9,9],[0,9,9]],
    [[0,0,19],[9,0,19],[9,9,19],[0,9,19]], [[0,0,29],[9,0,29],[9,9,29],[0,9,29]]]})";
  expect_only(t.faults(t.solid(open + cell)), "expected a closed surface");
  expect_only(t.faults(t.solid(R"("nurbs": {"degree": [3, 2.5], "net_mm": )" + net_of_an_egg() + "}" + cell)),
              "expected a whole number for \"degree\", got 2.5");
  expect_only(t.faults(t.solid(R"("nurbs": {"knots_v": [0, 1], "net_mm": )" + net_of_an_egg() + "}" + cell)),
              "2 knots_v, 4 expected");
  expect_only(t.faults(t.solid(R"("nurbs": {"weights": [[1, 2], [3, 4]], "net_mm": )" + net_of_an_egg() + "}" + cell)),
              "4 weights, 48 expected");
  expect_only(t.faults(t.solid(R"("tube": {"line_mm": [[0, 0, 0], [0, 0, 0]],
      "stations": [{"s_mm": 0, "radius_mm": 8}]})" +
                               cell)),
              "got the same place");
  expect_only(t.faults(t.solid(R"("tube": {"line_mm": [[0, 0, 0], [30, 0, 0]],
      "stations": [{"s_mm": 0, "radius_mm": 8, "wall_mm": 9}]})" +
                               cell)),
              "expected a wall below the radius of 8 mm");
  expect_only(t.faults(t.solid(R"("tube": {"line_mm": [[0, 0, 0], [30, 0, 0]],
      "stations": [{"s_mm": 0, "radius_mm": 8, "wall_mm": 2}, {"s_mm": 9, "radius_mm": 8}]})" +
                               cell)),
              "expected a wall_mm at every station or at none");
  std::string long_line;
  for (int i = 0; i < 300; ++i) long_line += fmt::format("{}[{}, 0, 0]", i == 0 ? "" : ", ", i);
  expect_only(t.faults(t.solid(R"("tube": {"line_mm": [)" + long_line +
                               R"(], "stations": [{"s_mm": 0, "radius_mm": 8}]})" + cell)),
              "300 points of its line, at most 200 expected");
  expect_only(t.faults(t.solid(R"("revolved": {"profile_mm": [[0, 0, 1], [3, 4, 1]]})" + cell)), "rows of 2 numbers");
  expect_only(t.faults(t.solid(R"("revolved": {"profile_mm": [[0, 0], [0, 4], [3, 8]]})" + cell)),
              "expected r above 0 between the ends");
  expect_only(t.faults(t.solid(R"("revolved": {"profile_mm": [[0, 0], [3, 4], [3, 4, 5]]})" + cell)), "row of");
}

Description read(const std::filesystem::path& file) { return read_scene(file); }

double volume_of(const std::string& shape, OneBodyScene& t) {
  return size_of(read(t.solid(shape + R"(, "cell_mm": 6)")).solids.at(0).shape).volume;
}

TEST(ClosedShapes, HaveTheVolumesThatTheyShould) {
  OneBodyScene t;
  const auto cylinder = [](double r, double l) { return kPi * r * r * l * 1e-9; };
  EXPECT_NEAR(volume_of(kFlatTube, t) / cylinder(10, 60), 1, 0.02);
  EXPECT_NEAR(volume_of(kHollowTube, t) / (cylinder(12, 60) - cylinder(8, 60)), 1, 0.02);
  EXPECT_NEAR(volume_of(kCone, t) / (kPi * 40 / 3 * (225 + 36 + 90) * 1e-9), 1, 0.02);
}

TEST(ClosedShapes, AreFilledAndHangStill) {
  OneBodyScene t;
  for (const std::string& shape : all_shapes())
    for (const bool cuttable : {false, true}) {
      SCOPED_TRACE(shape + (cuttable ? " cuttable" : ""));
      const std::filesystem::path file =
          t.solid(shape + (cuttable ? R"(, "cuttable": true, "cell_mm": )" : R"(, "skin_edge_mm": 4, "cell_mm": )") +
                  (cuttable && shape == kHollowTube ? "2.5" : "5"));
      const Description d = read(file);
      CompileReport report;
      const sim::Model model = compile(d, &report);
      const BodyReport& body = body_of(report);
      EXPECT_EQ(report.warnings.size(), 0u) << report.warnings.front().message;
      EXPECT_LE(body.substeps, 12);
      EXPECT_NEAR(body.volume / size_of(d.solids[0].shape).volume, 1, 0.12);
      EXPECT_LT(drift(model), 1e-5);
    }
}

TEST(ClosedShapes, ArePouchesThatHangStill) {
  OneBodyScene t;
  for (const std::string& shape : {egg(), std::string(kTube), std::string(kSpindle)}) {
    SCOPED_TRACE(shape);
    const sim::Model model = compile(read(t.pouch(shape + R"(, "spacing_mm": 4)")));
    ASSERT_EQ(model.membranes.size(), 1u);
    EXPECT_TRUE(model.membranes[0].sheet.closed());
    sim::State state = sim::initial_state(model);
    sim::Work work = sim::make_work(model);
    for (int i = 0; i < 300; ++i) sim::step(model, model.start, state, work);
    const tissue::NetworkModel& wall = model.membranes[0].sheet.network;
    for (int i = 0; i < wall.nodes; ++i)
      ASSERT_LT(length(tissue::position(wall, state.membranes[0].network, i) - wall.rest[std::size_t(i)]), 1e-5);
  }
}

TEST(ClosedShapes, ThinPartsThatCellsLoseAreToldAndMuchOfABodyIsRefused) {
  OneBodyScene t;
  const std::string filled = R"(, "cuttable": true, "cell_mm": 5)";
  CompileReport report;
  compile(read(t.solid(R"("tube": {"line_mm": [[-30, 0, 0], [30, 0, 0]],
      "stations": [{"s_mm": 0, "radius_mm": 8}, {"s_mm": 60, "radius_mm": 1}]})" +
                       filled)),
          &report);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].message.find("'body' has thin parts: cells of 5 mm keep "), std::string::npos)
      << report.warnings[0].message;
  EXPECT_THROW(compile(read(t.solid(kHollowTube + filled))), core::BadInput);
}

/// A ball of 20 mm radius about the origin [mm].
geometry::TriMesh ball_mm() {
  geometry::TriMesh mesh =
      geometry::tessellate(geometry::loft(std::vector<geometry::Section>{{{0, 0, -8}, {18, 0, 0}, {0, 18, 0}},
                                                                         {{0, 0, 8}, {18, 0, 0}, {0, 18, 0}}}),
                           4);
  return mesh;
}

TEST(SurfaceShapes, AreReadFromEveryFormatWithItsUnit) {
  OneBodyScene t;
  const geometry::TriMesh ball = ball_mm();
  t.folder.write("ball.obj", geometry::to_obj(ball));
  t.folder.write("ball.stl", geometry::to_stl(ball));
  t.folder.write("ball.ply", geometry::to_ply(ball));
  t.folder.write("ball.vtk", geometry::to_polydata(ball));
  const double volume = geometry::volume(ball) * 1e-9;
  for (const char* name : {"ball.obj", "ball.stl", "ball.ply", "ball.vtk"}) {
    const std::string file = fmt::format(R"("surface": {{"file": "{}")", name);
    const auto shape = read(t.solid(file + R"(, "place_mm": [1, 2, 3]}, "cell_mm": 6)")).solids.at(0).shape;
    ASSERT_TRUE(shape.surface) << name;
    EXPECT_NEAR(geometry::volume(shape.surface->mesh) / volume, 1, 1e-5) << name;
    EXPECT_NEAR(length(geometry::centre_of_volume(shape.surface->mesh) - Vec3d{0.001, 0.002, 0.003}), 0, 1e-4);
    EXPECT_TRUE(shape.surface->warnings.empty());
    const auto tenfold = read(t.solid(file + R"(, "unit_mm": 10}, "cell_mm": 60)")).solids.at(0).shape;
    EXPECT_NEAR(geometry::volume(tenfold.surface->mesh) / volume, 1000, 0.01) << name;
  }
  geometry::TriMesh in_metres = ball;
  for (Vec3d& p : in_metres.positions) p = p / 1000.0;
  t.folder.write("metres.obj", geometry::to_obj(in_metres));
  expect_only(t.faults(t.solid(R"("surface": {"file": "metres.obj"}, "cell_mm": 6)")),
              "with coordinates in millimetres; \"unit_mm\" sets another unit");
  const auto metres = read(t.solid(R"("surface": {"file": "metres.obj", "unit_mm": 1000}, "cell_mm": 6)")).solids.at(0);
  EXPECT_NEAR(geometry::volume(metres.shape.surface->mesh) / volume, 1, 1e-5);
  expect_only(t.faults(t.solid(R"("surface": {"file": "none.obj"}, "cell_mm": 6)")), "none of this name");
  expect_only(t.faults(t.solid(R"("surface": {"file": "ball.obj", "unit_mm": 1000}, "cell_mm": 60)")),
              "expected coordinates within 2000 mm");
  expect_only(t.faults(t.solid(R"("surface": {"file": "ball.obj", "part": "bail"}, "cell_mm": 6)")),
              "expected a known part of the file");
}

TEST(SurfaceShapes, WhatIsNotClosedIsMendedAndTold) {
  OneBodyScene t;
  geometry::TriMesh open = ball_mm();
  open.triangles.erase(open.triangles.begin() + 20, open.triangles.begin() + 23);
  t.folder.write("open.obj", geometry::to_obj(open));
  const std::string file = R"("surface": {"file": "open.obj")";
  CompileReport report;
  compile(read(t.solid(file + R"(}, "cell_mm": 6)")), &report);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings[0].message.find("the surface 'open.obj' of 'body': it has defects; mended: "),
            std::string::npos)
      << report.warnings[0].message;
  expect_only(t.faults(t.solid(file + R"(, "mend": false}, "cell_mm": 6)")),
              "expected a closed surface, as mending is off, got: ");
  geometry::TriMesh sheet;
  sheet.positions = {{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 9, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}};
  t.folder.write("sheet.obj", geometry::to_obj(sheet));
  expect_only(t.faults(t.solid(R"("surface": {"file": "sheet.obj"}, "cell_mm": 6)")),
              "expected a surface that can be mended to a closed one, got: ");
  t.folder.write("sheets.obj", geometry::to_obj(std::vector<geometry::SurfacePart>{{"one", sheet}, {"two", open}}));
  expect_only(t.faults(t.solid(R"("surface": {"file": "sheets.obj"}, "cell_mm": 6)")),
              "(\"part\" takes one of: one, two)");
  EXPECT_EQ(t.faults(t.solid(R"("surface": {"file": "sheets.obj", "part": "two"}, "cell_mm": 6)")),
            std::vector<std::string>{});
}

/// Edges with three triangles and with four: a fin that stands on a ball encloses nothing, another ball that touches
/// the first along an edge is a body.
TEST(SurfaceShapes, AnSTLThatIsNoManifoldIsMendedAndToldOrRefusedWithWhatIsLeftOpen) {
  OneBodyScene t;
  const geometry::TriMesh ball = ball_mm();
  geometry::TriMesh finned = ball;
  const auto [a, b, c] = ball.triangles[20];
  const Vec3d one = ball.positions[std::size_t(a)], other = ball.positions[std::size_t(b)];
  finned.positions.push_back(0.7 * (one + other));
  finned.triangles.push_back({a, b, int(ball.positions.size())});
  t.folder.write("finned.stl", geometry::to_stl(finned));
  expect_only(t.faults(t.solid(R"("surface": {"file": "finned.stl"}, "cell_mm": 6)")),
              "is left open: it encloses nothing");
  geometry::TriMesh twins = ball;
  const int n = int(ball.positions.size());
  for (const Vec3d& p : ball.positions) twins.positions.push_back(one + other - p);  // through the edge's middle
  for (const auto& [x, y, z] : ball.triangles) twins.triangles.push_back({x + n, z + n, y + n});
  t.folder.write("twins.stl", geometry::to_stl(twins));
  CompileReport report;
  compile(read(t.solid(R"("surface": {"file": "twins.stl"}, "cell_mm": 6)")), &report);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings[0].message.find("has defects; mended: "), std::string::npos) << report.warnings[0].message;
  EXPECT_NEAR(report.bodies[0].volume / (2e-9 * geometry::volume(ball)), 1, 0.05);
}

TEST(SurfaceShapes, SliversOfOthersCostNoSubSteps) {
  OneBodyScene t;
  geometry::TriMesh mesh = ball_mm();
  for (std::size_t k = 0; k < 200; k += 5) {  // a vertex in a triangle, next to one of its edges
    const std::array<int, 3> c = mesh.triangles[k];
    const Vec3d a = mesh.positions[std::size_t(c[0])], b = mesh.positions[std::size_t(c[1])],
                top = mesh.positions[std::size_t(c[2])];
    mesh.positions.push_back(0.5 * (a + b) + 4e-4 * (top - 0.5 * (a + b)));
    const int v = int(mesh.positions.size()) - 1;
    mesh.triangles[k] = {c[0], c[1], v};
    mesh.triangles.push_back({c[1], c[2], v});
    mesh.triangles.push_back({c[2], c[0], v});
  }
  double least = 60;
  for (int i = 0; i < int(mesh.triangles.size()); ++i) least = std::min(least, geometry::least_angle_deg(mesh, i));
  EXPECT_LT(least, 0.06);
  t.folder.write("slivers.obj", geometry::to_obj(mesh));
  for (const char* keys : {R"(, "cell_mm": 5)", R"(, "cell_mm": 5, "cuttable": true)"}) {
    CompileReport report;
    const sim::Model model =
        compile(read(t.solid(std::string(R"("surface": {"file": "slivers.obj"})") + keys)), &report);
    EXPECT_LE(body_of(report).substeps, 12) << keys;
    EXPECT_LT(drift(model), 1e-5) << keys;
  }
}

TEST(ControlPoints, OfNurbsWithPolesOnly) {
  OneBodyScene t;
  const std::string masses = R"(, "masses": "control_points")";
  EXPECT_EQ(t.faults(t.solid(egg() + masses)), std::vector<std::string>{});
  expect_only(t.faults(t.solid(kTube + masses)), "expected control points of \"nurbs\", got another shape");
  expect_only(t.faults(t.solid(torus() + masses)), "got a ring");
  expect_only(t.faults(t.solid(egg() + masses + R"(, "cuttable": true)")), "not cuttable");
  expect_only(t.faults(t.solid(egg() + masses + R"(, "cell_mm": 5)")), "no cell_mm where masses are control points");
  const std::string once = write_scene(read(t.solid(egg() + masses)));
  t.folder.write("again.json", once);
  EXPECT_EQ(write_scene(read(t.folder.path() / "again.json")), once);
}

/// What a solid with masses at control points is made of.
struct Controlled {
  OneBodyScene t;
  Description d = read(t.solid(egg() + R"(, "masses": "control_points", "skin_edge_mm": 3)"));
  CompileReport report;
  sim::Model model = compile(d, &report);
  const sim::SolidModel& body = model.solids.at(0);
  nurbs::Surface surface = surface_of(*d.solids[0].shape.nurbs);
  nurbs::Nodes nodes = nurbs::nodes_of(surface);
};

TEST(ControlPoints, WeighWhatTheBodyDoesAboutItsCentreAndHangStill) {
  Controlled c;
  double mass = 0;
  Vec3d centre;
  for (std::size_t i = 0; i < c.body.network.mass.size(); ++i) {
    mass += c.body.network.mass[i];
    centre += c.body.network.mass[i] * c.body.network.rest[i];
    EXPECT_GT(c.body.network.mass[i], 0);
  }
  const geometry::TriMesh fine = nurbs::tessellate(c.surface, nurbs::Steps{24, 24}).mesh;
  EXPECT_NEAR(mass / (1060 * nurbs::volume(c.surface)), 1, 1e-9);
  EXPECT_NEAR(length(centre / mass - geometry::centre_of_volume(fine)), 0, 1e-4);
  EXPECT_LE(body_of(c.report).substeps, 20);
  EXPECT_LT(drift(c.model), 1e-5);
}

/// A spindle along z, smooth at its poles, 80 mm long.
NurbsShape spindle(int columns, int rows) {
  NurbsShape s;
  s.columns = columns, s.rows = rows;
  for (int j = 0; j < rows; ++j) {
    const bool pole = j == 0 || j == rows - 1;
    const double t = double(j == 1 ? 0 : j == rows - 2 ? rows - 1 : j) / (rows - 1);  // in the poles' planes
    const double r = pole ? 0 : 0.018 * portable::sin(kPi * std::clamp(t, 0.12, 0.88));
    for (int i = 0; i < columns; ++i) {
      const double a = 2 * kPi * i / columns;
      s.net.push_back({r * portable::cos(a), r * portable::sin(a), -0.04 + 0.08 * t});
    }
  }
  return s;
}

/// How far the upper part of a spindle that is held below, up to one of its rings, goes under a force on it [m].
double deflection(Masses masses, Vec3d force) {
  Description d = small::description();
  d.solids.clear(), d.strands.clear(), d.membranes.clear(), d.vessels.clear(), d.fluids.reset();
  d.gravity = {};
  for (Tissue& t : d.tissues) t.p1 = t.p2 = 0;
  Solid s;
  s.name = s.look = "body";
  s.tissue = "flesh";
  s.shape.nurbs = spindle(12, 12);
  s.masses = masses;
  s.cell = 0.004, s.skin_edge = 0.004, s.fine_edge = 0.003;
  s.anchors.push_back({{0, 0, -0.54}, 0.522, 0, {}});
  d.solids.push_back(s);
  const sim::Model model = compile(d);
  const sim::SolidModel& body = model.solids.at(0);
  std::vector<int> upper;
  for (int v = 0; v < body.skin.size(); ++v)
    if (body.skin.rest[std::size_t(v)].z > 0.02f) upper.push_back(v);
  tissue::NetworkState state = tissue::rest_state(body.network);
  tissue::NetworkWork work = tissue::make_work(body.network);
  interactions::NetworkLoads loads;
  loads.reserve(20'000);
  for (int i = 0; i < 2000; ++i) {
    loads.clear();
    interactions::SkinLoad load;
    load.f0 = force / double(upper.size());
    load.d = 1.0 / double(upper.size());  // so that it comes to rest
    for (const int v : upper)
      interactions::add_skin_load(tissue::view_of(body.network, state), body.skin, v, load, {}, loads, 1e-9f);
    loads.sort();
    tissue::advance(body.network, loads.sorted, loads.reaction, state, work);
  }
  double sum = 0;
  for (const int v : upper)
    sum += dot(normalised(force), tissue::skin_point(tissue::view_of(body.network, state), body.skin, v) -
                                      vec_cast<double>(body.skin.rest[std::size_t(v)]));
  return sum / double(upper.size());
}

TEST(ControlPoints, GiveWayAsALatticeOfTheSameBodyDoes) {
  for (const Vec3d& force : {Vec3d{0.02, 0, 0}, Vec3d{0, 0, 0.2}}) {
    const double cells = deflection(Masses::inside, force), points = deflection(Masses::control_points, force);
    EXPECT_NEAR(points / cells, 1, 0.1);
    EXPECT_GT(cells, 1e-4);
  }
}

TEST(ControlPoints, AnswerAtOnceAsWell) {
  OneBodyScene t;
  CompileReport report;
  const sim::Model model =
      compile(read(t.solid(egg() + R"(, "masses": "control_points", "skin_edge_mm": 4, "solver": "static")")), &report);
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_LT(drift(model), 1e-5);
  expect_only(
      t.faults(t.solid(egg() + R"(, "masses": "control_points", "solver": "static", "elasticity": "tetrahedra")")),
      "expected springs where masses are control points");
}

TEST(ControlPoints, TheDeformedSkinIsTheNurbsOfTheMovedControlPoints) {
  Controlled c;
  tissue::NetworkState state = tissue::rest_state(c.body.network);
  for (int i = 0; i < c.body.network.nodes; ++i) {
    const Vec3d p = c.body.network.rest[std::size_t(i)];
    const Vec3d moved = p + Vec3d{0.004 * portable::sin(90 * p.z + i), 0.003 * portable::cos(2.0 * i), 0.2 * p.x};
    tissue::set_position(c.body.network, state, i, moved);
    if (i < c.nodes.count)
      for (std::size_t k = 0; k < c.surface.points.size(); ++k)
        if (c.nodes.of_point[k] == i) c.surface.points[k] = moved;
  }
  const BodySurface shape = surface_of_body(c.d.solids[0]);
  const double size = length(geometry::bounds(c.surface.points).high - geometry::bounds(c.surface.points).low);
  for (const auto& [skin, edge] :
       {std::pair{&c.body.skin, c.d.solids[0].skin_edge}, std::pair{&c.body.fine, c.d.solids[0].fine_edge}}) {
    const EvenSurface drawn = skin_surface(shape, edge);
    ASSERT_EQ(int(drawn.parameters.size()), skin->size());
    tissue::SkinPose pose = tissue::make_pose(*skin);
    tissue::pose_skin(tissue::view_of(c.body.network, state), *skin, pose);
    for (int v = 0; v < skin->size(); ++v) {
      const auto [u, w] = drawn.parameters[std::size_t(v)];
      const Vec3d there = nurbs::point(c.surface, u, w);
      ASSERT_LT(length(vec_cast<double>(pose.position[std::size_t(v)]) - there), 1e-6 * size) << v;
      ASSERT_LT(length(tissue::skin_point(tissue::view_of(c.body.network, state), *skin, v) - there), 1e-6 * size) << v;
    }
  }
}

TEST(ControlPoints, WhatPushesTheSkinPushesTheNodesByTheSameForceAndMoment) {
  Controlled c;
  const tissue::NetworkState state = tissue::rest_state(c.body.network);
  const tissue::NodeView view = tissue::view_of(c.body.network, state);
  interactions::NetworkLoads loads;
  loads.reserve(64);
  int widest = 0;
  for (int v = 0; v < c.body.skin.size(); ++v) {
    loads.clear();
    const Vec3d force{0.3, -0.2, 0.1};
    interactions::SkinLoad load;
    load.f0 = force;
    interactions::add_skin_load(view, c.body.skin, v, load, {}, loads, 1e-12f);
    Vec3d sum, moment;
    for (const tissue::NodeLoad& l : loads.gathered) {
      sum += vec_cast<double>(l.f0);
      moment += cross(tissue::position(c.body.network, state, l.node), vec_cast<double>(l.f0));
    }
    widest = std::max(widest, int(loads.gathered.size()));
    ASSERT_LT(length(sum - force), 1e-6);
    ASSERT_LT(length(moment - cross(vec_cast<double>(c.body.skin.rest[std::size_t(v)]), force)), 1e-7);
  }
  EXPECT_GT(widest, 8) << "rows of W are wider than eight";
}

TEST(Walls, DegreeKnotsAndWeightsMakeAnExactQuarterOfATube) {
  OneBodyScene t;
  const std::string net = R"("net_mm": [[[30,0,0],[30,30,0],[0,30,0]], [[30,0,50],[30,30,50],[0,30,50]],
      [[30,0,90],[30,30,90],[0,30,90]]])";
  const auto with = [&](const std::string& more) {
    return t.scene(R"("walls": [{"name": "w", "edge_mm": 3, )" + net + more + "}]");
  };
  const std::string conic = R"(, "degree": [2, 1], "knots_u": [0, 1], "weights": [[1, 0.70710678118654752, 1],
      [1, 0.70710678118654752, 1], [1, 0.70710678118654752, 1]])";
  const Description d = read(with(conic));
  const sim::Model model = compile(d);
  for (const Vec3f& p : model.walls.at(0).skin.rest) ASSERT_NEAR(length(Vec3f{p.x, p.y, 0}), 0.03, 1e-7);
  t.folder.write("again.json", write_scene(d));
  EXPECT_EQ(write_scene(read(t.folder.path() / "again.json")), write_scene(d));
  expect_only(t.faults(with(R"(, "knots_v": [0, 1, 2, 3])")), "4 knots_v, 2 expected");
  expect_only(t.faults(with(R"(, "degree": [5, 1])")), "3 control points, at least 6 expected for the degree 5");
  expect_only(t.faults(with(R"(, "weights": [[1, 1], [1, 1]])")), "expected one for each of 9 control points, got 4");
}

}  // namespace
}  // namespace trocar::scene
