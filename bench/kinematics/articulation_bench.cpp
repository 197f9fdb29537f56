// What an instrument that bends costs in a tick: the chain's place, and four rounds of reaching for a redundant one.
#include <benchmark/benchmark.h>

#include <trocar/kinematics/articulation.hpp>
#include <trocar/numerics/portable.hpp>

using namespace trocar;
using namespace trocar::kinematics;

namespace {

Articulation flexible() {
  Articulation a;
  a.joints = 4;
  for (int v = 0; v < 4; ++v)
    for (int across = 0; across < 2; ++across)
      a.hinge[a.hinges++] = {v > 0 && across == 0 ? 0.005 : 0.0, 0.25, across, across};
  a.hinge[a.hinges++] = {0.005, 1, 2, 0};
  a.hinge[a.hinges++] = {0.009, 1, 3, 1};
  for (int j = 0; j < 4; ++j) a.low[j] = -1.4, a.high[j] = 1.4;
  return a;
}

void place(benchmark::State& state, const Articulation& a) {
  double t = 0;
  for (auto _ : state) {
    t += 1e-3;
    benchmark::DoNotOptimize(chain(a, {0.07, 0.035, 0}, {0.2, -0.3, 0, 0.13}, {{0.3, t - int(t), 0.2, 0.1}}, 0.014));
  }
}
void PlaceOfAWrist(benchmark::State& state) { place(state, wrist(0.004, 0.008, 1.4, 1.4)); }
void PlaceOfAFlexibleSection(benchmark::State& state) { place(state, flexible()); }
BENCHMARK(PlaceOfAWrist);
BENCHMARK(PlaceOfAFlexibleSection);

void ReachOfAFlexibleSection(benchmark::State& state) {
  const Articulation a = flexible();
  Arm arm{{0.2, -0.3, 0, 0.13}, {}};
  double t = 0;
  for (auto _ : state) {
    t += 1e-3;
    const TipFrame goal = led({0.07, 0.035, 0}, {0.2 + 0.1 * portable::sin(t), -0.3, 0, 0.13},
                              0.9 * portable::sin(2 * t), 0.7 * portable::sin(1.5 * t));
    arm = reach(a, {}, {0.07, 0.035, 0}, 0.014, {goal.tip, goal.rotation}, arm, 4);
    benchmark::DoNotOptimize(arm);
  }
}
BENCHMARK(ReachOfAFlexibleSection);

}  // namespace
