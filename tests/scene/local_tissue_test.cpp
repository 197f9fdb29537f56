// Organs whose tissue differs from place to place: painted stiffness and fibres along strokes, from the file to the
// compiled springs.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/hash.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/fibres.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/tissue/elastostatic/drawn_springs.hpp>

#include "../sim/small_scene.hpp"
#include "files.hpp"

namespace trocar::scene {
namespace {

const StiffnessRegion kEverywhere{{0, 0, 0}, 0.5, 2, {}};

Description organ_alone() {
  Description d = small::description();
  d.strands.clear();
  d.membranes.clear();
  d.vessels.clear();
  d.fluids.reset();
  d.gravity = {0, 0, 0};
  d.solids = {small::organ()};
  return d;
}

std::vector<tissue::SpringDescription> springs_of(const Description& d) {
  const sim::Model m = compile(d);
  return m.solids.empty() ? tissue::drawn_springs(m.cuttables.at(0).body)
                          : tissue::drawn_springs(m.solids.at(0).network);
}

TEST(StiffnessRegions, AreWholeWithinHalfOfTheRadiusAndNothingBeyondIt) {
  const std::vector<StiffnessRegion> one{{{0, 0, 0}, 0.02, 4, {}}};
  EXPECT_NEAR(stiffness_at(one, {0, 0, 0}), 4, 1e-12);
  EXPECT_NEAR(stiffness_at(one, {0.0099, 0, 0}), 4, 1e-3);
  EXPECT_NEAR(stiffness_at(one, {0.015, 0, 0}), 2, 1e-9) << "half of the way, half of the logarithm";
  EXPECT_EQ(stiffness_at(one, {0.02, 0, 0}), 1);
  EXPECT_EQ(stiffness_at({}, {0, 0, 0}), 1);
}

TEST(StiffnessRegions, PaintOverOneAnotherInTheirOrder) {
  const StiffnessRegion hard{{0, 0, 0}, 0.02, 8, {}}, soft{{0.005, 0, 0}, 0.02, 0.5, {}}, wipe{{0, 0, 0}, 0.05, 1, {}};
  EXPECT_NEAR(stiffness_at(std::vector{hard, soft}, {0, 0, 0}), 0.5, 1e-12);
  EXPECT_NEAR(stiffness_at(std::vector{soft, hard}, {0, 0, 0}), 8, 1e-12);
  EXPECT_EQ(stiffness_at(std::vector{hard, soft, wipe}, {0.002, 0, 0}), 1) << "a dab of 1 takes all away";
}

TEST(StiffnessRegions, OfTwoMakeEverySpringOfEveryKindOfBodyTwiceAsStiff) {
  for (const bool cuttable : {false, true}) {
    Description d = organ_alone();
    d.solids[0].cuttable = cuttable;
    const auto plain = springs_of(d);
    d.solids[0].regions = {kEverywhere};
    const auto stiff = springs_of(d);
    ASSERT_EQ(stiff.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) EXPECT_NEAR(stiff[i].k, 2 * plain[i].k, 1e-5 * plain[i].k);
  }
}

TEST(StiffnessRegions, AskForTheSubStepsOfTheStiffestPlace) {
  Description d = organ_alone();
  CompileReport plain, stiff;
  compile(d, &plain);
  d.solids[0].regions = {{{-0.02, 0, 0}, 0.01, 10, {}}};
  compile(d, &stiff);
  EXPECT_LT(stiff.bodies.at(0).dt_limit, 0.6 * plain.bodies.at(0).dt_limit);
}

TEST(StiffnessRegions, SoftenWhatAnswersAtOnceWithBothElasticities) {
  for (const Elasticity elasticity : {Elasticity::springs, Elasticity::tetrahedra}) {
    Description d = organ_alone();
    d.solids[0].solver = Solver::elastostatic;
    d.solids[0].elasticity = elasticity;
    const auto give = [&] {
      const sim::Model m = compile(d);
      const auto& c = m.statics.at(0).solver.compliance;
      double sum = 0;
      for (const auto& value : c) sum += std::fabs(double(value));
      return sum;
    };
    const double plain = give();
    d.solids[0].regions = {{{0, 0, 0}, 0.5, 0.5, {}}};
    EXPECT_NEAR(give() / plain, 2, 0.01);
  }
}

TEST(StiffnessRegions, StiffenAPouchesWallAndItsBending) {
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gallbladder/scene.json");
  const sim::Model plain = compile(d);
  Pouch& pouch = d.pouches.at(0);
  pouch.regions = {{pouch.held.at(0).centre, 0.5, 2, {}}};
  const sim::Model stiff = compile(d);
  const auto &a = plain.membranes.back().sheet, &b = stiff.membranes.back().sheet;
  const auto before = tissue::drawn_springs(a.network), after = tissue::drawn_springs(b.network);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i].k, 2 * before[i].k, 1e-5 * before[i].k);
  for (std::size_t i = 0; i < a.bends.size(); ++i) EXPECT_FLOAT_EQ(b.bends[i].k, 2 * a.bends[i].k);
  pouch.regions = {{{3, 0, 0}, 0.01, 2, {}}};
  EXPECT_THROW(compile(d), core::BadInput);
}

TEST(StiffnessRegions, AndStrokesGoAlongWhereTheSceneIsVaried) {
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  Solid& body = d.solids.at(0);
  const Vec3d place = body.sections.at(1).centre;
  d.variation.emplace();
  d.variation->regions.emplace_back();
  d.variation->regions[0].around = body.name;
  d.variation->regions[0].shift = 0.01;
  body.regions = {{place, 0.01, 2, {}}};
  body.fibre_strokes = {{place, place + Vec3d{0.01, 0, 0}}};
  vary(d, 7);
  EXPECT_NE(body.sections[1].centre, place);
  EXPECT_EQ(body.regions[0].centre, body.sections[1].centre);
  EXPECT_EQ(body.fibre_strokes[0][0], body.sections[1].centre);
}

TEST(StiffnessRegions, ThatReachNothingAreTold) {
  Description d = organ_alone();
  d.solids[0].regions = {{{1, 0, 0}, 0.01, 2, {"organ.json", 9, 5}}};
  try {
    compile(d);
    FAIL() << "it was compiled";
  } catch (const core::BadInput& e) {
    ASSERT_EQ(e.faults().size(), 1u);
    EXPECT_EQ(e.faults()[0].at.line, 9);
    EXPECT_NE(e.faults()[0].message.find("a region that reaches 'organ'"), std::string::npos) << e.what();
  }
}

TEST(StiffnessRegions, OfOneAreTheSameBitsAsNone) {
  Description d = small::description();
  const std::uint64_t plain = compile(d).hash;
  for (Solid& s : d.solids) s.regions = {{{0, 0, 0}, 0.5, 1, {}}};
  EXPECT_EQ(compile(d).hash, plain);
}

Stroke quarter_circle(double radius) {
  Stroke stroke;
  for (int i = 0; i <= 12; ++i) {
    const double angle = portable::pi / 2 * i / 12;
    stroke.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  return stroke;
}

TEST(FibreStrokes, RunAlongACurvedStrokeWhicheverWayItWasDrawn) {
  Stroke there = quarter_circle(0.05), back = quarter_circle(0.07);
  std::reverse(back.begin(), back.end());
  const std::vector<Stroke> both{there, back};
  for (const double angle : {0.1, 0.5, 0.8, 1.4}) {
    const Vec3d place{0.058 * std::cos(angle), 0.058 * std::sin(angle), 0.004};
    const Vec3d tangent{-std::sin(angle), std::cos(angle), 0};
    EXPECT_GT(std::fabs(dot(fibre_at(both, place), tangent)), std::cos(0.03)) << angle;
  }
}

TEST(FibreStrokes, CountByTheSquareOfTheirDistance) {
  const std::vector<Stroke> crossed{{{-1, 0, 0.01}, {1, 0, 0.01}}, {{0, -1, 0}, {0, 1, 0}}};
  EXPECT_GT(std::fabs(fibre_at(crossed, {0, 0, 0.006}).x), 0.999);
  EXPECT_GT(std::fabs(fibre_at(crossed, {0, 0, 0.004}).y), 0.999);
}

TEST(FibreStrokes, AlongTheBodyRunTheCentresOfItsSectionsOrTheLineOfItsTube) {
  Solid loft = small::organ();
  loft.fibres_along = true;
  const std::vector<Vec3d> place{{-0.02, 0.01, 0.003}};
  EXPECT_GT(std::fabs(fibres_in(loft, place).at(0).x), 1 - 1e-9);
  Solid tube;
  tube.fibres_along = true;
  tube.shape.tube = TubeShape{quarter_circle(0.05), {{0, 0.008, 0}}};
  const std::vector<Vec3d> diagonal{{0.04, 0.04, 0}};
  EXPECT_GT(std::fabs(dot(fibres_in(tube, diagonal).at(0), normalised(Vec3d{1, -1, 0}))), std::cos(0.02));
  EXPECT_THROW(middle_line(Solid{}), std::invalid_argument);
}

TEST(FibreStrokes, StiffenLatticesAndTetrahedraAlongThem) {
  for (const bool cuttable : {false, true}) {
    Description d = organ_alone();
    d.solids[0].cuttable = cuttable;
    const auto plain = springs_of(d);
    d.solids[0].fibre_ratio = 2;
    d.solids[0].fibre = {1, 0, 0};
    const auto one = springs_of(d);
    d.solids[0].fibre = {};
    d.solids[0].fibre_strokes = {{{-0.05, 0, 0}, {-0.03, 0, 0}, {0.01, 0, 0}}};
    const auto stroke = springs_of(d);
    double stiffer = 0;
    for (std::size_t i = 0; i < plain.size(); ++i) {
      EXPECT_NEAR(stroke[i].k, one[i].k, 1e-5 * one[i].k);
      stiffer = std::max(stiffer, one[i].k / plain[i].k);
    }
    EXPECT_GT(stiffer, 1.4);
  }
}

TEST(FibreStrokes, OfTetrahedraThatAnswerAtOnceAreThoseOfOneDirection) {
  Description d = organ_alone();
  Solid& s = d.solids[0];
  s.solver = Solver::elastostatic;
  s.elasticity = Elasticity::tetrahedra;
  s.fibre_ratio = 2;
  s.fibre = {3, 0, 0};
  const sim::Model one = compile(d);
  s.fibre = {};
  s.fibres_along = true;
  const sim::Model along = compile(d);
  const auto &a = one.statics.at(0).solver.compliance, &b = along.statics.at(0).solver.compliance;
  ASSERT_EQ(a.size(), b.size());
  double most = 0, apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::fabs(double(a[i])));
    apart = std::max(apart, std::fabs(double(a[i]) - double(b[i])));
  }
  EXPECT_LT(apart, 1e-5 * most);
}

std::vector<std::string> faults_of(const std::string& keys) {
  const Folder folder;
  std::vector<std::string> told;
  const auto file = folder.write(
      "organ.json", R"({"format": 1, "solids": [{"name": "body", "tissue": "liver", "cell_mm": 4, )" + keys + "}]}");
  for (const core::Fault& f : check_file(file)) told.push_back(f.message);
  return told;
}
const std::string kLoft =
    R"("sections": [{"centre_mm": [0,0,0], "across_mm": [9,0,0], "deep_mm": [0,9,0]},
                    {"centre_mm": [0,0,9], "across_mm": [9,0,0], "deep_mm": [0,9,0]}], )";
const std::string kBall = R"("revolved": {"profile_mm": [[0, -9], [9, 0], [0, 9]]}, )";

void expect_fault(const std::string& keys, const std::string& part) {
  const auto faults = faults_of(keys);
  ASSERT_EQ(faults.size(), 1u) << keys;
  EXPECT_NE(faults[0].find(part), std::string::npos) << faults[0];
}

TEST(LocalTissueFile, SaysWhatIsWrong) {
  EXPECT_TRUE(
      faults_of(kLoft + R"("fibres_mm": [[[0,0,0],[0,0,9]],[[1,0,0],[1,0,4],[1,1,9]]], "fibre_ratio": 2)").empty());
  EXPECT_TRUE(faults_of(kLoft + R"("fibres_along": true, "fibre_ratio": 1.5)").empty());
  expect_fault(kLoft + R"("fibre": [1,0,0], "fibres_along": true)",
               "expected one of fibre, fibres_mm and fibres_along");
  expect_fault(kLoft + R"("fibres_mm": [[[0,0,0]]])", "expected at least 2 items");
  expect_fault(kLoft + R"("fibres_mm": [])", "expected at least 1 items");
  expect_fault(kLoft + R"("fibres_mm": [[[0,0,0],[0,0,0]]])", "same place twice");
  EXPECT_FALSE(faults_of(kLoft + R"("fibres_mm": [[0,0,0],[0,0,9]])").empty()) << "one line is no list of lines";
  expect_fault(kBall + R"("fibres_along": true)", "expected a body with a middle line");
  expect_fault(kLoft + R"("regions": [{"centre_mm": [0,0,0], "radius_mm": 5, "stiffness": 20}])", "in [0.1, 10]");
  expect_fault(kLoft + R"("regions": [{"centre_mm": [0,0,0], "stiffness": 2}])", "radius_mm");
}

}  // namespace
}  // namespace trocar::scene
