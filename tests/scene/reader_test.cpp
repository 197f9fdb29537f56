#include <cstdlib>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

using Faults = std::vector<std::string>;

// A small scene, one thing a line, so that a test can replace a line and name the place of the fault.
const std::vector<std::string> kScene = {
    "{",                                                                                           // 1
    "\"format\": 1,",                                                                              // 2
    "\"name\": \"small\",",                                                                        // 3
    "\"tissues\": [",                                                                              // 4
    "{\"name\": \"soft\", \"density_kg_m3\": 1050, \"young_Pa\": 8000, \"source\": \"ours\"}],",   // 5
    "\"organs\": [{",                                                                              // 6
    "\"solids\": [{\"name\": \"ball\", \"tissue\": \"soft\", \"cell_mm\": 3, \"sections\": [",     // 7
    "{\"centre_mm\": [0, 0, -100], \"across_mm\": [10, 0, 0], \"deep_mm\": [0, 8, 0]},",           // 8
    "{\"centre_mm\": [0, 0, -120], \"across_mm\": [10, 0, 0], \"deep_mm\": [0, 8, 0]}]}],",        // 9
    "\"strands\": [{\"name\": \"cord\", \"tissue\": \"soft\", \"start\": {\"solid\": \"ball\"},",  // 10
    "\"centreline_mm\": [[10, 0, -110], [40, 0, -110]],",                                          // 11
    "\"landmarks\": [{\"name\": \"middle\", \"from_mm\": 10, \"to_mm\": 20}],",                    // 12
    "\"stations\": [{\"s_mm\": 0, \"radius_mm\": 2, \"lumen_mm\": 1}]}],",                         // 13
    "\"walls\": [{\"name\": \"floor\", \"net_mm\": [[[0,0,0],[9,0,0]],[[0,9,0],[9,9,0]]]}],",      // 14
    "\"sheets\": [{\"name\": \"fold\", \"strand\": \"cord\", \"from_mm\": 1, \"to_mm\": 9,",       // 15
    "\"base_mm\": [[10, 9, -110], [20, 9, -110]], \"base_organ\": \"ball\"}]",                     // 16
    "}],",                                                                                         // 17
    "\"instruments\": [{\"name\": \"stick\", \"kind\": \"probe\"}],",                              // 18
    "\"ports\": [{\"name\": \"navel\", \"position_mm\": [0, 0, 0], \"diameter_mm\": 10}],",        // 19
    "\"tools\": [{\"instrument\": \"stick\", \"port\": \"navel\", \"tip_mm\": [0, 0, -60]}],",     // 20
    "\"scope\": {\"port\": \"navel\", \"tip_mm\": [0, 0, -40]}",                                   // 21
    "}"};                                                                                          // 22

/// The scene with some lines (1-based) replaced.
std::string scene_with(const std::vector<std::pair<int, std::string>>& changes) {
  std::vector<std::string> lines = kScene;
  for (const auto& [line, text] : changes) lines[std::size_t(line - 1)] = text;
  std::string whole;
  for (const std::string& line : lines) whole += line + '\n';
  return whole;
}

std::vector<core::Fault> faults_of_file(const std::filesystem::path& path) {
  try {
    read_scene(path);
  } catch (const core::BadInput& bad) {
    return bad.faults();
  }
  return {};
}

/// Tells the faults of the scene with some lines replaced. An '@' in a new line marks where a fault is expected: the
/// place is left out of what is returned, and "away from @" put in where there is no mark.
Faults faults_of(const std::vector<std::pair<int, std::string>>& changes) {
  const Folder folder;
  std::vector<std::pair<int, std::string>> lines = changes;
  std::vector<std::pair<int, int>> places;
  for (auto& [line, text] : lines)
    for (std::size_t at; (at = text.find('@')) != text.npos; text.erase(at, 1)) places.emplace_back(line, int(at) + 1);
  Faults messages;
  std::size_t n = 0;
  for (const core::Fault& f : faults_of_file(folder.write("scene.json", scene_with(lines)))) {
    const bool marked = n < places.size() && places[n] == std::pair{f.at.line, f.at.column};
    messages.push_back(marked ? f.message
                              : fmt::format("away from @, at {}:{}: {}", f.at.line, f.at.column, f.message));
    ++n;
  }
  return messages;
}
Faults one(const std::string& fault) { return {fault}; }

TEST(Reader, AGoodSceneReadsInMetresAndRadians) {
  const Folder folder;
  const Description d = read_scene(folder.write("scene.json", scene_with({})));
  EXPECT_EQ(d.name, "small");
  ASSERT_EQ(d.solids.size(), 1u);
  EXPECT_EQ(d.solids[0].sections[1].centre, (Vec3d{0, 0, -0.12}));
  EXPECT_EQ(d.solids[0].cell, 0.003);
  EXPECT_EQ(d.solids[0].skin_edge, 0.003);
  EXPECT_EQ(d.solids[0].fine_edge, 0.0015);
  EXPECT_EQ(d.solids[0].look, "ball");
  EXPECT_EQ(d.solids[0].cell_at.line, 7);
  ASSERT_EQ(d.strands.size(), 1u);
  EXPECT_EQ(d.strands[0].start.organ, "ball");
  EXPECT_FALSE(d.strands[0].end.fixed);
  EXPECT_EQ(d.strands[0].stations[0].lumen, 0.001);
  EXPECT_EQ(d.strands[0].landmarks[0].to, 0.02);
  EXPECT_EQ(d.walls[0].rows, 2);
  EXPECT_EQ(d.walls[0].net[3], (Vec3d{0.009, 0.009, 0}));
  EXPECT_EQ(d.sheets[0].base_organ, "ball");
  EXPECT_EQ(d.instruments[0].kind, interactions::ToolKind::probe);
  EXPECT_EQ(d.placements[0].instrument, "stick");
  EXPECT_EQ(d.scope_placement.port, "navel");
  EXPECT_NEAR(d.scope.field_of_view, 1.2217, 1e-4);
}

/// Line 16 of the scene with a membrane after the sheets.
std::string with_membrane(const std::string& keys) {
  return "\"base_mm\": [[10, 9, -110], [20, 9, -110]], \"base_organ\": \"ball\"}], \"membranes\": [{" + keys + "}]";
}

TEST(Reader, AMembraneIsReadWithItsDefaults) {
  const Folder folder;
  const std::string text =
      scene_with({{16, with_membrane(R"("name": "web", "tissue": "soft", "strand": "cord", "from_mm": 1, "to_mm": 9,)"
                                     R"( "base_mm": [[10, 9, -110], [20, 9, -110]], "base_on": ["ball", "cord"],)"
                                     R"( "thickness_mm": 0.5)")}});
  const Description d = read_scene(folder.write("scene.json", text));
  ASSERT_EQ(d.membranes.size(), 1u);
  EXPECT_EQ(d.membranes[0].name, "web");
  EXPECT_EQ(d.membranes[0].look, "web");
  EXPECT_EQ(d.membranes[0].tissue, "soft");
  EXPECT_EQ(d.membranes[0].to, 0.009);
  EXPECT_EQ(d.membranes[0].base[1], (Vec3d{0.02, 0.009, -0.11}));
  EXPECT_EQ(d.membranes[0].base_on, (std::vector<std::string>{"ball", "cord"}));
  EXPECT_EQ(d.membranes[0].base_reach, 0.004);
  EXPECT_EQ(d.membranes[0].thickness, 0.0005);
  EXPECT_EQ(d.membranes[0].spacing, 0.0025);
  EXPECT_TRUE(d.membranes[0].cuttable);
}

TEST(Reader, FaultsOfMembranes) {
  const auto fault = [](const std::string& keys) { return faults_of({{16, with_membrane(keys)}}); };
  EXPECT_EQ(fault(R"("name": "web", "tissue": @"sift", "strand": @"ball", "from_mm": 1, "to_mm": 9,)"
                  R"( "base_mm": [[10, 9, -110], [20, 9, -110]], "base_on": ["ball", @"bull"], "thickness_mm": 1)"),
            (Faults{"expected a known tissue, got \"sift\" (did you mean \"soft\"?); known: soft",
                    "expected a known strand, got \"ball\"; known: cord",
                    "expected a known solid or strand, got \"bull\" (did you mean \"ball\"?); known: ball, cord"}));
  EXPECT_EQ(fault(R"("name": "web", "tissue": "soft", "strand": "cord", "from_mm": 9, "to_mm": @9,)"
                  R"( "base_mm": [[10, 9, -110], @[10, 9, -110]], "thickness_mm": 1)"),
            (Faults{"expected more than from_mm = 9, got 9",
                    "expected a point at least 0.01 mm from the one before, got the same place"}));
  EXPECT_EQ(fault(R"("name": "web", "tissue": "soft", "strand": "cord", "from_mm": 1, "to_mm": @60,)"
                  R"( "base_mm": [[10, 9, -110], [20, 9, -110]], "thickness_mm": 1)"),
            one("expected an arc length on \"cord\" (at most 30.0 mm), got 60"));
  EXPECT_EQ(fault(R"("name": @"fold", "tissue": "soft", "strand": "cord", "from_mm": 1, "to_mm": 9,)"
                  R"( "base_mm": [[10, 9, -110], [20, 9, -110]], "thickness_mm": 1)")
                .size(),
            1u);
}

TEST(Reader, FaultsReadPathLineColumnMessage) {
  const Folder folder;
  const auto path = folder.write("scene.json", scene_with({{2, "\"format\": 2,"}}));
  try {
    read_scene(path);
    FAIL();
  } catch (const core::BadInput& bad) {
    EXPECT_EQ(std::string(bad.what()), path.generic_string() + ":2:11: expected 1 for \"format\", got 2");
  }
}

TEST(Reader, AMissingFormatOrKeyIsAFaultAtItsObject) {
  EXPECT_EQ(faults_of({{1, "@{"}, {2, ""}}),
            one("expected the key \"format\" (version of this kind of file) in this scene, got none"));
  EXPECT_EQ(faults_of({{21, R"("scope": @{"port": "navel"})"}}),
            one("expected the key \"tip_mm\" (position of its tip at the start) in this scope, got none"));
}

TEST(Reader, WrongTypesAreLocated) {
  EXPECT_EQ(faults_of({{3, R"("name": @3,)"}}),
            one("expected a name (1 to 64 letters, digits, _ or -) for \"name\", got 3"));
  EXPECT_EQ(faults_of({{8, R"({"centre_mm": @[0, 0], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]},)"}}),
            one("expected an array of three numbers for \"centre_mm\", got 2 items"));
  EXPECT_EQ(faults_of({{8, R"({"centre_mm": [0, @"x", 0], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]},)"}}),
            one("expected a number in [-2000, 2000] for \"centre_mm\", got \"x\""));
  EXPECT_EQ(faults_of({{20, R"("tools": [],)"}, {21, R"("scope": @[1])"}}),
            one("expected a scope in {} for \"scope\", got an array"));
  EXPECT_EQ(faults_of({{19, R"("ports": [@5, {"name": "navel", "position_mm": [0, 0, 0], "diameter_mm": 10}],)"}}),
            one("expected a port in {} for \"ports\", got 5"));
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "clip_applier", "clips": @1.5}],)"}}),
            one("expected a whole number in [0, 1000] for \"clips\", got 1.5"));
  EXPECT_EQ(faults_of({{12, R"("cuttable": @1,)"}}), one("expected true or false for \"cuttable\", got 1"));
  std::string kinds;
  for (const interactions::KindOfTool& k : interactions::kToolKinds)
    kinds += (kinds.empty() ? "" : ", ") + std::string(k.name);
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": @"grapser"}],)"}}),
            one("expected one of " + kinds + " for \"kind\", got \"grapser\" (did you mean \"grasper\"?)"));
}

TEST(Reader, ASceneThatIsNoObjectIsAFault) {
  const Folder folder;
  EXPECT_EQ(told(faults_of_file(folder.write("scene.json", "[1]"))), one("1:1 expected a scene in {}, got an array"));
}

TEST(Reader, NanAndNegativeMassAreFaultsWhereTheyStand) {
  EXPECT_EQ(faults_of({{5, R"({"name": "soft", "density_kg_m3": @NaN, "young_Pa": 8000, "source": "ours"}],)"}}),
            one("expected a finite number, got NaN"));
  EXPECT_EQ(faults_of({{5, R"({"name": "soft", "density_kg_m3": @-3, "young_Pa": 8000, "source": "ours"}],)"}}),
            one("expected a number in [1, 25000] for \"density_kg_m3\", got -3"));
}

TEST(Reader, UnknownKeysAreFaultsWithAGuess) {
  EXPECT_EQ(faults_of({{19, R"("ports": [{"name": "navel", @"positoin_mm": [0, 0, 0], "position_mm": [0, 0, 0], )"
                            R"("diameter_mm": 10}],)"}}),
            one("expected a known key of a port, got \"positoin_mm\" (did you mean \"position_mm\"?); known: name, "
                "position_mm, diameter_mm, seal_friction_N, stiffness_N_mm, drift_mm"));
  EXPECT_EQ(faults_of({{19, R"("ports": [{"name": "navel", "position_mm": [0, 0, 0], "diameter_mm": 10, @"q": 0}],)"}}),
            one("expected a known key of a port, got \"q\"; known: name, position_mm, diameter_mm, seal_friction_N, "
                "stiffness_N_mm, drift_mm"));
}

TEST(Reader, DanglingNamesAreFaultsWithTheKnownOnes) {
  EXPECT_EQ(faults_of({{7, R"("solids": [{"name": "ball", "tissue": @"sotf", "cell_mm": 3, "sections": [)"}}),
            one("expected a known tissue, got \"sotf\" (did you mean \"soft\"?); known: soft"));
  EXPECT_EQ(faults_of({{10, R"("strands": [{"name": "cord", "tissue": "soft", "start": {"solid": @"liver"},)"}}),
            one("expected a known solid, got \"liver\"; known: ball"));
  EXPECT_EQ(faults_of({{15, R"("sheets": [{"name": "fold", "strand": @"ball", "from_mm": 1, "to_mm": 9,)"}}),
            one("expected a known strand, got \"ball\"; known: cord"));
  EXPECT_EQ(faults_of({{16, R"("base_mm": [[10, 9, -110], [20, 9, -110]], "base_organ": @"x"}])"}}),
            one("expected a known solid or strand, got \"x\"; known: ball, cord"));
  EXPECT_EQ(faults_of({{20, R"("tools": [{"instrument": @"sick", "port": @"nave", "tip_mm": [0, 0, -60]}],)"}}),
            (Faults{"expected a known instrument, got \"sick\" (did you mean \"stick\"?); known: stick",
                    "expected a known port, got \"nave\" (did you mean \"navel\"?); known: navel"}));
}

TEST(Reader, WhatIsUnsoundInAPouchIsTold) {
  const auto with = [](const std::string& more) {
    return faults_of({{17, R"(, "pouches": [{"name": "bag", "tissue": "soft", "thickness_mm": 1, "sections": [)"
                           R"({"centre_mm": [90, 0, -100], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]}, )"
                           R"({"centre_mm": [90, 0, -120], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]}], )" +
                               more + "}]}],"}});
  };
  EXPECT_EQ(with(R"("contents": {"kind": "liquid", "pressure_Pa": 900, "bulk_kPa": 100})"), Faults{});
  EXPECT_EQ(with(R"("held_on": [@"liver"])"),
            one("expected a known solid or strand, got \"liver\"; known: ball, cord"));
  EXPECT_EQ(with(R"("contents": {"kind": "gas", "pressure_Pa": 900, "bulk_kPa": @100})"),
            one("expected a bulk modulus of a liquid only, got one of \"gas\""));
  EXPECT_EQ(with(R"("contents": {"kind": "gas", "pressure_Pa": @-2e5})").size(), 1u);
  EXPECT_EQ(with(R"("spacing_mm": @0.3)").size(), 1u) << "too many nodes";
}

TEST(Reader, EqualNamesAreAFaultAtTheSecond) {
  const Faults told =
      faults_of({{14, R"("walls": [@{"name": "cord", "net_mm": [[[0,0,0],[9,0,0]],[[0,9,0],[9,9,0]]]}],)"}});
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].rfind("expected every organ name once, got \"cord\" again (first in ", 0), 0u) << told[0];
}

TEST(Reader, TheLawMustBeMonotone) {
  const auto law = [](const char* p1, const char* p2) {
    return std::string(R"({"name": "soft", "density_kg_m3": 1050, "young_Pa": 8000, "source": "ours", "p1": )") + p1 +
           R"(, "p2": )" + p2 + "}],";
  };
  EXPECT_EQ(faults_of({{5, law("@5", "8")}}),
            one("expected p1^2 < 3 p2 so that stress always rises with strain, got p1^2 = 25 and 3 p2 = 24"));
  EXPECT_EQ(faults_of({{5, law("@-3", "3")}}),
            one("expected p1^2 < 3 p2 so that stress always rises with strain, got p1^2 = 9 and 3 p2 = 9"));
  EXPECT_EQ(faults_of({{5, law("5", "9")}}), Faults{});
  EXPECT_EQ(faults_of({{5, law("0", "0")}}), Faults{});
}

TEST(Reader, ABodyOfABillionNodesIsRefusedBeforeItIsBuilt) {
  EXPECT_EQ(faults_of({{7, R"("solids": [{"name": "ball", "tissue": "soft", "cell_mm": @0.1, "sections": [)"},
                       {8, R"({"centre_mm": [0, 0, -100], "across_mm": [100, 0, 0], "deep_mm": [0, 80, 0]},)"},
                       {9, R"({"centre_mm": [0, 0, -130], "across_mm": [100, 0, 0], "deep_mm": [0, 80, 0]}]}],)"}}),
            one("expected a cell that fills the body with at most 60000 nodes, got about 9.8e+08"));
}

TEST(Reader, TooFineSkinsAndStrandsAreRefused) {
  EXPECT_EQ(faults_of({{7, R"("solids": [{"name": "ball", "tissue": "soft", "cell_mm": 3, "fine_edge_mm": @0.1,)"},
                       {8, R"("sections": [{"centre_mm": [0, 0, 0], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]},)"},
                       {9, R"({"centre_mm": [0, 0, -100], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]}]}],)"}}),
            one("expected an edge that gives at most 500000 triangles, got about 1.24e+06"));
  EXPECT_EQ(faults_of({{11, R"("spacing_mm": @0.2, "centreline_mm": [[10, 0, -110], [1610, 0, -110]],)"}}),
            one("expected a spacing that gives at most 5000 nodes, got about 8e+03"));
  EXPECT_EQ(faults_of({{14, R"("walls": [{"name": "floor", "edge_mm": @0.5, "net_mm": )"
                            R"([[[0,0,0],[999,0,0]],[[0,999,0],[999,999,0]]]}],)"}}),
            one("expected an edge that gives at most 500000 triangles, got about 9.18e+06"));
}

TEST(Reader, ShapesMustMakeSense) {
  EXPECT_EQ(faults_of({{7, R"("solids": [{"name": "ball", "tissue": "soft", "cell_mm": 3, "sections": @[)"},
                       {8, R"({"centre_mm": [0, 0, 0], "across_mm": [1, 0, 0], "deep_mm": [0, 8, 0]})"},
                       {9, "]}],"}}),
            one("expected at least 2 items for \"sections\", got 1"));
  EXPECT_EQ(faults_of({{8, R"({"centre_mm": [0, 0, -100], "across_mm": @[0, 0, 0], "deep_mm": [0, 8, 0]},)"}}),
            one("expected a half axis of at least 0.01 mm, got none"));
  EXPECT_EQ(faults_of({{8, R"({"centre_mm": [0, 0, -100], "across_mm": [0, 9, 1], "deep_mm": @[0, 8, 0]},)"}}),
            one("expected half axes at least 30 degrees apart, got nearly parallel ones"));
  EXPECT_EQ(faults_of({{9, R"({"centre_mm": @[0, 0, -100], "across_mm": [10, 0, 0], "deep_mm": [0, 8, 0]}]}],)"}}),
            one("expected a centre at least 0.01 mm from the section before, got the same place"));
  EXPECT_EQ(faults_of({{11, R"("centreline_mm": [[10, 0, -110], [40, 0, -110], @[40, 0, -110]],)"}}),
            one("expected a point at least 0.01 mm from the one before, got the same place"));
  EXPECT_EQ(
      faults_of({{14, R"("walls": [{"name": "floor", "net_mm": [[[0,0,0],[9,0,0]],@[[0,9,0],[9,9,0],[9,9,9]]]}],)"}}),
      one("expected rows of 2 points for \"net_mm\", got a row of 3"));
}

TEST(Reader, StationsAndLandmarksMustFitTheStrand) {
  EXPECT_EQ(
      faults_of({{13, R"("stations": [{"s_mm": 5, "radius_mm": 2, "lumen_mm": @2}, {"s_mm": @5, "radius_mm": 2}, )"
                      R"({"s_mm": @50, "radius_mm": 2}]}],)"}}),
      (Faults{"expected less than the outer radius of 2 mm, got 2",
              "expected more than 5 mm (stations go by rising s_mm), got 5",
              "expected an arc length on the strand (at most 30.0 mm), got 50"}));
  EXPECT_EQ(faults_of({{12, R"("landmarks": [{"name": "middle", "from_mm": 10, "to_mm": @10}, )"
                            R"({"name": @"middle", "from_mm": 10, "to_mm": @90}],)"}}),
            (Faults{"expected more than from_mm = 10, got 10",
                    "expected every landmark of a strand once, got \"middle\" again",
                    "expected an arc length on the strand (at most 30.0 mm), got 90"}));
  EXPECT_EQ(faults_of({{15, R"("sheets": [{"name": "fold", "strand": "cord", "from_mm": 1, "to_mm": @60,)"}}),
            one("expected an arc length on \"cord\" (at most 30.0 mm), got 60"));
  EXPECT_EQ(
      faults_of(
          {{10, R"("strands": [{"name": "cord", "tissue": "soft", "start": {"solid": "ball", "fixed": @true},)"}}),
      one("expected either a solid or \"fixed\": true, got both"));
}

TEST(Reader, ToolsMustReachAndFit) {
  EXPECT_EQ(faults_of({{20, R"("tools": [{"instrument": "stick", "port": "navel", "tip_mm": @[0, 0, -900]}],)"}}),
            one("expected a tip 5 to 330 mm from the port \"navel\", got 900.0 mm"));
  EXPECT_EQ(faults_of({{19, R"("ports": [{"name": "navel", "position_mm": [0, 0, 0], "diameter_mm": 6}],)"},
                       {21, R"("scope": {"port": "navel", "tip_mm": @[0, 0, -40]})"}}),
            one("expected a port of at least 10 mm for this shaft, got \"navel\" of 6 mm"));
}

TEST(Reader, RejectsConflictingInstrumentKeys) {
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "probe", "clips": @2}],)"}}),
            one("expected clips only in a clip_applier, got 2 in a probe"));
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "clip_applier", "parallel_gap_mm": 6, )"
                            R"("opening_deg": @30}],)"}}),
            one("expected 0 or nothing beside parallel_gap_mm (jaws turn or stay parallel), got an angle"));
}

TEST(Reader, FeetBelongToHooks) {
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "bipolar", "foot_mm": @2.6}],)"}}),
            one("expected a foot only in a hook, got one in a bipolar"));
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "hook", "jaw_thickness_mm": 1.2, )"
                            R"("foot_mm": @0.6}],)"}}),
            one("expected 0 or more than half of jaw_thickness_mm (the wire's radius), got no more than that"));
}

TEST(Reader, ElectrodesBelongToHooksAndForceps) {
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "probe", "electrode": @{}}],)"}}),
            one("expected an electrode only in a hook or bipolar, got one in a probe"));
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "hook", "electrode": {"radius_mm": @9}}],)"}}),
            one("expected a number in [0.5, 1.5] for \"radius_mm\", got 9"));
  EXPECT_EQ(faults_of({{18, R"("instruments": [{"name": "stick", "kind": "hook", "electrode": {"seals_mm": 1}}],)"}}),
            Faults{});
}

TEST(Reader, APanelRemembersAtLeastWhatIsWarm) {
  EXPECT_EQ(faults_of({{3, R"("name": "small", "energy": {"bricks": 64, "awake": @65},)"}}),
            one("expected no more than the 64 bricks that are remembered, got 65"));
  EXPECT_EQ(faults_of({{3, R"("name": "small", "energy": {"yellow": @"coag"},)"}}),
            one("expected one of cut, blend for \"yellow\", got \"coag\""));
}

TEST(Reader, AllFaultsComeInOnePassInTheOrderOfTheFile) {
  EXPECT_EQ(
      faults_of({{3, R"("name": "small", @"titel": "x",)"},
                 {5, R"({"name": "soft", "density_kg_m3": @-1, "young_Pa": @1e999, "source": "ours"}],)"},
                 {7, R"("solids": [{"name": "ball", "tissue": @"hard", "cell_mm": @0, "sections": [)"},
                 {20, R"("tools": [{"instrument": "stick", "port": @"none", "tip_mm": @[0, 0]}],)"}}),
      (Faults{"expected a known key of a scene, got \"titel\" (did you mean \"title\"?); known: $schema, format, name, "
              "like, title, gravity_m_s2, tissues, organs, vessels, fluids, bleeder, energy and 15 more",
              "expected a number in [1, 25000] for \"density_kg_m3\", got -1", "expected a finite number, got 1e999",
              "expected a known tissue, got \"hard\"; known: soft",
              "expected a number in [0.1, 100] for \"cell_mm\", got 0",
              "expected a known port, got \"none\"; known: navel",
              "expected an array of three numbers for \"tip_mm\", got 2 items"}));
}

// ---- several files --------------------------------------------------------------------------------------------------

const char* kOrgan =
    "{\"format\": 1, \"solids\": [{\"name\": \"far\", \"tissue\": \"soft\", \"cell_mm\": 3, \"sections\": [\n"
    "{\"centre_mm\": [0, 0, -100], \"across_mm\": [10, 0, 0], \"deep_mm\": [0, 8, 0]},\n"
    "{\"centre_mm\": [0, 0, -120], \"across_mm\": [10, 0, 0], \"deep_mm\": [0, 8, 0]}]}]}\n";

TEST(Reader, OrgansComeFromFilesNamedRelativeToTheirOwn) {
  const Folder folder;
  folder.write("scenes/organs/a.json", "{\"format\": 1, \"organs\": [\"deeper/b.json\"]}");
  folder.write("scenes/organs/deeper/b.json", kOrgan);
  const auto path = folder.write("scenes/small/scene.json", scene_with({{6, "\"organs\": [\"../organs/a.json\", {"}}));
  EXPECT_EQ(told(faults_of_file(path)), Faults{});
  const Description d = read_scene(path);
  ASSERT_EQ(d.solids.size(), 2u);
  EXPECT_EQ(d.solids[0].name, "far");
  EXPECT_EQ(d.solids[0].at.file, (folder.path() / "scenes/organs/deeper/b.json").generic_string());
}

/// A variable of the environment for as long as a test needs it.
class Declared {
 public:
  Declared(const char* name, const std::string& value) : m_name(name) { setenv(name, value.c_str(), 1); }
  ~Declared() { unsetenv(m_name); }
  Declared(const Declared&) = delete;
  Declared& operator=(const Declared&) = delete;

 private:
  const char* m_name;
};

TEST(Reader, OnlyFilesOfTheTreeOrOfADeclaredLibraryAreOpened) {
  const Folder folder;
  folder.write("elsewhere/secret.json", kOrgan);
  const std::string tree = std::filesystem::canonical(folder.path()).generic_string() + "/mine";
  const auto refused = [&](const std::string& name) {
    return one("6:12 expected a file in " + tree + " or in a library of TROCAR_LIBRARY, got \"" + name + "\"");
  };
  const auto naming = [&](const std::string& name) {
    return folder.write("mine/scene.json", scene_with({{6, "\"organs\": [\"" + name + "\", {"}}));
  };
  EXPECT_EQ(told(faults_of_file(naming("../elsewhere/secret.json"))), refused("../elsewhere/secret.json"));
  std::filesystem::create_symlink("../elsewhere/secret.json", folder.path() / "mine" / "link.json");
  EXPECT_EQ(told(faults_of_file(naming("link.json"))), refused("link.json"));
  std::string up = "../../../../../../../../../../../../etc/passwd";
  EXPECT_EQ(told(faults_of_file(naming(up))), refused(up));
  const Declared library("TROCAR_LIBRARY", "/nowhere:" + (folder.path() / "elsewhere").string());
  EXPECT_EQ(told(faults_of_file(naming("../elsewhere/secret.json"))), Faults{});
  EXPECT_EQ(told(faults_of_file(naming(up))), refused(up));
}

TEST(Reader, AMeshOutsideOfTheTreeIsNotOpened) {
  const Folder folder;
  const std::string name = "../../../../../../../../../../../../etc/passwd";
  const auto path = folder.write(
      "organ.json",
      "{\"format\": 1, \"solids\": [{\"name\": \"x\", \"tissue\": \"y\",\n\"mesh\": {\"file\": \"" + name + "\"}}]}");
  EXPECT_EQ(told(check_file(path)),
            one("2:18 expected a file in " + std::filesystem::canonical(folder.path()).generic_string() +
                " or in a library of TROCAR_LIBRARY, got \"" + name + "\""));
}

TEST(Reader, AnUnknownNameIsToldInWordsThatFit) {
  EXPECT_EQ(unknown_name("command", "chek", {"check", "list"}),
            "expected a known command, got \"chek\" (did you mean \"check\"?); known: check, list");
  EXPECT_EQ(unknown_name("exercise", "camra-0", {"basics/camera-0"}),
            "expected a known exercise, got \"camra-0\" (did you mean \"basics/camera-0\"?); known: basics/camera-0");
  EXPECT_EQ(unknown_name("organ", "x", {}), "expected an organ, got \"x\"; none is known");
}

TEST(Reader, FaultsOfAllFilesAreToldTogether) {
  const Folder folder;
  folder.write("a.json", "{\"format\": 1, \"solids\": 3}");
  folder.write("b.json", "{\"format\": 1,\n \"strands\": [");
  const auto path = folder.write(
      "scene.json", scene_with({{2, "\"format\": 7,"}, {6, "\"organs\": [\"a.json\", \"b.json\", \"c.json\", {"}}));
  const std::vector<core::Fault> faults = faults_of_file(path);
  const std::string in = folder.path().generic_string();
  EXPECT_EQ(told(faults),
            (Faults{"2:11 expected 1 for \"format\", got 7",
                    "6:32 expected the name of a file, got \"c.json\" (there is no file " + in + "/c.json)",
                    "1:25 expected an array for \"solids\", got 3",
                    "2:14 expected ']' to close the array that began at 2:13, got the end of the file"}));
  ASSERT_EQ(faults.size(), 4u);
  EXPECT_EQ(faults[2].at.file, in + "/a.json");
  EXPECT_EQ(faults[3].at.file, in + "/b.json");
}

TEST(Reader, FilesThatIncludeEachOtherInACircleAreAFault) {
  const Folder folder;
  folder.write("a.json", "{\"format\": 1,\n\"organs\": [\"b.json\"]}");
  folder.write("b.json", "{\"format\": 1, \"organs\": [\"./x/../a.json\"]}");
  folder.write("self.json", "{\"format\": 1, \"organs\": [\"self.json\"]}");
  const std::string in = folder.path().generic_string();
  const auto path = folder.write("scene.json", scene_with({{6, "\"organs\": [\"a.json\", \"self.json\", {"}}));
  EXPECT_EQ(told(faults_of_file(path)), (Faults{"1:26 expected files that do not include each other in a cycle, got " +
                                                    in + "/a.json -> " + in + "/b.json -> " + in + "/a.json",
                                                "1:26 expected files that do not include each other in a cycle, got " +
                                                    in + "/self.json -> " + in + "/self.json"}));
}

// ---- a scene that is like another one -------------------------------------------------------------------------------

TEST(Like, WhatASceneDoesNotSayIsAsInTheOneThatItIsLike) {
  const Folder folder;
  folder.write("scenes/organs/far.json", kOrgan);
  folder.write("scenes/base/scene.json",
               scene_with({{3, "\"name\": \"base\", \"title\": \"Base\", \"gravity_m_s2\": [0, 0, -1],"},
                           {6, "\"organs\": [\"../organs/far.json\", {"}}));
  const auto path = folder.write("scenes/small/scene.json",
                                 "{\"format\": 1, \"name\": \"small\", \"like\": \"../base/scene.json\",\n"
                                 "\"gravity_m_s2\": [0, 0, -2], \"tools\": [],\n"
                                 "\"scope\": {\"port\": \"navel\", \"tip_mm\": [0, 0, -9], \"angle_deg\": 30}}");
  ASSERT_EQ(told(faults_of_file(path)), Faults{});
  EXPECT_EQ(kind_of_file(path), FileKind::scene);
  const Description d = read_scene(path);
  EXPECT_EQ(d.name, "small");
  EXPECT_EQ(d.title, "Base");
  EXPECT_EQ(d.file, path.generic_string());
  EXPECT_EQ(d.gravity, (Vec3d{0, 0, -2}));
  EXPECT_EQ(d.solids.size(), 2u) << "names are relative to the file that says them";
  EXPECT_TRUE(d.placements.empty());
  EXPECT_DOUBLE_EQ(d.scope_placement.tip.z, -0.009);
  EXPECT_GT(d.scope.angle, 0.5);
  EXPECT_EQ(write_scene(read_scene(folder.write("written.json", write_scene(d)))), write_scene(d)) << "whole";
}

TEST(Like, ManyMayStandInForOneAnother) {
  const Folder folder;
  folder.write("a.json", scene_with({{3, "\"name\": \"a\", \"title\": \"A\","}}));
  folder.write("b.json", R"({"format": 1, "name": "b", "like": "a.json", "title": "B", "tools": []})");
  const Description d = read_scene(folder.write("c.json", R"({"format": 1, "name": "c", "like": "b.json"})"));
  EXPECT_EQ(d.title, "B");
  EXPECT_TRUE(d.placements.empty());
  EXPECT_EQ(d.solids.size(), 1u);
}

TEST(Like, FaultsAreToldWhereTheyStand) {
  const Folder folder;
  folder.write("base.json",
               scene_with({{5, R"({"name": "soft", "density_kg_m3": -1, "young_Pa": 8000, "source": "x"}],)"},
                           {20, "\"tools\": 3,"}}));
  const auto path = folder.write("scene.json",
                                 "{\"format\": 1, \"like\": \"base.json\",\n\"titel\": \"x\",\n"
                                 "\"tools\": [{\"instrument\": \"stock\", \"port\": \"navel\",\n"
                                 "\"tip_mm\": [0, 0, -60]}]}");
  const std::vector<core::Fault> faults = faults_of_file(path);
  const Faults all = told(faults);
  ASSERT_EQ(all.size(), 5u);
  EXPECT_EQ(all[0].substr(0, 28), "1:1 expected the key \"name\" ") << "its own";
  EXPECT_EQ(all[1].substr(0, 30), "2:1 expected a known key of a ");
  EXPECT_EQ(all[2], "3:26 expected a known instrument, got \"stock\" (did you mean \"stick\"?); known: stick");
  EXPECT_EQ(all[3], "5:35 expected a number in [1, 25000] for \"density_kg_m3\", got -1");
  EXPECT_EQ(all[4], "20:10 expected an array for \"tools\", got 3");
  EXPECT_EQ(faults[2].at.file, path.generic_string());
  EXPECT_EQ(faults[3].at.file, (folder.path() / "base.json").generic_string());
}

TEST(Like, ACircleIsAFaultAndSoIsAFileThatIsNotThereOrLiesElsewhere) {
  const Folder folder;
  const std::string in = folder.path().generic_string();
  const auto like = [](const std::string& name) {
    return "{\"format\": 1, \"name\": \"x\",\n\"like\": \"" + name + "\"}";
  };
  folder.write("tree/b.json", like("a.json"));
  const auto path = folder.write("tree/a.json", like("b.json"));
  EXPECT_EQ(told(faults_of_file(path)), one("2:9 expected files that do not include each other in a cycle, got " + in +
                                            "/tree/a.json -> " + in + "/tree/b.json -> " + in + "/tree/a.json"));
  EXPECT_EQ(told(faults_of_file(folder.write("tree/c.json", like("d.json")))),
            one("2:9 expected the name of a file, got \"d.json\" (there is no file " + in + "/tree/d.json)"));
  folder.write("elsewhere/base.json", scene_with({}));
  const Faults refused = told(faults_of_file(folder.write("tree/e.json", like("../elsewhere/base.json"))));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].find("TROCAR_LIBRARY"), std::string::npos) << refused[0];
}

TEST(Reader, EndlessIncludesAreBounded) {
  const Folder folder;
  const auto name = [](int i) { return fmt::format("o{}.json", i); };
  for (int i = 0; i < 20; ++i)
    folder.write(name(i), fmt::format("{{\"format\": 1, \"organs\": [\"{}\"]}}", name(i + 1)));
  const auto deep = folder.write("deep.json", scene_with({{6, "\"organs\": [\"o0.json\", {"}}));
  EXPECT_EQ(told(faults_of_file(deep)), one("1:26 expected at most 16 files inside each other, got more"));

  std::string many = "\"organs\": [";
  for (int i = 0; i < 300; ++i) many += "\"empty.json\",";
  folder.write("empty.json", "{\"format\": 1}");
  const auto wide = folder.write("wide.json", scene_with({{6, many + "{"}}));
  EXPECT_EQ(faults_of_file(wide).size(), 45u);  // the scene is the first of 256
}

TEST(Reader, FileNamesMustBeRelative) {
  EXPECT_EQ(faults_of({{6, "\"organs\": [@\"/etc/passwd\", {"}}),
            one("expected a file name relative to this file, got \"/etc/passwd\""));
}

TEST(Reader, AMissingSceneIsAFaultOfTheWholeFile) {
  const Folder folder;
  const std::vector<core::Fault> faults = faults_of_file(folder.path() / "none.json");
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(core::to_string(faults[0]),
            (folder.path() / "none.json").generic_string() + ": expected a file, got none of this name");
}

TEST(Reader, FilesAreCheckedOnTheirOwnByTheirKind) {
  const Folder folder;
  EXPECT_EQ(kind_of_file(folder.write("o.json", kOrgan)), FileKind::organ);
  EXPECT_EQ(kind_of_file(folder.write("s.json", scene_with({}))), FileKind::scene);
  EXPECT_EQ(kind_of_file(folder.write("i.json", "{\"kind\": \"probe\"}")), FileKind::instrument);
  EXPECT_EQ(kind_of_file(folder.write("t.json", "{\"tissues\": []}")), FileKind::tissue);
  EXPECT_EQ(kind_of_file(folder.write("e.json", "{\"scene\": \"s.json\", \"kind\": \"x\"}")), FileKind::exercise);
  EXPECT_EQ(told(check_file(folder.path() / "o.json")), Faults{});  // its tissue is a scene's business
  EXPECT_EQ(told(check_file(folder.path() / "t.json")),
            (Faults{"1:1 expected the key \"format\" (version of this kind of file) in this tissue table, got none",
                    "1:13 expected at least 1 items for \"tissues\", got 0"}));
}

TEST(Reader, ScenesAndInstrumentsAreListedByName) {
  const Folder folder;
  folder.write("b/scene.json", scene_with({{3, "\"name\": \"small\", \"title\": \"Second\","}}));
  folder.write("a/scene.json", "{");
  folder.write("instruments/p.json", "{\"format\": 1, \"name\": \"p\", \"title\": \"P\", \"kind\": \"probe\"}");
  folder.write("instruments/q.json", "{\"format\": 1}");
  const std::vector<SceneEntry> scenes = list_scenes(folder.path());
  ASSERT_EQ(scenes.size(), 2u);
  EXPECT_EQ(scenes[0].name, "a");
  EXPECT_EQ(scenes[1].name, "b");
  EXPECT_EQ(scenes[1].title, "Second");
  const std::vector<InstrumentEntry> instruments = list_instruments(folder.path() / "instruments");
  ASSERT_EQ(instruments.size(), 1u);
  EXPECT_EQ(instruments[0].title, "P");
  EXPECT_TRUE(list_scenes(folder.path() / "nowhere").empty());
}

TEST(Reader, SpoiledFilesNeverCrashAndFaultsAlwaysHaveAPlace) {
  const Folder folder;
  const std::string good = text_of(TROCAR_SOURCE_DIR "/scenes/organs/adnexa_left.json");
  ASSERT_FALSE(good.empty());
  core::Random random(11);
  int faulty = 0;
  for (int i = 0; i < 1500; ++i) {
    std::string text = good;
    for (int slips = 1 + int(random.next() % 4); slips > 0; --slips) {
      const std::size_t at = random.next() % text.size(), other = random.next() % good.size();
      const std::size_t n = 1 + random.next() % 12;
      if (random.next() % 2 == 0)
        text.erase(at, n);
      else
        text.replace(at, n, good, other, n);  // a piece of the file where it does not belong
    }
    const std::vector<core::Fault> faults = check_file(folder.write("a.json", text));
    faulty += faults.empty() ? 0 : 1;
    for (const core::Fault& f : faults) {
      ASSERT_GT(f.at.line, 0) << f.message;
      ASSERT_GT(f.at.column, 0) << f.message;
      ASSERT_EQ(f.message.rfind("expected ", 0), 0u) << f.message;
    }
  }
  EXPECT_GT(faulty, 1200);
}

TEST(Reader, AVariationNamesBodiesThatAreThereAndFiguresThatFit) {
  const auto faults = [](const std::string& variation) {
    return faults_of({{18, kScene[17] + " \"variation\": " + variation + ","}});
  };
  EXPECT_EQ(
      faults(
          R"({"regions": [{"around": "cord", "scale": 0.1, "turn_deg": 5}], "girths": [{"of": ["ball"], "radius": 0.1}]})"),
      Faults{});
  EXPECT_EQ(
      faults(R"({"regions": [{"around": @"chord", "shift_mm": 3}], "girths": [{"of": [@"bll"], "radius": 0.1}]})"),
      (Faults{
          R"(expected a known solid or strand, got "chord" (did you mean "cord"?); known: ball, cord)",
          R"(expected a known solid, strand, membrane or pouch, got "bll" (did you mean "ball"?); known: ball, cord)"}));
  EXPECT_EQ(faults(R"({"regions": [@{"scale": 0.1}, @{"around": "cord", "centre_mm": [0, 0, 0]}]})"),
            (Faults{"expected either \"around\" or \"centre_mm\", got none",
                    "expected either \"around\" or \"centre_mm\", got both"}));
  EXPECT_EQ(faults(R"({"regions": [{"around": "cord", "near_mm": 30, "far_mm": @20, "axis": @[0, 0, 0]}]})"),
            (Faults{"expected more than near_mm = 30, got 20", "expected a direction, got none"}));
  EXPECT_EQ(faults(R"({"findings": [@{"mark": "nub"}], "present": 1})"),
            one("expected a finding's mark to be one of the scene's, got \"nub\""));
  EXPECT_EQ(faults(R"({"present": @1})"), one("expected at most as many as there are findings, 0, got 1"));
  const std::string other = R"({"variants": [{"name": "other", "title": "", "source": "ours", "share": 0.6, )";
  EXPECT_EQ(faults(other + R"("organs": [{"strands": [{"name": "twig", "tissue": @"wood", "start": {"fixed": true}, )" +
                   R"("centreline_mm": [[0, 0, -90], [20, 0, -90]], "stations": [{"s_mm": 0, "radius_mm": 1}]}]}]}]})"),
            one("expected a known tissue, got \"wood\"; known: soft"));
  EXPECT_EQ(faults(other + R"("holds": [{"pouch": @"bag", "on": "cord", "centre_mm": [0, 0, 0], "radius_mm": 3}]}]})"),
            one("expected a pouch, got \"bag\"; none is known"));
  EXPECT_EQ(faults(R"({"variants": @[{"name": "a", "title": "", "source": "ours", "share": 0.6}, )"
                   R"({"name": "b", "title": "", "source": "ours", "share": 0.6}]})"),
            one("expected shares of at most 1 in all, got 1.2"));
  EXPECT_EQ(faults(R"({"variants": [@{"name": "common", "title": "", "source": "ours", "share": 0.6}]})"),
            one("expected a name of its own for every variant, and not \"common\", got \"common\""));
  EXPECT_EQ(faults(R"(@{"bleeder": true})"), one("expected a bleeder with a variable hole, got none in this scene"));
}

}  // namespace
}  // namespace trocar::scene
