// What operations do to shapes.
#include <cmath>

#include <trocar/geometry/nurbs/surface.hpp>
#include <trocar/geometry/surface_files/surface_file.hpp>
#include <trocar/geometry/surface_files/surface_writer.hpp>
#include <trocar/geometry/surfaces/loft.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/drive/built.hpp>
#include <trocar/modeller/drive/export_body.hpp>
#include <trocar/modeller/operations/body_mesh.hpp>
#include <trocar/modeller/operations/points.hpp>
#include <trocar/modeller/operations/transform.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/script/session.hpp>
#include <trocar/scene/json/json_edit.hpp>

#include "workplace.hpp"

namespace trocar::modeller {
namespace {

Document with_ball(const Workplace& place, const std::string& half = "[15, 25, 12]") {
  Document document = begun(place / "scene.json", false, "mine");
  apply(
      document, "ellipsoid",
      R"({"name": "ball", "tissue": "uterus", "centre_mm": [10, -150, -110], "cell_mm": 4, "half_mm": )" + half + "}");
  apply(document, "hold", R"({"of": "ball", "centre_mm": [10, -150, -110], "radius_mm": 9})");
  return document;
}

TEST(Operations, AnEllipsoidHasTheVolumeOfOne) {
  const Workplace place;
  for (const auto& [half, a] : {std::pair{"[15, 25, 12]", 15.0 * 25 * 12}, std::pair{"[20, 20, 20]", 20.0 * 20 * 20},
                                std::pair{"[30, 12, 12]", 30.0 * 12 * 12}}) {
    const double wanted = 4.0 / 3 * M_PI * a * 1e-3;
    EXPECT_NEAR(built_mL(with_ball(place, half), "ball") / wanted, 1, 0.03) << half;
  }
}

TEST(Operations, MovingTurningAndMirroringKeepTheVolumeAndScalingCubesIt) {
  const Workplace place;
  Document document = with_ball(place);
  const double v = built_mL(document, "ball");
  apply(document, "move", R"({"of": ["ball"], "by_mm": [3, -2, 5]})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 1e-6);
  apply(document, "rotate", R"({"of": ["ball"], "axis": [0.5, 1, -0.5], "by_deg": 33})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 0.01);
  apply(document, "mirror", R"({"of": ["ball"]})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 0.01);
  apply(document, "scale", R"({"of": ["ball"], "by": 1.2})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1.728, 0.02);
}

TEST(Operations, FourQuarterTurnsAndTwoMirrorsGiveThePlacesBack) {
  const Workplace place;
  Document document = with_ball(place);
  const Thing ball = thing_named(document, "ball");
  const std::vector<PlacedPoint> before = points_in(value_of(document, ball), "/sections");
  for (int i = 0; i < 4; ++i) apply(document, "rotate", R"({"of": ["ball"], "axis": [0, 0, 1], "by_deg": 90})");
  for (int i = 0; i < 2; ++i) apply(document, "mirror", R"({"of": ["ball"], "x_mm": 4})");
  const std::vector<PlacedPoint> after = points_in(value_of(document, ball), "/sections");
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t i = 0; i < after.size(); ++i) EXPECT_LT(length(after[i].at - before[i].at), 1e-3);
}

TEST(Operations, ADuplicateLiesWhereItIsWantedAndARenamedThingIsRenamedEverywhere) {
  const Workplace place;
  Document document = with_ball(place);
  apply(document, "cord", R"({"name": "cord", "tissue": "tube", "radius_mm": 2, "start_on": "ball",
    "line_mm": [[10, -125, -110], [10, -110, -105], [10, -95, -100]]})");
  apply(document, "duplicate", R"({"of": "ball", "as": "second", "by_mm": [0, -70, 0]})");
  const Vec3d at = middle_of(value_of(document, thing_named(document, "second")));
  EXPECT_NEAR(at.y, middle_of(value_of(document, thing_named(document, "ball"))).y - 70, 1e-3);
  apply(document, "rename", R"({"of": "ball", "to": "organ"})");
  const scene::JsonValue cord = value_of(document, thing_named(document, "cord"));
  EXPECT_EQ(cord.find("start")->value.find("solid")->value.text, "organ");
  EXPECT_TRUE(build(document).good());
}

TEST(Operations, SoftSelectionFadesOutAndTheOtherSideFollowsMirrored) {
  const std::vector<PlacedPoint> all{{"/0", {10, 0, 0}}, {"/1", {14, 0, 0}}, {"/2", {30, 0, 0}}, {"/3", {-10, 0, 0}}};
  const std::vector<PlacedPoint> after = moved(all, 0, {1, 2, 3}, 10, true);
  ASSERT_EQ(after.size(), 3u);
  EXPECT_LT(length(after[0].at - Vec3d{11, 2, 3}), 1e-12);
  const double share = (1 - 0.16) * (1 - 0.16);  // d / soft = 0.4
  EXPECT_LT(length(after[1].at - Vec3d{14 + share, 2 * share, 3 * share}), 1e-12);
  EXPECT_LT(length(after[2].at - Vec3d{-11, 2, 3}), 1e-12);
}

TEST(Operations, ASectionPutBetweenTwoOthersLiesBetweenThem) {
  const Workplace place;
  Document document = with_ball(place);
  const double v = built_mL(document, "ball");
  apply(document, "insert_point", R"({"of": "ball", "key": "sections", "before": 2})");
  const std::vector<PlacedPoint> points = points_in(value_of(document, thing_named(document, "ball")), "/sections");
  ASSERT_EQ(points.size(), 6u);
  EXPECT_LT(length(points[2].at - (points[1].at + points[3].at) / 2.0), 1e-3);
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 0.05);
  apply(document, "remove_point", R"({"of": "ball", "key": "sections", "item": 2})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 1e-9);
}

/// The NURBS of a solid as the document describes it now.
geometry::nurbs::Surface spline_of(const Document& document, const std::string& name) {
  std::vector<core::Fault> faults;
  const auto d = document.description(faults);
  for (const scene::Solid& solid : d->solids)
    if (solid.name == name && solid.shape.nurbs) return scene::surface_of(*solid.shape.nurbs);
  ADD_FAILURE() << name << " is no NURBS";
  return {};
}

double farthest_apart(const geometry::nurbs::Surface& a, const geometry::nurbs::Surface& b) {
  double most = 0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      most = std::max(most, length(point(a, i / 20.0, j / 20.0) - point(b, i / 20.0, j / 20.0)));
  return most;
}

TEST(Splines, ALoftBecomesANurbsOfTheSameShapeAndKeepsItUnderKnotsAndHigherDegrees) {
  const Workplace place;
  Document document = with_ball(place);
  const double v = built_mL(document, "ball");
  apply(document, "to_spline", R"({"of": "ball"})");
  EXPECT_NEAR(built_mL(document, "ball") / v, 1, 1e-3);
  const geometry::nurbs::Surface first = spline_of(document, "ball");
  apply(document, "insert_knot", R"({"of": "ball", "way": "along", "at": 0.41})");
  apply(document, "insert_knot", R"({"of": "ball", "way": "around", "at": 0.13})");
  EXPECT_EQ(spline_of(document, "ball").points.size(), (first.u.points() + 1u) * (first.v.points() + 1u));
  EXPECT_LT(farthest_apart(spline_of(document, "ball"), first), 1e-9);
  apply(document, "remove_knot", R"({"of": "ball", "way": "along", "at": 0.41, "tolerance_mm": 0.001})");
  EXPECT_LT(farthest_apart(spline_of(document, "ball"), first), 2e-6);
  apply(document, "raise_degree", R"({"of": "ball", "way": "along"})");
  EXPECT_LT(farthest_apart(spline_of(document, "ball"), first), 2e-6);
  EXPECT_TRUE(build(document).good());
}

TEST(Splines, AMeshFromAFileBecomesASplineBodyAndItsResidualIsTold) {
  const Workplace place;
  Document document = with_ball(place, "[20, 30, 18]");
  std::vector<geometry::Section> sections;
  std::vector<core::Fault> faults;
  const auto described = document.description(faults);
  for (const scene::Section& s : described->solids[0].sections)
    sections.push_back({s.centre, s.across, s.deep, s.squareness});
  const std::string stl = geometry::to_stl(geometry::tessellate(geometry::loft(sections), 0.003), 1e-3);
  std::ofstream(place / "mesh.stl", std::ios::binary) << stl;
  const std::string said = modeller::apply(
      *find_operation("fit_spline"),
      json(R"({"file": "mesh.stl", "name": "fitted", "tissue": "uterus", "cell_mm": 5, "around": 12, "along": 14})"),
      "step", document);
  EXPECT_NE(said.find("mm rms"), std::string::npos) << said;
  EXPECT_NEAR(built_mL(document, "fitted") / built_mL(document, "ball"), 1, 0.02) << said;
  EXPECT_NE(fault_of(document, "fit_spline",
                     R"({"file": "mesh.stl", "name": "other", "tissue": "uterus", "cell_mm": 5, "around": 4, "along": 5,
                         "most_mm": 0.001})")
                .find("a fit within"),
            std::string::npos);
}

TEST(Operations, RadiiOfADrawnTreeFollowMurraysLawAndItsFlowStays) {
  const Workplace place;
  Document document = with_ball(place);
  apply(document, "vessel_tree", R"({"file": "arteries.json", "name": "arteries", "vessel": "trunk", "radius_mm": 1.6,
    "flow_mL_min": 60, "path_mm": [[-50, -150, -110], [-30, -150, -110]]})");
  apply(document, "branch", R"({"of": "trunk", "name": "a", "path_mm": [[-20, -140, -110]]})");
  apply(document, "branch", R"({"of": "trunk", "name": "b", "path_mm": [[-20, -160, -110]]})");
  apply(document, "branch", R"({"of": "a", "name": "c", "path_mm": [[-10, -140, -110]]})");
  const auto radius = [&](const std::string& name) {
    return number_in(value_of(document, thing_named(document, "vessel:" + name)), "radius_mm", 0);
  };
  EXPECT_NEAR(std::pow(radius("a"), 3) + std::pow(radius("b"), 3), std::pow(radius("trunk"), 3), 1e-3);
  EXPECT_NEAR(radius("c"), radius("a"), 1e-4);
  const fs::path file = whole_path(place / "arteries.json");
  std::vector<core::Fault> faults;
  const scene::JsonDocument tree = scene::parse_json(document.text(file), "", faults);
  double flow = 0;
  const scene::JsonValue& ends = tree.root.find("ends")->value;
  for (const scene::JsonValue& end : ends.items) flow += number_in(end, "flow_mL_min", 0);
  EXPECT_EQ(ends.items.size(), 2u);
  EXPECT_NEAR(flow, 60, 1e-3);
  EXPECT_TRUE(build(document).good());
}

TEST(Operations, APouchIsTiedWhereItFacesAnOrganAndPeelsOffNowhereElse) {
  const Workplace place;
  Document document = with_ball(place, "[30, 30, 14]");
  apply(document, "ellipsoid", R"({"name": "sack", "tissue": "gallbladder_wall", "pouch": true, "cell_mm": 3,
    "centre_mm": [10, -150, -90], "half_mm": [9, 16, 7]})");
  const std::string said =
      modeller::apply(*find_operation("bond_facing"),
                      json(R"({"of": "sack", "on": "ball", "name": "bed", "within_mm": 3})"), "step", document);
  EXPECT_NE(said.find("tied where"), std::string::npos);
  std::vector<core::Fault> faults;
  const auto d = document.description(faults);
  ASSERT_TRUE(d.has_value()) << core::to_string(faults.front());
  ASSERT_EQ(d->pouches[0].bonds.size(), 1u);
  for (const scene::Anchor& ball : d->pouches[0].bonds[0].places)
    EXPECT_LT(ball.centre.z, -0.091) << "only below is the organ";
  EXPECT_TRUE(build(document).good());
  apply(document, "move", R"({"of": ["sack"], "by_mm": [0, 0, 40]})");
  EXPECT_NE(fault_of(document, "bond_facing", R"({"of": "sack", "on": "ball", "name": "far", "within_mm": 3})")
                .find("come within"),
            std::string::npos);
}

TEST(Operations, AFoldsBaseLiesOnTheOrgan) {
  const Workplace place;
  Document document = with_ball(place, "[30, 30, 14]");
  apply(document, "cord", R"({"name": "cord", "tissue": "tube", "radius_mm": 2,
    "line_mm": [[-15, -150, -84], [0, -150, -82], [15, -150, -82], [30, -150, -84]]})");
  apply(document, "fold", R"({"name": "fold", "tissue": "peritoneal_fold", "strand": "cord", "onto": "ball",
    "from_mm": 8, "to_mm": 36})");
  const Thing fold = thing_named(document, "fold");
  const geometry::TriMesh mesh = body_mesh(document, thing_named(document, "solid:ball"));
  for (const PlacedPoint& p : points_in(value_of(document, fold), "/base_mm"))
    EXPECT_LT(nearest_foot(mesh, p.at).distance, 1e-3);
  const Built built = build(document);
  EXPECT_TRUE(built.good()) << core::to_string(built.faults.front());
}

TEST(Operations, WhatCannotBeDoneIsToldWithItsPlaceAndChangesNothing) {
  const Workplace place;
  Document document = with_ball(place);
  const std::uint64_t version = document.version();
  EXPECT_NE(fault_of(document, "move", R"({"of": ["bal"], "by_mm": [0, 0, 1]})").find("did you mean \"ball\"?"),
            std::string::npos);
  EXPECT_NE(fault_of(document, "scale", R"({"of": ["ball"], "by": -2})").find("step:1:"), std::string::npos);
  EXPECT_NE(fault_of(document, "rotate", R"({"of": ["ball"], "axis": [0, 0, 0], "by_deg": 3})").find("a direction"),
            std::string::npos);
  EXPECT_NE(fault_of(document, "ellipsoid",
                     R"({"name": "ball", "tissue": "uterus", "centre_mm": [0, 0, 0], "half_mm": [5, 5, 5]})")
                .find("a name that is free"),
            std::string::npos);
  EXPECT_NE(fault_of(document, "unset", R"({"of": "ball", "key": "nothing"})"), "");
  EXPECT_EQ(document.version(), version);
}

TEST(Build, WhatNothingHoldsIsShownAndNoted) {
  const Workplace place;
  Document document = begun(place / "scene.json", false, "mine");
  apply(document, "ellipsoid",
        R"({"name": "ball", "tissue": "uterus", "centre_mm": [0, -150, -110], "half_mm": [15, 20, 12]})");
  const Built built = build(document);
  EXPECT_TRUE(built.good());
  ASSERT_EQ(built.notes.size(), 1u);
  EXPECT_NE(built.notes[0].find("ball is not attached"), std::string::npos);
}

TEST(Build, FaultsOfAnEditHaveTheirPlaceInTheEditedText) {
  const Workplace place;
  Document document = with_ball(place);
  apply(document, "set", R"({"of": "ball", "key": "cell_mm", "value": -3})");
  const Built built = build(document);
  EXPECT_FALSE(built.good());
  ASSERT_FALSE(built.faults.empty());
  EXPECT_NE(core::to_string(built.faults[0]).find("cell_mm"), std::string::npos);
  EXPECT_TRUE(document.undo());
  EXPECT_TRUE(build(document).good());
}

TEST(Build, AnOrganAloneIsShownInTheModellingPlace) {
  const Document document = Document::open("scenes/organs/uterus.json");
  const Built built = build(document);
  ASSERT_TRUE(built.good()) << core::to_string(built.faults.front());
  EXPECT_EQ(read_outs(built, 0).size(), 1u);
}

TEST(Export, ASkinReadsBackWithTheBodysVolumeAndTheNetworkWithItsSprings) {
  const Workplace place;
  const Document document = with_ball(place);
  const Built built = build(document);
  ASSERT_TRUE(built.good());
  const ReadOut ball = read_outs(built, 0).front();
  for (const char* ending : {".obj", ".stl", ".ply", ".vtk"}) {
    const geometry::SurfaceFile file = geometry::read_surfaces(exported(*built.model, "ball", ending), ending);
    EXPECT_NEAR(geometry::volume(file.parts[0].mesh) * 1e-3 / ball.volume_mL, 1, 0.02) << ending;
  }
  const std::string network = exported(*built.model, "ball", ".msh");
  EXPECT_NE(network.find("$Nodes\n" + std::to_string(ball.nodes) + "\n"), std::string::npos);
  EXPECT_THROW(exported(*built.model, "ball", ".step"), core::BadInput);
  EXPECT_THROW(exported(*built.model, "nothing", ".obj"), core::BadInput);
}

/// The tutorials are tests: from nothing to an organ that a grasper pulls.
TEST(Script, AUterusComesFromNothingToPulledByAGrasperInFewerThan60Operations) {
  const Workplace place;
  const fs::path script = fs::absolute("docs/tutorials/uterus.json"), here = fs::current_path();
  Session session;
  fs::current_path(place / "");
  const ScriptResult done = run_script(script, session);
  fs::current_path(here);
  EXPECT_LE(done.operations, 60);
  const Json& pull = session.said().back();
  EXPECT_TRUE(pull["holds"].get<bool>());
  EXPECT_GT(pull["pull_N"].get<double>(), 0.5);
  EXPECT_TRUE(fs::exists(place / "my_uterus/scene.json"));
}

TEST(Script, EveryStepIsInTheManual) {
  const std::string page = read("docs/guides/modeller.md");
  ASSERT_FALSE(page.empty());
  for (const Operation& o : operations())
    EXPECT_NE(page.find("`" + o.parameters.name + "`"), page.npos) << o.parameters.name;
  for (const Command& c : commands())
    EXPECT_NE(page.find("`" + c.parameters.name + "`"), page.npos) << c.parameters.name;
}

TEST(Script, AStepThatIsNoneIsToldWithTheNearestOne) {
  Session session;
  try {
    run_step(json(R"({"do": "elipsoid"})"), "script", session);
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("did you mean \"ellipsoid\"?"), std::string::npos) << bad.what();
  }
}

}  // namespace
}  // namespace trocar::modeller
