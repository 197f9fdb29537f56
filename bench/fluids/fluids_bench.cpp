// What a tick of all fluids costs: drops that fly, run down and fall in, a pool of 128 x 128 cells with an instrument
// in it, smoke. Drops are kept at their number by four jets. Mean and percentiles are of single ticks.
#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/fluids.hpp>

namespace {

using namespace trocar;
using namespace trocar::fluids;

FluidsDescription pelvis(int drops) {
  FluidsDescription d;
  d.pool.origin = {-0.08, -0.08, 0};
  d.droplets.capacity = std::min(65536, drops + drops / 2 + 500);
  d.droplets.film_cells = 20000;
  d.smoke.origin = {-0.1, -0.1, 0};
  return d;
}

double now_us() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * double(t.tv_sec) + 1e-3 * double(t.tv_nsec);
}

/// A slope over half of a basin, `drops` drops of which a third fly, 5 mm of fluid.
struct Pelvis {
  FluidsModel m;
  FluidsState s;
  FluidsWork w;
  std::vector<float> floor;
  Capsule tool{.a = {0.02f, 0.01f, 0.002f}, .b = {0.1f, 0.05f, 0.2f}, .radius = 0.0025f, .body = 9};
  std::vector<Outlet> openings;
  Boiled boiled{{0, 0, 0.04}, 9e-9};
  int wanted;
  core::Random random{42};

  explicit Pelvis(int drops)
      : m(build(pelvis(drops))), s(initial_state(m)), w(make_work(m)), floor(128 * 128), wanted(drops) {
    for (int j = 0; j < 128; ++j)
      for (int i = 0; i < 128; ++i) {
        floor[std::size_t(j) * 128 + i] = 1e-6f * float((i - 64) * (i - 64) + (j - 64) * (j - 64));
        pour_one(i, j, {.blood = 2'000'000, .saline = 6'000'000});
      }
    openings.resize(4);
    for (int i = 0; i < drops; ++i) add();
  }
  void pour_one(int i, int j, const Mix& mix) {
    receive(s.ledger, Source::kBled, Place::kPool, mix);
    pour(m.pool, i, j, mix, s.pool);
  }
  void add() {
    const auto at = [&] { return float(random.uniform(-0.07, 0.07)); };
    const Mix drop{.blood = 300'000 + std::int64_t(random.uniform() * 2e6)};
    const bool flies = random.uniform() < 0.35;
    if (add_drop(m.droplets, {at(), at(), flies ? 0.1f + at() : 0.06f}, {at(), at(), at()}, drop, s.droplets))
      receive(s.ledger, Source::kBled, Place::kDroplets, drop);
  }
  FluidsInput input() {
    return {.openings = openings,
            .tools = {},
            .capsules = {&tool, 1},
            .floor = floor,
            .drains = {},
            .boiled = {&boiled, 1},
            .smoke = {.coagulating = true}};
  }
  /// Everything below a slope through (0, 0, 0.06) is on it. Not part of what is measured.
  void answer() {
    const Vec3f n{0.35f, 0, 0.9367497f}, p0{0, 0, 0.05f};
    for (int k = 0; k < w.droplets.questions; ++k) {
      const int i = w.droplets.asking[k];
      const bool flies = s.droplets.body[i] < 0;
      const Vec3f p = flies ? Vec3f{w.droplets.to_x[i], w.droplets.to_y[i], w.droplets.to_z[i]}
                            : Vec3f{s.droplets.x[i], s.droplets.y[i], s.droplets.z[i]};
      const float off = dot(p - p0, n);
      w.droplets.answers[k].body = -1;
      if (p.x > 0.06f || off > 1e-3f) continue;
      const int cell =
          std::clamp(int((p.x + 0.08f) * 800), 0, 127) * 128 + std::clamp(int((p.y + 0.08f) * 800), 0, 127);
      w.droplets.answers[k] = {p - off * n, n, {0, 0, 0}, 0, cell};
    }
  }
};

void fluids_tick(benchmark::State& state) {
  Pelvis b(int(state.range(0)));
  std::vector<double> us;
  double phase = 0;
  const auto one = [&](bool kept) {
    while (b.s.droplets.count < b.wanted) b.add();
    b.tool.a.x = 0.02f + 0.02f * float(std::sin(phase += 0.01));
    const double t0 = now_us();
    begin_tick(b.m, b.input(), b.s, b.w);
    const double t1 = now_us();
    b.answer();
    const double t2 = now_us();
    finish_tick(b.m, b.input(), b.s, b.w);
    const double t3 = now_us();
    const double spent = (t1 - t0) + (t3 - t2);
    if (kept) us.push_back(spent);
    return spent * 1e-6;
  };
  for (int i = 0; i < 400; ++i) one(false);
  double asked = 0;
  for (auto _ : state) {
    state.SetIterationTime(one(true));
    asked += b.w.droplets.questions;
  }
  std::sort(us.begin(), us.end());
  state.counters["p50_us"] = us[us.size() / 2];
  state.counters["p99_us"] = us[us.size() * 99 / 100];
  state.counters["asked"] = asked / double(us.size());
  if (!audit(b.m, b.s)) state.SkipWithError("the account does not balance");
}
BENCHMARK(fluids_tick)
    ->Arg(500)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(5000)
    ->Arg(10000)
    ->Arg(20000)
    ->Arg(50000)
    ->UseManualTime()
    ->Iterations(4000)
    ->Unit(benchmark::kMicrosecond);

void pool_step(benchmark::State& state) {
  Pelvis b(0);
  const PoolInput in{.floor = b.floor, .capsules = {&b.tool, 1}, .drains = {}};
  for (auto _ : state) {
    b.s.pool.tick = 0;  // every call is a step
    advance(b.m.pool, in, b.s.pool, b.w.pool, b.s.ledger);
  }
}
BENCHMARK(pool_step)->Unit(benchmark::kMicrosecond);

void smoke_step(benchmark::State& state) {
  Pelvis b(0);
  for (auto _ : state) {
    b.s.smoke.tick = 0;
    advance(b.m.smoke, {.coagulating = true}, b.s.smoke, b.w.smoke);
  }
}
BENCHMARK(smoke_step)->Unit(benchmark::kMicrosecond);

void drop_forces(benchmark::State& state) {
  Pelvis b(int(state.range(0)));
  for (int i = 0; i < 400; ++i) {
    begin_tick(b.m, b.input(), b.s, b.w);
    b.answer();
    finish_tick(b.m, b.input(), b.s, b.w);
    while (b.s.droplets.count < b.wanted) b.add();
  }
  const DropletState before = b.s.droplets;
  for (auto _ : state) {
    state.PauseTiming();
    b.s.droplets = before;
    state.ResumeTiming();
    detail::pull_together(b.m.droplets, {false, 0, 2}, 4e-3, b.s.droplets, b.w.droplets);
  }
  state.counters["drops"] = before.count;
  state.counters["pairs"] = b.w.droplets.pair_count;
}
BENCHMARK(drop_forces)->Arg(5000)->Arg(50000)->Unit(benchmark::kMicrosecond);

}  // namespace
