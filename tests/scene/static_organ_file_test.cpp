// Organ files with a static solver: what is refused, where, and with which remedy.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "../sim/small_scene.hpp"
#include "files.hpp"

using namespace trocar;
using namespace trocar::scene;

namespace {

Description with(void (*change)(Solid&)) {
  Description d = small::description();
  d.strands.clear();
  d.membranes.clear();
  d.vessels.clear();
  d.fluids.reset();
  d.solids = {small::organ()};
  d.solids[0].solver = Solver::elastostatic;
  d.solids[0].solver_at = {"organ.json", 7, 3};
  change(d.solids[0]);
  return d;
}

std::string refusal(const Description& d) {
  try {
    compile(d);
  } catch (const core::BadInput& e) {
    EXPECT_EQ(e.faults().size(), 1u);
    EXPECT_EQ(e.faults().at(0).at.line, 7);
    return e.faults().at(0).message;
  }
  return "it was compiled";
}

bool says(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

/// Two tetrahedra that share nothing, and the nodes of the first within the anchor.
Solid loose_parts() {
  Solid s;
  s.name = "organ";
  s.tissue = "flesh";
  s.tets.emplace();
  s.tets->mesh.points = {{0, 0, 0},    {0.01, 0, 0}, {0, 0.01, 0},    {0, 0, 0.01},
                         {0.05, 0, 0}, {0.06, 0, 0}, {0.05, 0.01, 0}, {0.05, 0, 0.01}};
  s.tets->mesh.cells = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  s.anchors.push_back({{0.003, 0.003, 0.003}, 0.02, 0, {}});
  s.solver = Solver::elastostatic;
  s.solver_at = {"organ.json", 7, 3};
  return s;
}

TEST(StaticOrganFile, TooManySurfaceNodesAreRefusedWithTheNumberAndARemedy) {
  const std::string fault = refusal(with([](Solid& s) { s.cell = 0.0007; }));
  EXPECT_TRUE(says(fault, "surface nodes")) << fault;
  EXPECT_TRUE(says(fault, " MB")) << fault;
  EXPECT_TRUE(says(fault, "make its cells larger")) << fault;
}

TEST(StaticOrganFile, APartThatNothingHoldsIsRefused) {
  // Lattices are: gravity has nothing to bear it.
  Description d = with([](Solid&) {});
  d.solids = {loose_parts()};
  d.gravity = {0, 0, 0};
  try {
    compile(d);
    FAIL() << "it was compiled";
  } catch (const core::BadInput& e) {
    EXPECT_TRUE(says(e.faults().at(0).message, "held")) << e.faults().at(0).message;
  }
}

TEST(StaticOrganFile, LinearTetrahedraAndFibresCompile) {
  const sim::Model springs = compile(with([](Solid& s) { s.cuttable = true; }));
  const sim::Model tets = compile(with([](Solid& s) {
    s.cuttable = true;
    s.elasticity = Elasticity::tetrahedra;
    s.fibre = {1, 0, 0};
    s.fibre_ratio = 2;
  }));
  ASSERT_EQ(springs.statics.size(), 1u);
  ASSERT_EQ(tets.statics.size(), 1u);
  EXPECT_NE(springs.statics[0].solver.compliance, tets.statics[0].solver.compliance);
}

TEST(StaticOrganFile, KeysOfAStaticSolverAreRefusedBesideADynamicOne) {
  const Folder folder;
  const auto path = folder.write("organ.json", R"({"format": 1, "name": "organ", "solids": [{"name": "organ",
    "tissue": "flesh", "cell_mm": 5, "sections": [
      {"centre_mm": [0, 0, 0], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]},
      {"centre_mm": [0, 0, 10], "across_mm": [10, 0, 0], "deep_mm": [0, 10, 0]}],
    "beyond_deg": 20, "solver": "magic"}]})");
  const auto scene = folder.write("scene.json", R"({"format": 1, "name": "scene", "tissues": [], "organs":
    ["organ.json"], "instruments": [], "ports": [], "tools": [], "scope": {}})");
  try {
    read_scene(scene);
    FAIL() << "it was read";
  } catch (const core::BadInput& e) {
    const std::vector<std::string> all = told(e.faults());
    const auto found = [&](const char* words) {
      return std::any_of(all.begin(), all.end(), [&](const std::string& f) { return says(f, words); });
    };
    EXPECT_TRUE(found("\"solver\": \"static\" beside it"));
    EXPECT_TRUE(found("magic"));
  }
}

}  // namespace
