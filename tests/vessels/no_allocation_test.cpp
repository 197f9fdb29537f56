// The step's law: no allocation.
#include "../count_allocations.hpp"
#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

TEST(NoAllocation, InATickOfFlowItsOpeningsItsClipsOrItsReadings) {
  VesselGraph g;
  g.nodes = 4;
  g.segments = {artery(0, 1, 0.1, 5e-3, 0.7e6, 0.5e-3), artery(1, 2, 0.1, 2e-3, 1e6, 0.2e-3),
                artery(1, 3, 0.1, 2e-3, 1e6, 0.2e-3), artery(2, 3, 0.1, 1e-3, 1e6, 0.1e-3)};
  g.sources = {{.node = 0}};
  g.ends = {matched_end(g, 2, 12000, 1e-6, 1)};
  Simulation sim(g);
  sim.openings.resize(4), sim.clips.resize(4), sim.flows.resize(4);
  const long before = g_allocations;
  std::uint32_t flags = 0;
  double moved = 0;
  for (int t = 0; t < 400; ++t) {
    Opening& o = sim.openings[t / 20 % 4];
    o = {.segment = t / 20 % 4, .s = 0.01 * (t % 100), .area = 1e-6};
    o.kind = t / 40 % 2 ? Opening::Kind::cut : Opening::Kind::hole;
    sim.clips[t / 30 % 4] = {.segment = t / 50 % 4, .s = 0.3, .cover = t % 3 ? 1.0 : 0.5};
    flags |= sim.tick().flags;
    moved += read_wall(sim.model, sim.state, 1, 0.4, 10).shift + lumen_area(sim.model, sim.state, 2, 0.4);
  }
  EXPECT_EQ(g_allocations, before);
  EXPECT_EQ(flags, 0u);
  EXPECT_NE(moved, 0);
  EXPECT_GT(sim.state.bled, 0);
}

}  // namespace
}  // namespace trocar::vessels
