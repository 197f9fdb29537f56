// One tick of the box trainer's pad with a needle and its thread: at rest, with the needle in both lips, and with
// thread drawn after it.
//
//   build/release/bench/training/training_bench --benchmark_filter=Suturing --benchmark_repetitions=5
//
// The States are those of the demonstration of suturing/needle-through; every round begins there again, so that all
// rounds do the same work.
#include <array>

#include <benchmark/benchmark.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/expert/expert.hpp>
#include <trocar/training/observe/stitches.hpp>

using namespace trocar;

namespace {

constexpr int kTicksARound = 200;
constexpr double kDrawn = 0.030;  // [m]

enum Moment { at_start, in_tissue, drawn, kMoments };

struct Stitch {
  sim::Model model;
  std::array<sim::State, kMoments> state;
  std::array<sim::Input, kMoments> input;

  Stitch() {
    const training::Exercise exercise =
        training::read_exercise(TROCAR_SOURCE_DIR "/scenes/suturing/needle-through.json");
    model = scene::compile(scene::read_scene(exercise.scene));
    const std::unique_ptr<training::Expert> surgeon = training::make_expert(exercise, model);
    sim::State s = sim::initial_state(model);
    sim::Work work = sim::make_work(model);
    state.fill(s), input.fill(model.start);
    while (!surgeon->done() && through(s) < kDrawn) {
      const sim::Input hands = surgeon->next(model, s);
      surgeon->after(model, s, step(model, hands, s, work));
      if (training::passages_through(s, BodyId::organ(0)) < 2 || through(s) == 0)
        state[in_tissue] = s, input[in_tissue] = hands;
      state[drawn] = s, input[drawn] = hands;
    }
  }

  /// Of thread beyond the nearest hole [m].
  static double through(const sim::State& s) {
    const interactions::SutureState& suture = training::suture_of(s);
    double least = 1;
    for (int i = 0; i < suture.hole_count; ++i)
      if (suture.holes[std::size_t(i)].slot >= 0) least = std::min(least, double(suture.holes[std::size_t(i)].arc));
    return least < 1 ? least : 0;
  }
};

const Stitch& stitch() {
  static const Stitch made;
  return made;
}

void Suturing(benchmark::State& state, Moment moment) {
  const Stitch& s = stitch();
  sim::Work work = sim::make_work(s.model);
  sim::State now = s.state[std::size_t(moment)];
  int ticks = 0;
  for (auto _ : state) {
    if (++ticks % kTicksARound == 0) {
      state.PauseTiming();
      now = s.state[std::size_t(moment)];
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(step(s.model, s.input[std::size_t(moment)], now, work));
  }
  state.counters["holes"] = training::suture_of(s.state[std::size_t(moment)]).hole_count;
}
BENCHMARK_CAPTURE(Suturing, at_rest, at_start)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Suturing, needle_in_tissue, in_tissue)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(Suturing, thread_drawn, drawn)->Unit(benchmark::kMicrosecond);

}  // namespace
