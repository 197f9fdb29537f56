// What a tick of an elastostatic organ costs, on one thread: 1, 5 and 20 places held where a hand has them, about 1,000
// nodes on its surface, the whole of it displaced. "cold": nothing of the compliance is in the caches, as in a tick
// between others. Beside it, in the same run, the least that it can take: reading the columns of these places once.
//
//   tissue_bench --benchmark_filter=static_
#include <chrono>
#include <cstring>
#include <numeric>

#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/tissue/elastostatic/condense.hpp>
#include <trocar/tissue/elastostatic/elastostatic.hpp>

#include "lattice_organ.hpp"

namespace {

using namespace trocar;
using namespace trocar::tissue;

struct TickOrgan {
  ElastostaticModel model;
  std::vector<NodeState> rows;

  TickOrgan() {
    const LatticeOrgan organ(17, 17, 12);
    const std::vector<double> compliance = condense(organ.k, organ.kept).compliance;
    std::vector<int> row(organ.k.points.size());
    std::iota(row.begin(), row.end(), 0);
    const std::vector<float> columns(compliance.begin(), compliance.end());
    model = make_elastostatic({organ.k.points, {}, row, {}, {}}, organ.kept, columns, {}, 1e-3);
    rows.resize(row.size());
  }
};
const TickOrgan& tick_organ() {
  static const TickOrgan made;
  return made;
}

/// Loads as grips make them: springs in all directions.
struct Grips {
  std::vector<NodeLoad> loads;
  std::vector<std::int32_t> point;
  std::vector<Vec3f> reactions;

  Grips(const ElastostaticModel& m, int count, int first) {
    for (int i = 0; i < count; ++i) {
      const std::size_t slot = std::size_t((first + 47 * i) % m.nodes());
      NodeLoad load;
      load.node = m.kept[slot];
      load.k = 2000;
      load.x0 = vec_cast<float>(m.rest[slot] + Vec3d{0, 0, 0.001});
      loads.push_back(load);
      point.push_back(i);
    }
    reactions.resize(loads.size());
  }
  void move(float by) {
    for (NodeLoad& load : loads) load.x0.z += by;
  }
};

/// An organ whose grips go to and fro.
struct Gripped {
  const TickOrgan& organ = tick_organ();
  std::vector<NodeState> rows = organ.rows;
  ElastostaticState state = rest_state(organ.model);
  ElastostaticWork work = make_work(organ.model, 64);
  Grips grips;
  float by = 1e-5f;

  explicit Gripped(const benchmark::State& bench) : grips(organ.model, int(bench.range(0)), 3) {}
  void tick() {
    grips.move(by = -by);
    advance(organ.model, grips.loads, grips.point, grips.reactions, {}, state, rows, work);
  }
};

/// Makes the caches hold something else.
void forget_everything() {
  static std::vector<char> other(std::size_t(96) << 20);
  for (std::size_t i = 0; i < other.size(); i += 64) ++other[i];
  benchmark::ClobberMemory();
}

template <class Work>
void timed_cold(benchmark::State& bench, Work&& work) {
  for (auto _ : bench) {
    forget_everything();
    const auto began = std::chrono::steady_clock::now();
    work();
    bench.SetIterationTime(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
  }
  bench.counters["surface"] = tick_organ().model.nodes();
}

void static_tick_cold(benchmark::State& bench) {
  Gripped gripped(bench);
  timed_cold(bench, [&] { gripped.tick(); });
}
BENCHMARK(static_tick_cold)->Arg(1)->Arg(5)->Arg(20)->UseManualTime()->Iterations(100)->Unit(benchmark::kMicrosecond);

/// The columns of the same places read once, three at a time, as a core follows several streams faster than one.
void static_floor_cold(benchmark::State& bench) {
  const ElastostaticModel& m = tick_organ().model;
  const int count = int(bench.range(0));
  std::uint32_t all = 0;
  const auto bits_of = [](const float* at) {
    std::uint32_t bits;
    std::memcpy(&bits, at, sizeof bits);
    return bits;
  };
  timed_cold(bench, [&] {
    for (int i = 0; i < count; ++i) {
      const int slot = (3 + 47 * i) % m.nodes();
      const float *x = m.view().column(slot, 0), *y = m.view().column(slot, 1), *z = m.view().column(slot, 2);
      for (int k = 0; k < m.stride; ++k) all ^= bits_of(x + k) ^ bits_of(y + k) ^ bits_of(z + k);
    }
    benchmark::DoNotOptimize(all);
  });
}
BENCHMARK(static_floor_cold)->Arg(1)->Arg(5)->Arg(20)->UseManualTime()->Iterations(100)->Unit(benchmark::kMicrosecond);

void static_tick_hot(benchmark::State& bench) {
  Gripped gripped(bench);
  for (auto _ : bench) gripped.tick();
}
BENCHMARK(static_tick_hot)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);

/// The load case alone. @param sets  of places, that take turns: with one the factor stays as it is
void solve_cases(benchmark::State& bench, int sets) {
  const ElastostaticModel& m = tick_organ().model;
  const int count = int(bench.range(0));
  std::vector<std::vector<PointTerm>> terms(static_cast<std::size_t>(sets));
  std::vector<LoadPoint> points;
  for (int i = 0; i < count; ++i) {
    for (int s = 0; s < sets; ++s) terms[std::size_t(s)].push_back({(3 + 5 * s + 47 * i) % m.nodes(), 1.0f});
    LoadPoint p;
    p.first = i, p.count = 1, p.give = 1.0 / 2000;
    points.push_back(p);
  }
  LoadCaseWork work = make_load_case_work(count);
  const std::vector<Vec3d> now(std::size_t(count), Vec3d{0, 0, 0});
  int turn = 0;
  for (auto _ : bench) {
    ++turn;
    for (LoadPoint& p : points) p.want = {0, 0, 1e-3 + 1e-6 * (turn % 7)};
    benchmark::DoNotOptimize(solve(m.view(), 1, terms[std::size_t(turn % sets)], now, points, work));
  }
}
void static_new_set(benchmark::State& bench) { solve_cases(bench, 2); }
void static_moved_set(benchmark::State& bench) { solve_cases(bench, 1); }
BENCHMARK(static_new_set)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);
BENCHMARK(static_moved_set)->Arg(1)->Arg(5)->Arg(20)->Unit(benchmark::kMicrosecond);

}  // namespace
