// What a thread costs: us a tick and a solve, and solves a tick, of 150 mm of 3-0 PDS in nodes two diameters apart.
//
//   build/release/bench/suture/suture_bench
//
// No rod engine is among Debian's packages; Bullet's rope stands beside it in rope_bench.cpp.
#include <vector>

#include <benchmark/benchmark.h>

#include "../../tests/suture/thread/tying.hpp"

namespace {

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

TyingSetup setup_of(int most_solves) {
  return {.stuff = find_thread("3-0", "PDS")->stuff, .tension = 2, .most_solves = most_solves};
}

void report(benchmark::State& state, const Tying& rig, long solves, long ticks) {
  state.counters["nodes"] = rig.m.nodes;
  state.counters["solves_a_tick"] = double(solves) / double(ticks);
  state.counters["coupled"] = rig.last.coupled;
  state.counters["contacts"] = rig.last.contacts;
  if (solves > 0)
    state.counters["s_a_solve"] =
        benchmark::Counter(double(solves), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void hanging(benchmark::State& state) {
  Tying rig(setup_of(6));
  rig.s = laid(rig.m, std::vector<Vec3d>{{0, 0, 0}, {0.15, 0, 0}});
  take_hold(rig.m, rig.s, 0, 0);
  rig.holds[0] = {};
  long ticks = 0;
  const long before = rig.solves;
  for (auto _ : state) rig.tick(), ++ticks;
  report(state, rig, rig.solves - before, ticks);
}

/// Both tails of a knot of `throws` are drawn apart and back, at the speed of hands.
void pulled(benchmark::State& state) {
  Tying rig(setup_of(6));
  rig.begin({1, 1});
  for (int k = 1; k < int(state.range(0)); ++k) rig.pull(), rig.lay_next({1, k % 2 == 1 ? -1 : 1});
  rig.pull();
  const double speed = 1e-3 * double(state.range(1));
  long ticks = 0;
  const long before = rig.solves;
  for (auto _ : state) {
    const double way = (ticks / 5 % 2 == 0 ? -1 : 1) * rig.sign_a * speed * rig.m.tick;
    rig.holds[0].x.x += way, rig.holds[1].x.x -= way;
    rig.tick(), ++ticks;
  }
  report(state, rig, rig.solves - before, ticks);
}

void asleep(benchmark::State& state) {
  Tying rig(setup_of(6));
  const Throw throws_[] = {{1, 1}, {1, -1}, {1, 1}};
  rig.tie_throws(throws_);
  for (int k = 0; k < 20000 && !rig.last.asleep; ++k) rig.tick();
  long ticks = 0;
  const long before = rig.solves;
  for (auto _ : state) rig.tick(), ++ticks;
  report(state, rig, rig.solves - before, ticks);
}

BENCHMARK(hanging)->Unit(benchmark::kMicrosecond);
BENCHMARK(pulled)->ArgsProduct({{1, 2, 3}, {0, 20, 50, 100}})->Unit(benchmark::kMicrosecond);
BENCHMARK(asleep)->Unit(benchmark::kMicrosecond);

}  // namespace
