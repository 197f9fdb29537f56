// The step's laws: the same bits again, whatever Work holds, from any tick on; calm for ten
// minutes of cutting and clipping at random.
#include <cmath>
#include <limits>

#include <trocar/core/random.hpp>

#include "test_graphs.hpp"

namespace trocar::vessels {
namespace {

using namespace test;

/// A tree of `segments` with an anastomosis for every tenth of them, Windkessels at its leaves.
VesselGraph wood(int segments, std::uint64_t seed) {
  core::Random random(seed);
  VesselGraph g;
  g.nodes = 1;
  std::vector<double> diameter{10e-3};
  std::vector<int> children{0};
  for (int i = 0; i < segments - segments / 10; ++i) {
    int parent = g.nodes - 1 - int(random.uniform(0, std::min(g.nodes, 8)));
    if (children[parent] >= 2) parent = g.nodes - 1;
    ++children[parent];
    const double d = std::max(0.8e-3, diameter[parent] * random.uniform(0.7, 0.95));
    g.segments.push_back(artery(parent, g.nodes, random.uniform(0.01, 0.08), d, 0.8e6, 0.1 * d));
    diameter.push_back(d), children.push_back(0);
    ++g.nodes;
  }
  for (int i = 0; i < segments / 10; ++i) {
    const int a = int(random.uniform(0, g.nodes - 1));
    g.segments.push_back(artery(a, a + 1, 0.05, 0.8e-3, 1e6, 0.1e-3));
  }
  g.sources = {{.node = 0}};
  for (int i = 1; i < g.nodes; ++i)
    if (children[i] == 0) g.ends.push_back(matched_end(g, i - 1, 80 * kMmHg, 1e-7, 1));
  return g;
}

/// Cuts, holes and clips that come and go, the same for the same seed and tick.
struct Surgeon {
  core::Random random;
  int segments;
  std::vector<Opening> openings = std::vector<Opening>(16);
  std::vector<Occlusion> clips = std::vector<Occlusion>(16);
  explicit Surgeon(int n, std::uint64_t seed) : random(seed), segments(n) {}
  void act(int tick) {
    if (tick % 97 != 0) return;
    Opening& o = openings[random.next() % openings.size()];
    o = {};
    if (random.next() % 3) {
      o.segment = int(random.next() % std::uint64_t(segments)), o.s = random.uniform();
      o.kind = random.next() % 2 ? Opening::Kind::cut : Opening::Kind::hole;
      o.area = random.uniform(1e-8, 4e-6), o.outside = random.uniform(0, 15 * kMmHg);
      o.sealed = random.next() % 4 ? 0 : random.uniform();
    }
    Occlusion& c = clips[random.next() % clips.size()];
    c = {};
    if (random.next() % 2)
      c = {.segment = int(random.next() % std::uint64_t(segments)),
           .s = random.uniform(),
           .cover = random.next() % 2 ? 1.0 : random.uniform()};
  }
};

std::uint64_t hash_of(const FlowState& s) {
  core::Hasher h;
  add_to_hash(h, s);
  return h.value();
}

void spoil(FlowWork& w) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (auto* v : {&w.capacity, &w.extra, &w.ahead, &w.diagonal, &w.x, &w.values, &w.flow0, &w.flow_a, &w.flow_b})
    for (double& x : *v) x = nan;
  FlowSite site;
  site.at = site.orifice = site.outside = site.ooze = site.resistance = nan;
  site.segment = site.cell = site.index = site.point = 1'000'000;
  site.closed = site.fed[0] = site.fed[1] = site.open[0] = site.open[1] = true;
  for (FlowSite& s : w.sites) s = site;
  for (FlowChain& c : w.chains) c = {1'000'000, 1'000'000, 1'000'000, 1'000'000, 1'000'000};
  for (FlowPoint& p : w.points) p = {nan, nan, nan, nan, nan, nan, nan, nan, {nan, nan}};
  for (auto& p : w.part) p = 1'000'000;
  for (auto& p : w.part_fed) p = 1;
  for (auto& b : w.blocked) b = 1;
  w.site_count = w.chain_count = 1'000'000;
}

struct Operation {
  FlowModel model = build(wood(40, 3));
  FlowState state = rest_state(model);
  FlowWork work = make_work(model);
  Surgeon surgeon{40, 17};
  std::vector<OpeningFlow> flows = std::vector<OpeningFlow>(16);
  FlowReport tick(int t) {
    surgeon.act(t);
    return advance(model, {.openings = surgeon.openings, .clips = surgeon.clips, .infusion = 1e-7}, flows, state, work);
  }
};

TEST(FlowLaws, TheSameInputsGiveTheSameBitsWhateverWorkHolds) {
  Operation a, b;
  for (int t = 0; t < 5000; ++t) {
    spoil(b.work);
    a.tick(t), b.tick(t);
    if (t % 100 == 0) {
      ASSERT_EQ(hash_of(a.state), hash_of(b.state)) << t;
    }
  }
  EXPECT_EQ(hash_of(a.state), hash_of(b.state));
  EXPECT_GT(a.state.bled, 0);
}

TEST(FlowLaws, GoesOnFromAnyTick) {
  Operation a;
  for (int t = 0; t < 2000; ++t) a.tick(t);
  Operation b;
  b.state = a.state;
  b.surgeon = a.surgeon;
  for (int t = 2000; t < 4000; ++t) a.tick(t), b.tick(t);
  EXPECT_EQ(hash_of(a.state), hash_of(b.state));
}

TEST(FlowLaws, BitsAreThoseOfEveryCompiler) {
  Operation a;
  for (int t = 0; t < 3000; ++t) a.tick(t);
  EXPECT_EQ(hash_of(a.state), 0x3d5fd81c34a82feeu);
}

TEST(FlowLaws, StaysCalmForTenMinutesOfCutsAndClipsAtRandom) {
  Operation a;
  double highest = 0, lowest = 1e9;
  std::int64_t told = 0;
  a.model.heart.response = {};  // a patient who never weakens: the graph keeps its full pressure
  for (std::size_t i = 0; i < a.model.heart.response.size(); ++i) a.model.heart.response[i].loss = double(i);
  for (int t = 0; t < 600'000; ++t) {
    const FlowReport r = a.tick(t);
    ASSERT_EQ(r.flags, 0u) << t;
    for (const OpeningFlow& f : a.flows) {
      ASSERT_GE(f.picolitres[0], 0);
      ASSERT_LT(f.flow[0] + f.flow[1], 1e-4) << t;
      told += f.picolitres[0] + f.picolitres[1];
    }
    for (const double p : a.state.p) highest = std::max(highest, p), lowest = std::min(lowest, p);
  }
  // Clips that close within a tick on fast blood hammer: rho c u, twice that at a closed end.
  record("ten minutes of cuts and clips", "pressures %.0f to %.0f mmHg", lowest / kMmHg, highest / kMmHg);
  EXPECT_EQ(told, a.state.bled);
  EXPECT_LT(highest, 760 * kMmHg);
  EXPECT_GT(lowest, -760 * kMmHg);

  Operation untouched;  // and when all is taken off, everything is again as if nothing had been
  untouched.model.heart.response = a.model.heart.response;
  untouched.state.beat = a.state.beat, untouched.state.breath = a.state.breath;
  a.surgeon.openings.assign(16, Opening{}), a.surgeon.clips.assign(16, Occlusion{});
  untouched.surgeon = a.surgeon;
  for (int t = 1; t < 20'000; ++t) {
    if (t % 97 == 0) continue;  // the surgeon rests
    a.tick(t), untouched.tick(t);
  }
  double worst = 0;
  for (std::size_t i = 0; i < a.state.p.size(); ++i)
    worst = std::max(worst, std::fabs(a.state.p[i] - untouched.state.p[i]));
  expect_within("largest trace of it twenty seconds later [Pa]", worst, 1);
}

/// A number whose logarithm is uniform.
double spread(core::Random& r, double low, double high) { return low * std::pow(high / low, r.uniform()); }

/// Whatever check() lets pass: lengths of 1 mm to 0.5 m, radii of 0.1 to 10 mm, waves of 2 m/s to 100 km/s.
VesselGraph odd_graph(core::Random& r) {
  VesselGraph g;
  const int n = 1 + int(r.uniform(0, 12));
  g.nodes = n + 1;
  for (int i = 0; i < n; ++i) {
    VesselSegment v{.from = int(r.uniform(0, i + 1)), .to = i + 1};
    v.length = spread(r, 1e-3, 0.5), v.radius = spread(r, 1e-4, 1e-2);
    if (r.next() % 3 == 0) v.radius_to = spread(r, 1e-4, 1e-2);
    v.wall.modulus = spread(r, 1e5, 1e7), v.wall.thickness = v.radius * r.uniform(0.02, 0.3);
    v.wall.poisson = r.uniform(0, 0.5);
    if (r.next() % 2) v.wall.wave_speed = spread(r, 2, 1e5);
    if (r.next() % 3 == 0) v.loss = spread(r, 0.1, 100);
    v.vein = r.next() % 4 == 0;
    g.segments.push_back(v);
  }
  for (int i = 0; i < 2 && n > 2; ++i) {
    VesselSegment v = g.segments[0];
    v.from = int(r.uniform(0, n + 1)), v.to = int(r.uniform(0, n + 1));
    if (v.from != v.to) g.segments.push_back(v);
  }
  g.sources = {{.node = 0}};
  if (r.next() % 2)
    g.sources.push_back(constant_pressure(n, spread(r, 500, 2e4), r.next() % 2 ? spread(r, 1e6, 1e12) : 0));
  if (r.next() % 2)
    g.ends.push_back({.node = int(r.uniform(0, n + 1)),
                      .r_near = spread(r, 1e6, 1e10),
                      .r_far = spread(r, 1e6, 1e11),
                      .compliance = r.next() % 2 ? spread(r, 1e-13, 1e-8) : 0});
  return g;
}

void disturb(Simulation& sim, core::Random& r) {
  sim.openings.assign(8, {}), sim.clips.assign(8, {});
  const auto place = [&] { return r.next() % 4 ? r.uniform() : double(r.next() % 2); };
  for (Opening& o : sim.openings) {
    if (r.next() % 3) continue;
    o.segment = int(r.next() % sim.model.segments.size()), o.s = place();
    o.kind = r.next() % 2 ? Opening::Kind::cut : Opening::Kind::hole;
    o.area = spread(r, 1e-13, 1e-3), o.outside = r.uniform(-2e4, 2e4);
    o.sealed = r.next() % 3 ? 0 : r.uniform(-1, 2);
  }
  for (Occlusion& c : sim.clips)
    if (r.next() % 3 == 0)
      c = {.segment = int(r.next() % sim.model.segments.size()), .s = place(), .cover = r.next() % 3 ? r.uniform() : 1};
}

TEST(FlowLaws, OddGraphsWithOddOpeningsStayFinite) {
  core::Random r(21);
  for (int trial = 0; trial < 300; ++trial) {
    Simulation sim(odd_graph(r));
    for (int t = 0; t < 200; ++t) {
      if (t % 20 == 0) disturb(sim, r);
      ASSERT_TRUE(sim.tick().fine()) << "graph " << trial << ", tick " << t;
      for (const OpeningFlow& f : sim.flows)
        for (int side = 0; side < 2; ++side) {
          ASSERT_GE(f.picolitres[side], 0);
          ASSERT_GE(f.flow[side], 0);
        }
    }
  }
}

TEST(FlowLaws, AThousandSegmentsCompileAndRun) {
  Simulation sim(wood(1000, 11));
  sim.openings = {{.segment = 500, .s = 0.5, .kind = Opening::Kind::cut, .area = 1e-6}};
  sim.run(1);
  EXPECT_TRUE(sim.tick().fine());
  const double start[2] = {sim.flows[0].flow[0], sim.flows[0].flow[1]};
  for (int i = 0; i < 200; ++i) {  // both stumps of the cut drain evenly, tick by tick
    sim.tick();
    for (int side = 0; side < 2; ++side) {
      EXPECT_GT(sim.flows[0].flow[side], 0.7 * start[side]);
      EXPECT_LT(sim.flows[0].flow[side], 1.3 * start[side]);
    }
  }
  record("a thousand segments", "%.0f cells, %.0f entries", double(sim.model.cells.size()),
         double(sim.model.plan.later.size()));
}

TEST(FlowLaws, ANonFiniteStateIsToldAndNotAdvanced) {
  Operation a;
  a.tick(0);
  a.state.p[7] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> q = a.state.q;
  const FlowReport r = a.tick(1);
  EXPECT_TRUE(r.flags & FlowReport::kNonFinite);
  EXPECT_GE(r.first_bad, 0);
  EXPECT_EQ(a.state.q, q);
}

}  // namespace
}  // namespace trocar::vessels
