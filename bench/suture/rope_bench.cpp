// A thread of ours beside the rope of a public engine: Debian's Bullet (libbullet-dev), whose soft bodies hold chains
// of links. As many nodes, the same length and mass, hanging from one end at a tick of 1 ms; and what either is
// stretched by when its lower end is pulled at with 5 N.
//
//   build/release/bench/suture/suture_bench --benchmark_filter=rope
//
// Bullet's rope has no bending, twist or contact with itself here, and is stretched by what its iterations leave: more
// of them make it stiffer. Counters: stretched_percent at 5 N, beside what the thread's own stiffness gives
// (law_percent).
#include <algorithm>
#include <memory>
#include <vector>

#include <benchmark/benchmark.h>

#ifdef TROCAR_BULLET
#include <BulletSoftBody/btSoftBody.h>
#endif

#include "../../tests/suture/thread/tying.hpp"

namespace {

using namespace trocar;
using namespace trocar::suture;
using namespace trocar::suture::test;

constexpr double kRopeLength = 0.15, kRopePull = 5, kRopeTick = 1e-3;  // [m], [N], [s]
constexpr int kSettling = 4000;                                        // ticks

const ThreadStuff& rope_stuff() { return find_thread("3-0", "PDS")->stuff; }

TyingSetup rope_setup() { return {.stuff = rope_stuff(), .tension = 2, .most_solves = 6}; }

/// At rest it sleeps (`awake` 0), unless its holder trembles by a hundredth of a micron.
void rope_ours(benchmark::State& state) {
  Tying rig(rope_setup());
  rig.s = laid(rig.m, std::vector<Vec3d>{{0, 0, 0}, {0, 0, -kRopeLength}});
  take_hold(rig.m, rig.s, 0, 0);
  rig.holds[0] = {};
  const double tremor = 1e-8 * double(state.range(0));
  for (int k = 0; k < kSettling; ++k) rig.tick();
  long ticks = 0;
  const long before = rig.solves;
  for (auto _ : state) rig.holds[0].x.x = ++ticks % 2 == 0 ? 0 : tremor, rig.tick();
  state.counters["nodes"] = rig.m.nodes;
  state.counters["solves_a_tick"] = double(rig.solves - before) / double(ticks);
  state.counters["law_percent"] = 100 * kRopePull / rope_stuff().stretch;
}
BENCHMARK(rope_ours)->ArgName("awake")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond);

#ifdef TROCAR_BULLET
/// Hanging straight down from its first node, stepped as Bullet steps soft bodies.
class BulletRope {
 public:
  BulletRope(int nodes, int iterations) {
    m_world.m_gravity.setValue(0, 0, btScalar(-9.81));
    m_world.m_sparsesdf.Initialize();
    const double spacing = kRopeLength / (nodes - 1);
    std::vector<btVector3> places;
    std::vector<btScalar> masses(std::size_t(nodes), btScalar(rope_stuff().mass * spacing));
    masses[0] = 0;  // held
    for (int i = 0; i < nodes; ++i) places.emplace_back(btScalar(0), btScalar(0), btScalar(-spacing * i));
    m_soft = std::make_unique<btSoftBody>(&m_world, nodes, places.data(), masses.data());
    for (int i = 0; i + 1 < nodes; ++i) m_soft->appendLink(i, i + 1);
    m_soft->m_cfg.piterations = iterations;
    m_soft->m_cfg.collisions = 0;
    m_soft->updateLinkConstants();
  }
  void tick(double pull) {
    if (pull > 0) m_soft->addForce(btVector3(0, 0, btScalar(-pull)), last());
    m_soft->predictMotion(btScalar(kRopeTick));
    m_soft->solveConstraints();
    m_soft->integrateMotion();
  }
  double length() const { return -double(m_soft->m_nodes[last()].m_x.z()); }

 private:
  btSoftBodyWorldInfo m_world;
  std::unique_ptr<btSoftBody> m_soft;

  int last() const { return m_soft->m_nodes.size() - 1; }
};

void rope_bullet(benchmark::State& state) {
  const int nodes = Tying(rope_setup()).m.nodes, iterations = int(state.range(0));
  BulletRope rope(nodes, iterations);
  for (int i = 0; i < 200; ++i) rope.tick(0);
  for (auto _ : state) rope.tick(0);
  BulletRope pulled(nodes, iterations);
  const int settling = std::max(100, kSettling / iterations);
  for (int i = 0; i < settling; ++i) pulled.tick(kRopePull);
  state.counters["nodes"] = nodes;
  state.counters["stretched_percent"] = 100 * (pulled.length() / kRopeLength - 1);
}
BENCHMARK(rope_bullet)->ArgName("iterations")->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);
#endif

}  // namespace
