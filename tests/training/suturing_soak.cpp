// The needle's exercise performed: its demonstration passes, and without errors of the stitch.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>

#include "flaws.hpp"

namespace trocar::training {
namespace {

TEST(Suturing, TheDemonstrationDrivesTheNeedleThroughAndDrawsItsThread) {
  const Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/suturing/needle-through.json");
  const sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  Monitor monitor(exercise, model, Mode::assessed, 0);
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  Performer performer(model, read_demonstration(exercise, model, 0), {Tremor{}});
  while (!performer.done() && state.tick < 120000) {
    const sim::Input input = performer.next(model, state);
    const sim::StepReport report = step(model, input, state, work);
    performer.after(model, state, report);
    monitor.update(model, state, report);
  }
  for (const std::string& d : performer.difficulties()) RecordProperty("difficulty", d);
  EXPECT_FALSE(performer.gave_up());
  for (const ErrorMade& e : monitor.errors())
    EXPECT_NE(e.code[0], 'S') << e.code << " at " << e.at << " s: " << e.detail;
  EXPECT_EQ(state.objects.sutures.front().torn, 0);
  EXPECT_EQ(state.objects.sutures.front().broken, 0);
}

}  // namespace
}  // namespace trocar::training
