// Compiling a Description: the same Model every time, drawn shapes in equilibrium, and faults told with their place.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/scene/files/reader.hpp>

#include "../sim/small_scene.hpp"

using namespace trocar;
using namespace trocar::scene;

namespace {

/// The faults that compiling gives; none when it compiles.
std::vector<core::Fault> faults_of(const Description& d) {
  try {
    compile(d);
  } catch (const core::BadInput& bad) {
    return bad.faults();
  }
  return {};
}

const core::Location kHere{"organs/some.json", 17, 9};

void expect_one_fault_here(const Description& d, const std::string& saying) {
  const std::vector<core::Fault> found = faults_of(d);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at.file, kHere.file);
  EXPECT_EQ(found[0].at.line, kHere.line);
  EXPECT_EQ(found[0].at.column, kHere.column);
  EXPECT_NE(found[0].message.find(saying), std::string::npos) << found[0].message;
}

TEST(Compile, TheSameDescriptionGivesTheSameModel) {
  const sim::Model a = compile(small::description()), b = compile(small::description());
  EXPECT_EQ(a.hash, b.hash);
  EXPECT_NE(a.hash, 0u);
  EXPECT_EQ(hash_of(sim::initial_state(a)), hash_of(sim::initial_state(b)));
}

TEST(Compile, AnyChangeThatMattersChangesTheHash) {
  const std::uint64_t hash = compile(small::description()).hash;
  Description d = small::description();
  d.tissues[1].young *= 1.0001;
  EXPECT_NE(compile(d).hash, hash) << "a stiffer tube";
  d = small::description();
  d.solids[0].sections[0].deep.z += 1e-5;
  EXPECT_NE(compile(d).hash, hash) << "a thicker organ";
  d = small::description();
  d.ports[0].position.x += 1e-4;
  EXPECT_NE(compile(d).hash, hash) << "another port";
  d = small::description();
  d.instruments[0].friction += 0.1;
  EXPECT_NE(compile(d).hash, hash) << "another jaw";
  d = small::description();
  d.strands[0].cuttable = false;
  EXPECT_NE(compile(d).hash, hash) << "a strand that must not be cut";
  d = small::description();
  d.gravity.z *= 0.9;
  EXPECT_NE(compile(d).hash, hash) << "another planet";
}

TEST(Compile, WhatIsOnlyShownDoesNotChangeTheHash) {
  Description d = small::description();
  d.title = "another title";
  d.solids[0].look = "another look";
  EXPECT_EQ(compile(d).hash, compile(small::description()).hash);
}

TEST(Compile, TheModelHasWhatTheDescriptionNames) {
  const sim::Model& m = small::model();
  EXPECT_EQ(m.solids.size(), 2u);
  EXPECT_EQ(m.walls.size(), 1u);
  EXPECT_EQ(m.strand_index("tube"), small::kTube);
  EXPECT_EQ(m.strand_index("cord"), small::kCord);
  EXPECT_EQ(m.strand_index("nothing"), -1);
  ASSERT_EQ(m.hands.size(), 3u);
  EXPECT_EQ(m.placed(small::kApplier).kind, interactions::ToolKind::clip_applier);
  EXPECT_EQ(m.placed(small::kApplier).clips, 20);
  EXPECT_NEAR(m.strand_bodies[small::kTube].length(), 0.081, 1e-6);
  EXPECT_FALSE(m.strand_bodies[small::kCord].cuttable);
  EXPECT_EQ(m.strands[small::kTube].start.kind, sim::StrandEndModel::hosted);
  EXPECT_EQ(m.strands[small::kTube].end.kind, sim::StrandEndModel::free);
  EXPECT_EQ(m.strands[small::kCord].start.kind, sim::StrandEndModel::fixed);
  EXPECT_GE(m.target_index("tube.isthmus"), 0);
  EXPECT_GE(m.target_index("organ"), 0);
  EXPECT_GE(m.target_index("b.jaw_b"), 0);
}

TEST(Compile, ToolsStandWhereTheyWerePlaced) {
  const Description d = small::description();
  const sim::Model& m = small::model();
  for (size_t t = 0; t < m.hands.size(); ++t) {
    const Vec3d tip = kinematics::forward(m.hands[t].port, pose_of(m.start.tools[t])).tip;
    EXPECT_LT(length(tip - d.placements[t].tip), 1e-7) << m.placed(t).name;
  }
}

TEST(Compile, TheDrawnShapeIsTheEquilibriumButForThePulse) {
  Description d = small::description();
  d.vessels[0].pulse_gain = 0;
  const sim::Model m = compile(d);
  sim::State s = sim::initial_state(m);
  sim::Work w = sim::make_work(m);
  double worst = 0, fold = 0;
  for (int t = 0; t < 3000; ++t) {
    step(m, m.start, s, w);
    for (size_t i = 0; i < m.solids.size(); ++i)
      for (int n = 0; n < m.solids[i].network.nodes; ++n)
        worst = std::max(
            worst, length(tissue::position(m.solids[i].network, s.solids[i], n) - m.solids[i].network.rest[size_t(n)]));
    for (size_t i = 0; i < m.strand_bodies.size(); ++i)
      for (size_t n = 0; n < s.strands[i].x.size(); ++n)
        worst = std::max(worst, length(s.strands[i].x[n] - m.strand_bodies[i].model.rest[n]));
    for (size_t i = 0; i < m.membranes.size(); ++i)
      for (int n = 0; n < m.membranes[i].sheet.nodes(); ++n) {
        const tissue::NetworkModel& network = m.membranes[i].sheet.network;
        fold = std::max(fold, length(tissue::position(network, s.membranes[i].network, n) - network.rest[size_t(n)]));
      }
  }
  EXPECT_LT(fold, 5e-5) << "[m] in three seconds";
  EXPECT_LT(worst, 2e-5) << "[m] in three seconds";
}

TEST(Compile, AFoldFarWiderThanLongIsBounded) {
  Description d = small::description();
  d.membranes[0].spacing = 0.0005;
  d.membranes[0].base = {{0.004, 0.001, -5}, {0.017, 0.002, -5}, {0.030, 0, -5}};
  d.membranes[0].spacing_at = kHere;
  expect_one_fault_here(d, "at most 20000 nodes");
}

TEST(Compile, TheReportSaysWhatTheBodiesCameTo) {
  CompileReport report;
  const sim::Model m = compile(small::description(), &report);
  ASSERT_EQ(report.bodies.size(), 8u);
  for (const BodyReport& b : report.bodies) {
    EXPECT_GT(b.nodes, 0) << b.name;
    if (b.kind != "solid" && b.kind != "cuttable") continue;
    EXPECT_GT(b.mass, 0.5 * 1050 * b.volume) << b.name;
    EXPECT_LT(b.mass, 1.5 * 1050 * b.volume) << b.name;
    EXPECT_GE(b.substeps, 1) << b.name;
    EXPECT_GT(b.dt_limit * 1.0001, 1e-3 / b.substeps) << b.name << ": whole sub-steps within the limit";
    EXPECT_LT(b.residual, 1e-3 * b.mass * 9.81 + 1e-6) << b.name << ": the drawn shape bears its weight";
  }
}

TEST(Compile, EveryOrganWeighsWhatItsTissueAndItsVolumeSay) {
  for (const char* scene : {"gynaecology", "cutting"}) {
    const Description d = read_scene(std::string(TROCAR_SOURCE_DIR "/scenes/") + scene + "/scene.json");
    CompileReport report;
    compile(d, &report);
    int organs = 0;
    for (const Solid& solid : d.solids) {
      const auto is_it = [&solid](const auto& x) { return x.name == solid.name; };
      const auto body = std::find_if(report.bodies.begin(), report.bodies.end(), is_it);
      ASSERT_NE(body, report.bodies.end());
      for (const Tissue& t : d.tissues) {
        if (t.name != solid.tissue) continue;
        EXPECT_NEAR(body->mass, t.density * body->volume, 1e-6 * body->mass) << solid.name;
        ++organs;
      }
    }
    EXPECT_EQ(organs, int(d.solids.size()));
  }
}

TEST(Compile, AnOrganThatNothingHoldsIsALocatedFault) {
  Description d = small::description();
  d.strands[0].start = {};
  d.strands[0].start.fixed = true;
  d.solids[0].anchors.clear();
  d.solids[0].at = kHere;
  expect_one_fault_here(d, "organ");
}

TEST(Compile, ABodyThatNeedsCountlessSubStepsIsALocatedFault) {
  for (const bool fold : {false, true}) {
    Description d = small::description();
    d.tissues.push_back(d.tissues[0]);
    d.tissues.back().name = "board";
    d.tissues.back().young = 1e9;
    d.tissues.back().p2 = 1e5;
    (fold ? d.membranes[0].tissue : d.solids[0].tissue) = "board";
    (fold ? d.membranes[0].at : d.solids[0].at) = kHere;
    expect_one_fault_here(d, "sub-steps");
  }
}

TEST(Compile, AnAnchorThatReachesNothingIsALocatedFault) {
  Description d = small::description();
  d.solids[1].anchors.push_back({{0.5, 0, 0}, 0.005, 0, kHere});
  expect_one_fault_here(d, "pad");
}

TEST(Compile, AStrandsEndFarFromItsOrganIsALocatedFault) {
  Description d = small::description();
  for (Vec3d& p : d.strands[0].centreline) p.x += 0.03;
  d.strands[0].start.at = kHere;
  expect_one_fault_here(d, "organ");
}

TEST(Compile, AStrandThatNothingHoldsUpIsALocatedFault) {
  Description d = small::description();
  d.strands[1].start.fixed = d.strands[1].end.fixed = false;
  d.strands[1].foundation = 0;
  d.strands[1].at = kHere;
  expect_one_fault_here(d, "cord");
}

TEST(Compile, MoreToolsThanHandsIsALocatedFault) {
  Description d = small::description();
  while (d.placements.size() < size_t(sim::kMaxTools)) d.placements.push_back(d.placements[0]);
  EXPECT_TRUE(faults_of(d).empty());
  d.placements.push_back(d.placements[0]);
  d.placements.back().at = kHere;
  expect_one_fault_here(d, "at most");
}

TEST(Compile, AHandThatHoldsAPouchHasToBeNearWhereThatIsHeld) {
  Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/cholecystectomy_operation/scene.json");
  ASSERT_EQ(d.placements.size(), 3u);
  EXPECT_TRUE(faults_of(d).empty());
  Placement& assistant = d.placements[2];
  assistant.at = kHere;
  Description far = d, blunt = d;
  far.placements[2].tip.y -= 0.05;
  expect_one_fault_here(far, "held in space");
  blunt.placements[2].instrument = "hook";
  for (Port& port : blunt.ports) port.diameter = 0.010;
  expect_one_fault_here(blunt, "an instrument that grips");
}

TEST(Compile, FaultsOfAllOrgansAreFoundInOnePass) {
  Description d = small::description();
  d.solids[0].anchors.push_back({{0.5, 0, 0}, 0.005, 0, kHere});
  d.solids[1].anchors.push_back({{0.5, 0, 0}, 0.005, 0, kHere});
  EXPECT_EQ(faults_of(d).size(), 2u);
}

}  // namespace
