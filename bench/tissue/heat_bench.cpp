// What heat costs a tick: a hook at 40 W in one place or wandering, what it has warmed in ten seconds, and readings for
// skins. Mean and percentiles are of single ticks, in the thread's own time.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/tissue/heat/electrosurgery.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

namespace {

using namespace trocar;
using namespace trocar::tissue;

void fill_below(const void*, BodyId, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
  for (int c = 0; c < kBrickCells; ++c) tissue[c] = corner.z + (c / (kBrickSide * kBrickSide) + 0.5) * cell < 0;
}

double now_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * double(t.tv_sec) + 1e-3 * double(t.tv_nsec);
}

struct Hook {
  HeatModel m = build(HeatDescription{});
  HeatState s = cold(m);
  HeatWork w = make_work(m);
  ElectrodeDescription e;
  ElectrodeState es;
  GeneratorPanel panel;
  int t = 0;
  std::uint32_t flags = 0;

  /// @param speed  along a circle of 10 mm [m/s]
  void tick(double speed) {
    const double angle = speed * 1e-3 * t++ / 5e-3;
    const Vec3d at{5e-3 * std::cos(angle), 5e-3 * std::sin(angle), -0.1e-3};
    const TissueShape shape{nullptr, fill_below};
    const Discharge d = energise(e, panel, {.yellow = false, .blue = true},
                                 {.body = BodyId::strand(0), .a = at, .b = at}, m, shape, s, w, es);
    flags |= advance(m, d.span(), shape, s, w).flags;
  }
};

/// 40 W for ten seconds, then 4000 more ticks that are measured. Argument: speed in mm/s.
void heat_tick(benchmark::State& state) {
  Hook h;
  const double speed = 1e-3 * double(state.range(0));
  for (int t = 0; t < 10000; ++t) h.tick(speed);
  std::vector<double> us;
  for (auto _ : state) {
    const double t0 = now_us();
    h.tick(speed);
    us.push_back(now_us() - t0);
    state.SetIterationTime(us.back() * 1e-6);
  }
  std::sort(us.begin(), us.end());
  state.counters["p50_us"] = us[us.size() / 2];
  state.counters["p99_us"] = us[us.size() * 99 / 100];
  state.counters["awake"] = bricks_awake(h.s);
  state.counters["used"] = bricks_used(h.s);
  if (h.flags) state.SkipWithError("bricks are full");
}
BENCHMARK(heat_tick)->Arg(0)->Arg(2)->Arg(10)->UseManualTime()->Iterations(4000)->Unit(benchmark::kMicrosecond);

void heat_brick(benchmark::State& state) {
  Hook h;
  for (int t = 0; t < 10000; ++t) h.tick(2e-3);
  const TissueShape shape{nullptr, fill_below};
  double bricks = 0, us = 0;
  for (auto _ : state) {
    const double t0 = now_us();
    bricks += advance(h.m, {}, shape, h.s, h.w).worked;
    us += now_us() - t0;
  }
  state.counters["us_per_brick"] = us / bricks;
}
BENCHMARK(heat_brick)->Iterations(2000)->Unit(benchmark::kMicrosecond);

void heat_reading(benchmark::State& state) {
  Hook h;
  for (int t = 0; t < 10000; ++t) h.tick(2e-3);
  double x = 0;
  Vec3f sum{};
  for (auto _ : state) {
    x = x < 6e-3 ? x + 1e-5 : -6e-3;
    sum += colour(look(reading(h.m, h.s, BodyId::strand(0), {x, 0.3 * x, -0.5e-3})), {0.8f, 0.4f, 0.4f});
  }
  benchmark::DoNotOptimize(sum);
}
BENCHMARK(heat_reading)->Unit(benchmark::kNanosecond);

void state_hash(benchmark::State& state) {
  Hook h;
  for (int t = 0; t < 10000; ++t) h.tick(2e-3);
  for (auto _ : state) {
    core::Hasher hasher;
    add_to_hash(hasher, h.s);
    benchmark::DoNotOptimize(hasher.value());
  }
}
BENCHMARK(state_hash)->Unit(benchmark::kMicrosecond);

}  // namespace
