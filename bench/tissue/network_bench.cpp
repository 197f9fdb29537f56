// What a spring costs: ns per spring and sub-step of the network, by body size, mesh and instruction set, and the same
// mesh as a Bullet soft body in the same run ("times_ours": how many times longer Bullet takes per link and iteration).
// The minimum over all rounds is what is reported: other work on the machine only ever adds.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>

#include <benchmark/benchmark.h>

#include <trocar/core/parallel.hpp>
#include <trocar/tissue/network/lattice_springs.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/strand/strand.hpp>

#ifdef TROCAR_BULLET
#include <BulletSoftBody/btSoftBody.h>
#endif

namespace {

using namespace trocar;
using namespace trocar::tissue;

/// A cube of n^3 nodes joined by the edges of six tetrahedra a cell: about seven springs a node.
NetworkDescription tetrahedral_cube(int n) {
  NetworkDescription d;
  const double h = 0.005;
  const auto id = [n](int i, int j, int k) { return i + n * (j + n * k); };
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) d.positions.push_back({i * h, j * h, k * h});
  const int step[7][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        for (const auto& s : step) {
          if (i + s[0] >= n || j + s[1] >= n || k + s[2] >= n) continue;
          const int a = id(i, j, k), b = id(i + s[0], j + s[1], k + s[2]);
          d.springs.push_back({.a = a,
                               .b = b,
                               .rest_length = length(d.positions[b] - d.positions[a]),
                               .k = 10,
                               .p1 = 2,
                               .p2 = 20,
                               .cap = 0.3,
                               .damping = 0.005});
        }
  d.mass.assign(d.positions.size(), 1050 * h * h * h);
  d.fixed.assign(d.positions.size(), kFree);
  for (int i = 0; i < n * n; ++i) d.fixed[i] = kHeld;
  d.gravity = {0, 0, -9.81};
  return d;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Fastest of `rounds` calls [s].
template <class F>
double fastest(int rounds, F&& call) {
  double best = 1e9;
  for (int i = 0; i < rounds; ++i) {
    const double start = seconds_now();
    call();
    best = std::min(best, seconds_now() - start);
  }
  return best;
}

struct Body {
  NetworkModel model;
  NetworkState state;
  NetworkWork work;
  explicit Body(const NetworkDescription& d, int threads = 1)
      : model(build(d, 1e-3)), state(rest_state(model)), work(make_work(model, threads)) {
    for (int i = 0; i < 20; ++i) advance(model, {}, {}, state, work);
  }
  double ns_per_spring(double seconds) const { return 1e9 * seconds / (double(model.springs) * model.substeps); }
};

void network(benchmark::State& bench, const std::string& simd, int n, int threads) {
  const std::string before = simd_name();
  if (!set_simd(simd)) {
    bench.SkipWithError("this machine does not run it");
    return;
  }
  Body body(tetrahedral_cube(n), threads);
  core::ThreadPool pool(threads);
  double best = 1e9;
  for (auto _ : bench) {
    const double start = seconds_now();
    advance(body.model, {}, {}, body.state, body.work, threads > 1 ? &pool : nullptr);
    best = std::min(best, seconds_now() - start);
  }
  bench.counters["nodes"] = body.model.nodes;
  bench.counters["springs"] = body.model.springs;
  bench.counters["substeps"] = body.model.substeps;
  bench.counters["ns_per_spring"] = body.ns_per_spring(best);
  set_simd(before);
}

/// A liver-like lattice with its cells protected, as organs are compiled: everything a tick costs.
void organ(benchmark::State& bench, int cells) {
  const BoxLattice box = box_lattice(cells, cells, cells, 0.005);
  LatticeNetwork lattice = lattice_network(
      box.corners, box.cells, {},
      {.youngs_modulus = 5.4e3, .density = 1060, .p1 = 2, .p2 = 100, .cap = 0.35, .damping_time = 4e-4});
  for (int i = 0; i < (cells + 1) * (cells + 1); ++i) lattice.network.fixed[i] = kHeld;
  Body body(lattice.network);
  double best = 1e9;
  for (auto _ : bench) {
    const double start = seconds_now();
    advance(body.model, {}, {}, body.state, body.work);
    best = std::min(best, seconds_now() - start);
  }
  bench.counters["nodes"] = body.model.nodes;
  bench.counters["springs"] = body.model.springs;
  bench.counters["substeps"] = body.model.substeps;
  bench.counters["us_per_tick"] = 1e6 * best;
  bench.counters["ns_per_spring"] = body.ns_per_spring(best);
}

void strand(benchmark::State& bench) {
  const int n = int(bench.range(0));
  StrandDescription d;
  for (int i = 0; i < n; ++i) d.positions.push_back({0.1 * i / (n - 1), 0.01 * std::sin(3.0 * i / n), 0});
  d.radius.assign(n - 1, 0.003);
  d.youngs_modulus = 60e3;
  d.law = {4, 40, 0.8};
  d.density = 1050;
  d.foundation.assign(n, 0.4);
  d.gravity = {0, 0, -9.81};
  d.prescribed.assign(n, 0);
  d.prescribed[0] = d.prescribed[1] = 1;
  const StrandModel m = build(d, 1e-3);
  StrandState s = rest_state(m);
  StrandWork w = make_work(m);
  std::vector<StrandReaction> ends(2);
  for (auto _ : bench) advance(m, {}, {}, ends, {}, s, w);
}

#ifdef TROCAR_BULLET
void beside_bullet(benchmark::State& bench) {
  const NetworkDescription d = tetrahedral_cube(int(bench.range(0)));
  Body body(d);

  btSoftBodyWorldInfo info;
  info.m_gravity.setValue(0, 0, btScalar(-9.81));
  info.m_sparsesdf.Initialize();
  std::vector<btVector3> x;
  std::vector<btScalar> mass;
  for (std::size_t i = 0; i < d.positions.size(); ++i) {
    x.emplace_back(btScalar(d.positions[i].x), btScalar(d.positions[i].y), btScalar(d.positions[i].z));
    mass.push_back(d.fixed[i] == kHeld ? btScalar(0) : btScalar(d.mass[i]));
  }
  btSoftBody soft(&info, int(x.size()), x.data(), mass.data());
  for (const auto& e : d.springs) soft.appendLink(e.a, e.b);
  soft.m_cfg.piterations = 1;
  soft.m_cfg.collisions = 0;
  soft.updateLinkConstants();

  double ours = 1e9, links = 1e9, step = 1e9;
  for (auto _ : bench) {  // turn by turn, so that both see the same machine
    ours = std::min(ours, fastest(5, [&] { advance(body.model, {}, {}, body.state, body.work); }));
    step = std::min(step, fastest(3, [&] {
                      soft.predictMotion(btScalar(1e-3));
                      soft.solveConstraints();
                      soft.integrateMotion();
                    }));
    links = std::min(links, fastest(5, [&] { btSoftBody::PSolve_Links(&soft, 1, 0); }));
  }
  const double per_link = 1e9 * links / double(d.springs.size());
  const double per_step = 1e9 * step / double(d.springs.size());
  bench.counters["ours_ns"] = body.ns_per_spring(ours);
  bench.counters["bullet_link_ns"] = per_link;
  bench.counters["bullet_step_ns"] = per_step;
  bench.counters["times_ours"] = per_link / body.ns_per_spring(ours);
  bench.counters["step_times_ours"] = per_step / body.ns_per_spring(ours);
}
BENCHMARK(beside_bullet)->Arg(10)->Arg(22)->Arg(46)->Iterations(30)->Unit(benchmark::kMicrosecond);
#endif

/// Bodies of 1,000, 10,648 and 97,336 nodes in turns: does a spring of a large body cost more than one of a small one?
void sizes(benchmark::State& bench) {
  Body small(tetrahedral_cube(10)), middle(tetrahedral_cube(22)), large(tetrahedral_cube(46));
  Body* bodies[] = {&small, &middle, &large};
  double best[] = {1e9, 1e9, 1e9};
  for (auto _ : bench)
    for (int i = 0; i < 3; ++i)
      best[i] = std::min(best[i], fastest(i < 2 ? 10 : 1, [&] {
                           advance(bodies[i]->model, {}, {}, bodies[i]->state, bodies[i]->work);
                         }));
  double ns[3];
  for (int i = 0; i < 3; ++i) ns[i] = bodies[i]->ns_per_spring(best[i]);
  bench.counters["ns_1000"] = ns[0];
  bench.counters["ns_10648"] = ns[1];
  bench.counters["ns_97336"] = ns[2];
  bench.counters["largest_to_middle"] = ns[2] / ns[1];
  bench.counters["smallest_to_middle"] = ns[0] / ns[1];
}
BENCHMARK(sizes)->Iterations(30)->Unit(benchmark::kMillisecond);

/// One and two threads in turns at 97,336 nodes.
void second_thread(benchmark::State& bench) {
  Body body(tetrahedral_cube(46), 2);
  core::ThreadPool pool(2);
  double one = 1e9, two = 1e9;
  for (auto _ : bench) {
    one = std::min(one, fastest(1, [&] { advance(body.model, {}, {}, body.state, body.work); }));
    two = std::min(two, fastest(1, [&] { advance(body.model, {}, {}, body.state, body.work, &pool); }));
  }
  bench.counters["ns_one"] = body.ns_per_spring(one);
  bench.counters["ns_two"] = body.ns_per_spring(two);
  bench.counters["gain"] = one / two;
}
BENCHMARK(second_thread)->Iterations(30)->UseRealTime()->Unit(benchmark::kMillisecond);

const int registered = [] {
  for (const char* simd : {"generic", "sse2", "avx2", "avx512"}) {
    for (int n : {10, 22, 46}) {
      benchmark::RegisterBenchmark(("network/" + std::string(simd) + "/" + std::to_string(n * n * n)).c_str(),
                                   [simd, n](benchmark::State& s) { network(s, simd, n, 1); })
          ->Unit(benchmark::kMicrosecond);
    }
  }
  for (int n : {22, 46}) {
    for (int threads : {1, 2}) {
      const std::string name = "network/best/" + std::to_string(n * n * n) + "/threads:" + std::to_string(threads);
      benchmark::RegisterBenchmark(name.c_str(),
                                   [n, threads](benchmark::State& s) { network(s, simd_name(), n, threads); })
          ->UseRealTime()
          ->Unit(benchmark::kMicrosecond);
    }
  }
  return 0;
}();

}  // namespace

BENCHMARK_CAPTURE(organ, cells12, 12)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(organ, cells21, 21)->Unit(benchmark::kMicrosecond);
BENCHMARK(strand)->Arg(20)->Arg(40)->Arg(80)->Unit(benchmark::kMicrosecond);
