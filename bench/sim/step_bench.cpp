// The whole tick of the shipped scene while the demonstration pulls at the tube, and each of its stages.
//
//   sim_bench --benchmark_counters_tabular=true
//
// The State is that after six seconds of the demonstration; every round begins there again, so that all rounds do the
// same work. TROCAR_THREADS and TROCAR_SIMD apply.
#include <benchmark/benchmark.h>

#include <trocar/core/parallel.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/expert/expert.hpp>

using namespace trocar;

namespace {

constexpr std::uint64_t kPulling = 6000;  // ticks into the demonstration
constexpr int kRound = 500;               // ticks before the State is put back

struct Scene {
  training::Exercise exercise = training::read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json");
  sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  sim::State start = sim::initial_state(model), pulling = start;
  sim::Input input;

  Scene() {
    const std::unique_ptr<training::Expert> surgeon = training::make_expert(exercise, model);
    sim::Work work = sim::make_work(model);
    while (pulling.tick < kPulling) {
      input = surgeon->next(model, pulling);
      surgeon->after(model, pulling, step(model, input, pulling, work));
    }
  }
};

const Scene& scene_at_work() {
  static const Scene scene;
  return scene;
}

void run_ticks(benchmark::State& state, const sim::State& from, const sim::Input& input, int threads) {
  const Scene& scene = scene_at_work();
  core::ThreadPool pool(threads);
  sim::Work work = sim::make_work(scene.model, &pool);
  sim::State s = from;
  int ticks = 0;
  for (auto _ : state) {
    if (++ticks % kRound == 0) {
      state.PauseTiming();
      s = from;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(step(scene.model, input, s, work));
  }
  state.counters["free_nodes"] = scene.model.free_nodes();
  state.counters["pull_mN"] = 1e3 * length(Vec3d{from.tools[0].pull[0], from.tools[0].pull[1], from.tools[0].pull[2]});
}

void TickWhilePulling(benchmark::State& state) {
  run_ticks(state, scene_at_work().pulling, scene_at_work().input, int(state.range(0)));
}
BENCHMARK(TickWhilePulling)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond)->UseRealTime();

void TickAtRest(benchmark::State& state) {
  run_ticks(state, scene_at_work().start, scene_at_work().model.start, int(state.range(0)));
}
BENCHMARK(TickAtRest)->ArgName("threads")->Arg(1)->Unit(benchmark::kMicrosecond)->UseRealTime();

void Stage(benchmark::State& state, size_t timed) {
  const Scene& scene = scene_at_work();
  sim::Work work = sim::make_work(scene.model);
  sim::State s = scene.pulling;
  int ticks = 0;
  for (auto _ : state) {
    state.PauseTiming();
    if (++ticks % kRound == 0) s = scene.pulling;
    sim::StepReport report;
    sim::StepContext context{scene.model, scene.input, s, work, report};
    for (size_t i = 0; i < sim::stages().size(); ++i) {
      if (i == timed) state.ResumeTiming();
      sim::stages()[i].run(context);
      if (i == timed) state.PauseTiming();
    }
    state.ResumeTiming();
  }
}

/// One benchmark for every stage that the step lists.
const bool kStagesListed = [] {
  for (size_t i = 0; i < sim::stages().size(); ++i) {
    std::string name = std::string("Stage/") + std::to_string(i + 1) + "_" + sim::stages()[i].name;
    for (char& c : name)
      if (c == ' ') c = '_';
    benchmark::RegisterBenchmark(name.c_str(), Stage, i)->Iterations(2000)->Unit(benchmark::kMicrosecond);
  }
  return true;
}();

void HashOfState(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(hash_of(scene_at_work().pulling));
}
BENCHMARK(HashOfState)->Unit(benchmark::kMicrosecond);

void CopyOfState(benchmark::State& state) {
  sim::State s = scene_at_work().pulling;
  for (auto _ : state) {
    s = scene_at_work().pulling;
    benchmark::ClobberMemory();
  }
}
BENCHMARK(CopyOfState)->Unit(benchmark::kMicrosecond);

}  // namespace
