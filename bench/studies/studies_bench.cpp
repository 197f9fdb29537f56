// What a study costs: samples a second on one core, a sweep of clearances.
#include <benchmark/benchmark.h>

#include <trocar/scene/files/library.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/studies/clearance.hpp>
#include <trocar/studies/tolerance.hpp>

namespace trocar::studies {
namespace {

kinematics::Mechanism shipped(const char* name) {
  return kinematics::build(
      scene::read_mechanism(scene::found_scenes_folder().value() / "mechanisms" / (std::string(name) + ".json")));
}

/// Every dimension by 10 micrometres, one core.
void tolerance_samples(benchmark::State& bench, const char* name, const char* frame) {
  const kinematics::Mechanism m = shipped(name);
  const ToleranceStudy study(m, std::vector<double>(m.drives.size(), 0.5),
                             {MeasuredKind::along, m.frame(frame), -1, {1, 0, 0}}, everywhere(m, 1e-5, 0));
  std::vector<double> values(4096);
  std::int64_t first = 0;
  for (auto _ : bench) {
    study.sample(1, first, values);
    benchmark::DoNotOptimize(values.data());
    first += std::int64_t(values.size());
  }
  bench.SetItemsProcessed(first);
  bench.counters["dimensions"] = double(study.linear().ranked.size());
}
BENCHMARK_CAPTURE(tolerance_samples, four_bar, "four_bar", "tip")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tolerance_samples, grasper, "grasper", "tip_upper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tolerance_samples, needle_holder, "needle_holder", "tip_upper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tolerance_samples, claw_grasper, "claw_grasper", "tip_upper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tolerance_samples, clip_applier, "clip_applier", "tip_upper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(tolerance_samples, dvrk_arm, "dvrk_arm", "tip")->Unit(benchmark::kMillisecond);

void clearance_sweep(benchmark::State& bench, const char* name) {
  const kinematics::Mechanism m = shipped(name);
  for (auto _ : bench) benchmark::DoNotOptimize(clearance_over_motion(m, {}).least);
}
BENCHMARK_CAPTURE(clearance_sweep, colliding_grasper, "colliding_grasper")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(clearance_sweep, dvrk_arm, "dvrk_arm")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace trocar::studies
