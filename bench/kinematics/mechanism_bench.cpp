// What a design study and a controller ask most: a linkage closed again after a dimension has changed, an arm's forward
// and inverse kinematics. Mechanisms are the shipped ones.
#include <filesystem>

#include <benchmark/benchmark.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/dynamics/dynamics.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::kinematics {
namespace {

Mechanism shipped(const char* name) {
  return build(
      scene::read_mechanism(scene::found_scenes_folder().value() / "mechanisms" / (std::string(name) + ".json")));
}

/// Every named dimension a little off, the loops closed again from the pose before.
void closure_after_change(benchmark::State& bench, const char* name) {
  const Mechanism m = shipped(name);
  Mechanism changed = m;
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u(), p = m.parameter_values;
  close(m, u, work);
  const std::vector<double> start = u;
  core::Random random(1);
  int iterations = 0, count = 0;
  for (auto _ : bench) {
    for (std::size_t i = 0; i < std::size_t(m.named_parameters); ++i)
      p[i] = m.parameter_values[i] + random.uniform(-2e-5, 2e-5);
    changed.assign(p);
    u = start;
    const LoopReport report = close(changed, u, work);
    benchmark::DoNotOptimize(u.data());
    iterations += report.iterations;
    ++count;
    if (!report.closed()) bench.SkipWithError("does not close");
  }
  bench.counters["iterations"] = double(iterations) / count;
}
BENCHMARK_CAPTURE(closure_after_change, four_bar, "four_bar")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(closure_after_change, needle_holder, "needle_holder")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(closure_after_change, grasper, "grasper")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(closure_after_change, clip_applier, "clip_applier")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(closure_after_change, double_parallelogram, "double_parallelogram")->Unit(benchmark::kMicrosecond);

/// The next of a row of handle positions, nothing else changed.
void closure_of_motion(benchmark::State& bench, const char* name) {
  const Mechanism m = shipped(name);
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  close(m, u, work);
  const Drive& d = m.drives[0];
  int k = 0;
  for (auto _ : bench) {
    const double handle = 0.45 + 0.001 * ((k++ / 50) % 2 ? 50 - k % 50 : k % 50);
    u[std::size_t(d.independent)] = d.value(handle);
    benchmark::DoNotOptimize(close(m, u, work).rank);
  }
}
BENCHMARK_CAPTURE(closure_of_motion, grasper, "grasper")->Unit(benchmark::kMicrosecond);

void arm_forward(benchmark::State& bench, const char* name) {
  const Mechanism m = shipped(name);
  Pose pose(m);
  std::vector<double> u = m.start_u();
  for (auto _ : bench) {
    u[0] += 1e-7;
    forward(m, u, pose);
    benchmark::DoNotOptimize(pose.frames.data());
  }
}
BENCHMARK_CAPTURE(arm_forward, dvrk_arm, "dvrk_arm")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(arm_forward, flexible_instrument, "flexible_instrument")->Unit(benchmark::kMicrosecond);

/// From the pose before, as a controller does (a millimetre further), or from the arm's start.
void arm_inverse(benchmark::State& bench, const char* name, bool near) {
  const Mechanism m = shipped(name);
  const BodyFrame& tip = m.frames[std::size_t(m.frame("tip"))];
  InverseWork work(m, 6);
  LoopWork loops(m);
  core::Random random(2);
  Pose pose(m);
  struct Case {
    std::vector<double> u;
    Frame wanted;
  };
  std::vector<Case> cases;
  while (cases.size() < 200) {
    Case c{m.start_u(), {}};
    for (std::size_t i = 0; i < c.u.size(); ++i) {
      const auto q = std::size_t(m.independent[i]);
      c.u[i] = random.uniform(0.8 * m.low[q], 0.8 * m.high[q]);
    }
    const LoopReport report = close(m, c.u, loops);
    if (!report.closed() || report.limit >= 0) continue;
    c.wanted = place(tip, loops.pose);
    if (near)
      c.wanted.p.x += 1e-3;
    else
      c.u = m.start_u();
    std::vector<double> v = c.u;
    const Closure goal = reach(tip, c.wanted);
    if (inverse(m, {&goal, 1}, v, work).reached()) cases.push_back(std::move(c));
  }
  std::vector<double> u;
  std::size_t k = 0;
  double attempts = 0;
  for (auto _ : bench) {
    const Case& c = cases[k++ % cases.size()];
    u = c.u;
    const Closure goal = reach(tip, c.wanted);
    attempts += inverse(m, {&goal, 1}, u, work).attempts;
    benchmark::DoNotOptimize(u.data());
  }
  bench.counters["attempts"] = attempts / double(k);
}
BENCHMARK_CAPTURE(arm_inverse, dvrk_arm_a_millimetre, "dvrk_arm", true)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(arm_inverse, dvrk_arm_from_start, "dvrk_arm", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(arm_inverse, flexible_instrument_a_millimetre, "flexible_instrument", true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(arm_inverse, redundant_arm_a_millimetre, "redundant_arm", true)->Unit(benchmark::kMicrosecond);

void dynamics_step(benchmark::State& bench, const char* name) {
  const Mechanism m = shipped(name);
  DynamicsWork work(m);
  MotionState s{m.start_u(), std::vector<double>(std::size_t(m.u_count()), 0.0)};
  project(m, s, work);
  for (auto _ : bench) benchmark::DoNotOptimize(step(m, {}, 1e-5, s, work));
}
BENCHMARK_CAPTURE(dynamics_step, four_bar, "four_bar")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(dynamics_step, bricard, "bricard")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace trocar::kinematics
