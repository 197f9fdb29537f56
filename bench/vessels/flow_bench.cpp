// What a tick of blood flow costs, by segments: a tree with an anastomosis for every tenth segment, quiet and with
// openings and clips. `us` is the fastest round of a hundred ticks, per tick: other work on the machine only ever adds.
#include <algorithm>
#include <chrono>

#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/vessels/flow.hpp>

namespace {

using namespace trocar;
using namespace trocar::vessels;

VesselGraph wood(int segments) {
  core::Random random(3);
  VesselGraph g;
  g.nodes = 1;
  std::vector<double> diameter{10e-3};
  std::vector<int> children{0};
  const auto add = [&](int a, int b, double length, double d) {
    VesselSegment s{.from = a, .to = b, .length = length, .radius = d / 2};
    s.wall.modulus = 0.8e6, s.wall.thickness = 0.1 * d;
    g.segments.push_back(s);
  };
  for (int i = 0; i < segments - segments / 10; ++i) {
    int parent = g.nodes - 1 - int(random.uniform(0, std::min(g.nodes, 8)));
    if (children[parent] >= 2) parent = g.nodes - 1;
    ++children[parent];
    const double d = std::max(0.8e-3, diameter[parent] * random.uniform(0.7, 0.95));
    add(parent, g.nodes, random.uniform(0.01, 0.08), d);
    diameter.push_back(d), children.push_back(0);
    ++g.nodes;
  }
  for (int i = 0; i < segments / 10; ++i) {
    const int a = int(random.uniform(0, g.nodes - 1));
    add(a, a + 1, 0.05, 0.8e-3);
  }
  g.sources = {{.node = 0}};
  for (int i = 1; i < g.nodes; ++i)
    if (children[i] == 0) g.ends.push_back(matched_end(g, i - 1, 10000, 1e-7, 1));
  return g;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void tick(benchmark::State& bench) {
  const int segments = int(bench.range(0)), sites = int(bench.range(1));
  const FlowModel model = build(wood(segments));
  FlowState state = rest_state(model);
  FlowWork work = make_work(model);
  std::vector<Opening> openings(static_cast<std::size_t>(sites));
  std::vector<Occlusion> clips(static_cast<std::size_t>(sites));
  std::vector<OpeningFlow> flows(openings.size());
  for (int i = 0; i < sites; ++i) {
    const int segment = (i * 7 + 3) % segments;
    openings[i] = {
        .segment = segment, .s = 0.5, .kind = i % 2 ? Opening::Kind::cut : Opening::Kind::hole, .area = 1e-6};
    clips[i] = {.segment = (segment + 3) % segments, .s = 0.3, .cover = i % 3 ? 1.0 : 0.5};
  }
  double best = 1e9;
  for (auto _ : bench) {
    const double start = seconds_now();
    for (int i = 0; i < 100; ++i)
      benchmark::DoNotOptimize(advance(model, {.openings = openings, .clips = clips}, flows, state, work));
    best = std::min(best, (seconds_now() - start) / 100);
  }
  bench.counters["us"] = 1e6 * best;
  bench.counters["cells"] = double(model.cells.size());
  bench.counters["entries"] = double(model.plan.later.size());
}
BENCHMARK(tick)
    ->Args({10, 0})
    ->Args({200, 0})
    ->Args({1000, 0})
    ->Args({10, 4})
    ->Args({200, 8})
    ->Args({1000, 8})
    ->Args({200, 64})
    ->Iterations(60)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
