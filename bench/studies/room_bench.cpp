// What an operating room costs: a step of an arm along a way, a look at what is near, a whole step of both arms.
#include <cmath>

#include <benchmark/benchmark.h>

#include <trocar/scene/files/library.hpp>
#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/studies/operating_room/motion.hpp>
#include <trocar/studies/operating_room/ports.hpp>

namespace trocar::studies {
namespace {

const RoomModel& telemanipulated() {
  static const RoomModel model(scene::read_room(scene::found_scenes_folder().value() / "rooms/telemanipulated.json"));
  return model;
}

/// A tip that goes round in a circle of 20 mm, a millimetre a step.
void arm_step(benchmark::State& bench, const char* name) {
  const RoomModel& m = telemanipulated();
  const int arm = m.arm(name);
  RoomPose pose = m.start();
  const Vec3d middle = m.tip(pose, arm).p;
  int k = 0;
  std::int64_t reached = 0;
  for (auto _ : bench) {
    const double angle = 0.05 * k++;
    const Vec3d tip = middle + Vec3d{0.02 * std::sin(angle), 0.02 * (1 - std::cos(angle)), 0};
    reached += m.lead(pose, arm, {.tip = tip}).reached;
    benchmark::DoNotOptimize(pose.u.data());
  }
  bench.counters["reached"] = double(reached) / double(bench.iterations());
}
BENCHMARK_CAPTURE(arm_step, closed_loop_redundant, "left")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(arm_step, serial_coupled_wrist, "right")->Unit(benchmark::kMicrosecond);

void clearance_of_all(benchmark::State& bench) {
  const RoomModel& m = telemanipulated();
  const RoomPose pose = m.start();
  for (auto _ : bench) benchmark::DoNotOptimize(m.nearest(pose).size());
}
BENCHMARK(clearance_of_all)->Unit(benchmark::kMicrosecond);

void programme_step(benchmark::State& bench) {
  const RoomModel& m = telemanipulated();
  const RoomMotion motion = motion_of(
      m, scene::read_programme(scene::found_scenes_folder().value() / "rooms/programmes/triangle.json", m.room()));
  std::int64_t steps = 0;
  for (auto _ : bench) steps += go_through(m, motion, {}).count;
  bench.SetItemsProcessed(steps);
}
BENCHMARK(programme_step)->Unit(benchmark::kMillisecond);

void plan(benchmark::State& bench, bool set_up) {
  const RoomModel& m = telemanipulated();
  PortPlanOptions o;
  o.low = m.room().targets[0].low, o.high = m.room().targets[0].high;
  o.scope = "umbilical";
  o.set_up = set_up;
  for (auto _ : bench) benchmark::DoNotOptimize(plan_ports(m, o).pairs.size());
}
BENCHMARK_CAPTURE(plan, bases_fixed, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(plan, bases_turned, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trocar::studies
