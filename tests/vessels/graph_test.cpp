// Every unsound figure of a graph is found, each at its place, all in one pass; and what is sound is compiled.
#include <limits>
#include <stdexcept>

#include <trocar/core/random.hpp>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;
using Part = GraphFault::Part;

VesselGraph sound() {
  VesselGraph g;
  g.nodes = 3;
  g.segments = {artery(0, 1, 0.1, 5e-3, 0.7e6, 0.5e-3), artery(1, 2, 0.1, 3e-3, 0.8e6, 0.3e-3)};
  g.sources = {{.node = 0}};
  g.ends = {matched_end(g, 1, 12000, 2e-6, 1)};
  return g;
}

/// Exactly one fault, there.
void expect_fault(const VesselGraph& g, Part part, int index, const std::string& field, const std::string& says) {
  const auto faults = check(g);
  ASSERT_EQ(faults.size(), 1u) << field << ", " << (faults.empty() ? "none" : faults.front().message);
  EXPECT_EQ(faults[0].part, part) << field;
  EXPECT_EQ(faults[0].index, index) << field;
  EXPECT_EQ(faults[0].field, field);
  EXPECT_NE(faults[0].message.find(says), std::string::npos) << faults[0].message;
  EXPECT_THROW(build(g), std::invalid_argument);
}

TEST(VesselGraph, SoundOneHasNoFaults) { EXPECT_TRUE(check(sound()).empty()); }

TEST(VesselGraph, FiguresThatAreZeroNegativeOrNoNumberAreFoundWhereTheyStand) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, -1e-3, nan, inf}) {
    VesselGraph g = sound();
    g.segments[1].radius = bad;
    expect_fault(g, Part::segment, 1, "radius", "expected at least 1e-06 and at most 0.05 m, got");
    g = sound(), g.segments[0].length = bad;
    expect_fault(g, Part::segment, 0, "length", "expected at least");
    g = sound(), g.segments[0].wall.modulus = bad;
    expect_fault(g, Part::segment, 0, "wall.modulus", "expected more than 0");
    g = sound(), g.segments[0].wall.thickness = bad;
    expect_fault(g, Part::segment, 0, "wall.thickness", "expected more than 0");
  }
  VesselGraph g = sound();
  g.segments[0].wall.poisson = 0.6;
  expect_fault(g, Part::segment, 0, "wall.poisson", "at most 0.5");
  g = sound(), g.segments[0].wall.wave_speed = nan;
  expect_fault(g, Part::segment, 0, "wall.wave_speed", "got nan");
  g = sound(), g.segments[0].radius_to = -1;
  expect_fault(g, Part::segment, 0, "radius_to", "got -1");
  g = sound(), g.segments[1].reference_pressure = nan;
  expect_fault(g, Part::segment, 1, "reference_pressure", "got nan");
  g = sound(), g.segments[1].loss = -2;
  expect_fault(g, Part::segment, 1, "loss", "got -2");
  g = sound(), g.ends[0].compliance = nan;
  expect_fault(g, Part::end, 0, "compliance", "got nan");
  g = sound(), g.ends[0].r_far = g.ends[0].r_near = 0;
  expect_fault(g, Part::end, 0, "r_near", "at least 1000");
  g = sound(), g.sources[0].resistance = -1;
  expect_fault(g, Part::source, 0, "resistance", "got -1");
  g = sound(), g.heart.rate = 0;
  expect_fault(g, Part::heart, -1, "rate", "at least 10");
  g = sound(), g.heart.diastolic = 20000;
  expect_fault(g, Part::heart, -1, "diastolic", "got 20000");
  g = sound(), g.heart.shape = {1, 1, 1};
  expect_fault(g, Part::heart, -1, "shape", "got a line");
  g = sound(), g.heart.response[2].loss = 0;
  expect_fault(g, Part::heart, 2, "response", "rising");
  g = sound(), g.blood.density = nan;
  expect_fault(g, Part::blood, -1, "density", "got nan");
  g = sound(), g.settings.tick = 0;
  expect_fault(g, Part::settings, -1, "tick", "got 0");
}

TEST(VesselGraph, NodesThatAreNotThereAndLoopsAreFound) {
  VesselGraph g = sound();
  g.segments[1].to = 99;
  EXPECT_EQ(check(g).front().field, "to");
  EXPECT_EQ(check(g).front().message, "expected a node, 0 to 2, got 99");
  g = sound(), g.segments[1].from = -1;
  EXPECT_EQ(check(g).front().message, "expected a node, 0 to 2, got -1");
  g = sound(), g.segments.push_back(g.segments[1]), g.segments[2].to = 1;
  expect_fault(g, Part::segment, 2, "to", "another node");
  g = sound(), g.sources[0].node = 3;
  EXPECT_EQ(check(g).front().part, Part::source);
  g = sound(), g.ends[0].node = -5;
  expect_fault(g, Part::end, 0, "node", "got -5");
}

TEST(VesselGraph, NodesWithoutASegmentAreFound) {
  VesselGraph g = sound();
  g.nodes = 4;
  expect_fault(g, Part::graph, 3, "nodes", "3 is in none");
}

TEST(VesselGraph, CyclesAreFoundWhereATreeIsRequired) {
  VesselGraph g = sound();
  g.segments.push_back(artery(2, 0, 0.1, 1e-3, 1e6, 0.1e-3));
  EXPECT_TRUE(check(g).empty());
  g.tree = true;
  expect_fault(g, Part::segment, 2, "to", "closes a cycle at node 0");
}

TEST(VesselGraph, PartsWithoutASourceAreFound) {
  VesselGraph g = sound();
  g.nodes = 5;
  g.segments.push_back(artery(3, 4, 0.1, 1e-3, 1e6, 0.1e-3));
  expect_fault(g, Part::segment, 2, "from", "a way to a source");
  g = sound(), g.sources.clear();
  EXPECT_EQ(check(g).front().field, "sources");
}

TEST(VesselGraph, AllFaultsAreToldInOnePassAndNotMoreThanAHundred) {
  VesselGraph g = sound();
  g.segments[0].radius = -1, g.segments[1].length = 0, g.heart.rate = -3, g.ends[0].node = 7;
  EXPECT_EQ(check(g).size(), 4u);
  g = sound();
  g.segments.resize(500, VesselSegment{.from = 1, .to = 2});
  EXPECT_EQ(check(g).size(), 101u);
  EXPECT_EQ(check(g).back().message, "and 1892 more faults");
}

TEST(VesselGraph, AMillionSegmentsAreRefusedWithTheLimit) {
  VesselGraph g = sound();
  g.segments.resize(1'000'000, g.segments[0]);
  expect_fault(g, Part::graph, -1, "segments", "at most 20000 segments and 20001 nodes, got 1000000 and 3");
  g = sound();
  g.nodes = 1'000'000;
  expect_fault(g, Part::graph, -1, "segments", "got 2 and 1000000");
}

TEST(VesselGraph, TooManyCellsAreRefused) {
  VesselGraph g = sound();
  g.settings.tick = 1e-7;
  g.segments[0].length = 1;
  EXPECT_THROW(build(g), std::length_error);
}

TEST(VesselGraph, RandomFiguresNeverCrashTheCheck) {
  core::Random random(9);
  for (int i = 0; i < 20000; ++i) {
    VesselGraph g = sound();
    const double odd[] = {0, -1, 1e300, -1e300, std::nan(""), 1e-300, std::numeric_limits<double>::infinity(), 1};
    const auto pick = [&] { return odd[random.next() % 8]; };
    VesselSegment& s = g.segments[random.next() % 2];
    s.radius = random.next() % 3 ? s.radius : pick();
    s.length = random.next() % 3 ? s.length : pick();
    s.wall.modulus = random.next() % 3 ? s.wall.modulus : pick();
    s.reference_pressure = random.next() % 3 ? s.reference_pressure : pick();
    s.from = random.next() % 3 ? s.from : int(random.next());
    g.nodes = random.next() % 9 ? g.nodes : int(random.next() % 7) - 3;
    g.heart.systolic = random.next() % 9 ? g.heart.systolic : pick();
    if (!check(g).empty()) continue;
    try {
      Simulation sim(g);
      EXPECT_TRUE(sim.tick().fine());
    } catch (const std::length_error&) {  // sound figures, but more cells than there may be
    }
  }
}

}  // namespace
}  // namespace trocar::vessels
