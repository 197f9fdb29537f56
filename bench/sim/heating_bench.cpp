// The tick of the bleeding scene with a hook on the uterus: without a pedal, while it coagulates in one place, while it
// cuts along a way; and the stage "heat tissue" alone.
//
//   sim_bench --benchmark_filter=Hook
#include <cmath>

#include <benchmark/benchmark.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

using namespace trocar;

namespace {

constexpr int kHand = 1, kRound = 500;  // ticks before the State is put back
constexpr int kHot = 3000;              // ticks of current before that

struct Bleeding {
  sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  sim::State down = sim::initial_state(model), coagulating, cutting;
  sim::Input input = model.start;
  Vec3d at;  ///< of the uterus, as drawn, nearest to the hand's port

  Bleeding() {
    const sim::HandModel& hand = model.hands[kHand];
    double least = 1;
    for (const Vec3f& p : model.skin(model.organ_index("uterus")).rest)
      if (const double d = length(vec_cast<double>(p) - hand.port); d < least) least = d, at = vec_cast<double>(p);
    sim::Work work = sim::make_work(model);
    down.tools[kHand].instrument = hand.find("hook");
    point(input, 0.010);
    input.tools[kHand].instrument = down.tools[kHand].instrument;
    for (int i = 0; i < 600; ++i) step(model, input, down, work);
    point(input, -0.001);
    for (int i = 0; i < 600; ++i) step(model, input, down, work);
    coagulating = heated(sim::kBlue, 0, work);
    cutting = heated(sim::kYellow, 2e-6, work);
  }

  /// The tip `above` the place, from the port; `along` in x.
  void point(sim::Input& in, double above, double along = 0) const {
    const sim::HandModel& hand = model.hands[kHand];
    const Vec3d tip = at + Vec3d{along, 0, 0} + above * normalised(hand.port - at);
    in.tools[kHand] = sim::tool_input(kinematics::inverse(hand.port, tip, 0), 0, in.tools[kHand].instrument);
  }
  sim::State heated(std::uint32_t pedals, double way, sim::Work& work) const {
    sim::State s = down;
    sim::Input in = input;
    in.pedals = pedals;
    for (int i = 0; i < kHot; ++i) {
      point(in, -0.001, 0.003 * std::sin(way / 0.003 * i));
      step(model, in, s, work);
    }
    return s;
  }
};

const Bleeding& bleeding() {
  static const Bleeding scene;
  return scene;
}

void run_hook(benchmark::State& state, const sim::State& from, std::uint32_t pedals, double way, bool stage_only) {
  const Bleeding& scene = bleeding();
  sim::Work work = sim::make_work(scene.model);
  sim::State s = from;
  sim::Input in = scene.input;
  in.pedals = pedals;
  int ticks = 0;
  for (auto _ : state) {
    state.PauseTiming();
    if (++ticks % kRound == 0) s = from;
    scene.point(in, -0.001, 0.003 * std::sin(way / 0.003 * (kHot + ticks % kRound)));
    sim::StepReport report;
    sim::StepContext context{scene.model, in, s, work, report};
    if (!stage_only) state.ResumeTiming();
    for (const sim::Stage& stage : sim::stages()) {
      const bool timed = stage_only && std::string_view(stage.name) == "heat tissue";
      if (timed) state.ResumeTiming();
      stage.run(context);
      if (timed) state.PauseTiming();
    }
    if (stage_only) state.ResumeTiming();
  }
  state.counters["bricks"] = tissue::bricks_awake(s.heat);
}

BENCHMARK_CAPTURE(run_hook, HookWithoutCurrent, bleeding().down, 0, 0, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_hook, HookCoagulates, bleeding().coagulating, sim::kBlue, 0, false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_hook, HookCuts, bleeding().cutting, sim::kYellow, 2e-6, false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_hook, HookWithoutCurrentStage, bleeding().down, 0, 0, true)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_hook, HookCoagulatesStage, bleeding().coagulating, sim::kBlue, 0, true)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(run_hook, HookCutsStage, bleeding().cutting, sim::kYellow, 2e-6, true)
    ->Iterations(2000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
