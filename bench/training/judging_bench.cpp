// What judging costs a tick: the exercises that are shipped, in their scenes at rest, with every fact that they ask
// for. At most 20 us in the mean on one core.
#include <benchmark/benchmark.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/exercise/monitor.hpp>

using namespace trocar;
using namespace trocar::training;

namespace {

void judge(benchmark::State& bench, const char* file) {
  const Exercise exercise = read_exercise(std::string(TROCAR_SOURCE_DIR "/scenes/") + file);
  const sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  sim::State state = sim::initial_state(model);
  Monitor monitor(exercise, model);
  for (auto _ : bench) {
    ++state.tick;  // every twentieth tick is one in which conditions are asked
    monitor.update(model, state, {});
  }
}
BENCHMARK_CAPTURE(judge, Sterilisation, "gynaecology/sterilisation.json")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(judge, BleedingControl, "gynaecology/bleeding-control.json")->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(judge, ClipAndCut, "cholecystectomy/clip-and-cut.json")->Unit(benchmark::kMicrosecond);

}  // namespace
