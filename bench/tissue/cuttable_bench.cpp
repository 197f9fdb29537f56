// What a body of tetrahedra costs that can be cut: a tick, a cut through half of it with everything that the next tick
// needs, and its volume force; beside it what a spring of the same body costs as a network.
#include <algorithm>
#include <chrono>

#include <benchmark/benchmark.h>

#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/tets/cuttable.hpp>

namespace {

using namespace trocar;
using namespace trocar::tissue;

constexpr double kCell = 0.004;

/// n x n x n cubes of six tetrahedra each, held at the top: 20 gives 9261 nodes and 48,000 cells.
CuttableDescription description(int n, double poisson = 0.25) {
  CuttableDescription d;
  const BoxLattice box = box_lattice(n, n, n, kCell);
  d.points = box.corners;
  constexpr int kPaths[6][2] = {{1, 3}, {5, 1}, {3, 2}, {2, 6}, {4, 5}, {6, 4}};
  for (const auto& c : box.cells)
    for (const auto& p : kPaths) d.cells.push_back({c[0], c[std::size_t(p[0])], c[std::size_t(p[1])], c[7]});
  d.material = {.youngs_modulus = 5.4e3,
                .poisson = poisson,
                .density = 1060,
                .p1 = 2,
                .p2 = 100,
                .cap = 0.2,
                .damping_time = 1e-3};
  d.gravity = {0, 0, -9.81};
  for (const Vec3d& p : d.points) d.fixed.push_back(p.z > n * kCell - 1e-9 ? kHeld : kFree);
  d.spare_nodes = 4000;
  return d;
}
CuttableModel cube(int n) { return build(description(n), 1e-3); }

geometry::Blade half_through(int n) {
  const double side = n * kCell;
  geometry::Blade b;
  b.corners = 4;
  const double z = 0.513 * side;
  b.corner = {Vec3d{-1, -0.001, z}, Vec3d{0.5 * side, -0.001, z}, Vec3d{0.5 * side, side + 0.001, z},
              Vec3d{-1, side + 0.001, z}};
  return b;
}

void cuttable_tick(benchmark::State& state) {
  const CuttableModel model = cube(int(state.range(0)));
  CuttableState body = rest_state(model);
  CuttableWork work = make_work(model);
  for (auto _ : state) benchmark::DoNotOptimize(advance(model, {}, {}, body, work));
  state.counters["nodes"] = model.own_nodes;
  state.counters["substeps"] = model.substeps;
}
BENCHMARK(cuttable_tick)->Arg(10)->Arg(20)->Unit(benchmark::kMicrosecond);

void cuttable_cut(benchmark::State& state) {
  const int n = int(state.range(0));
  const CuttableModel model = cube(n);
  const geometry::Blade blade = half_through(n);
  CuttableWork work = make_work(model);
  int parted = 0;
  for (auto _ : state) {
    state.PauseTiming();
    CuttableState body = rest_state(model);
    work.made_for = ~0u;
    advance(model, {}, {}, body, work);
    state.ResumeTiming();
    parted = cut(model, blade, body, work).parted;
    benchmark::ClobberMemory();
  }
  state.counters["faces"] = parted;
  state.counters["at_once"] = work.made_for == 1;
}
BENCHMARK(cuttable_cut)->Arg(10)->Arg(20)->Iterations(20)->Unit(benchmark::kMicrosecond);

/// Notes how long a call took if it was the fastest so far [s].
template <class F>
void note_fastest(double& best, F&& call) {
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto start = now();
  call();
  best = std::min(best, std::chrono::duration<double>(now() - start).count());
}

/// In turns: the springs of a body as a network, a tick of it as a body that can be cut, an impulse of its volume
/// force. The fastest of each counts.
void cuttable_beside_network(benchmark::State& state) {
  const CuttableDescription d = description(int(state.range(0)), 0.35);
  TetMaterial springs_alone = d.material;
  springs_alone.poisson = 0.25;
  TetNetwork tets = tet_network(d.points, d.cells, springs_alone, {});
  tets.network.fixed = d.fixed;
  const NetworkModel network = build(tets.network, 1e-3);
  NetworkState net = rest_state(network);
  NetworkWork net_work = make_work(network);
  const CuttableModel model = build(d, 1e-3);
  CuttableState body = rest_state(model);
  CuttableWork work = make_work(model);
  const double impulse = model.tick / model.bulk.impulses;
  double spring = 1e9, tick = 1e9, volume = 1e9;
  for (auto _ : state) {
    note_fastest(spring, [&] { advance(network, {}, {}, net, net_work); });
    note_fastest(tick, [&] { advance(model, {}, {}, body, work); });
    note_fastest(volume,
                 [&] { push_volumes(work.volume_cells, {}, model.bulk, impulse, model.dt, body.nodes, work.volume); });
  }
  const double springs = network.springs;
  state.counters["impulses"] = model.bulk.impulses;
  state.counters["volume_ns_per_cell"] = 1e9 * volume / double(d.cells.size());
  state.counters["spring_ns"] = 1e9 * spring / (springs * network.substeps);
  state.counters["cuttable_ns_per_spring"] = 1e9 * tick / (springs * model.substeps);
  state.counters["times_spring"] = tick * network.substeps / (spring * model.substeps);
}
BENCHMARK(cuttable_beside_network)->Arg(10)->Arg(20)->Iterations(400)->Unit(benchmark::kMicrosecond);

}  // namespace
