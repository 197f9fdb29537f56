// The appendicectomy's demonstration in the shipped scene: it passes, with two loops at the base, one on what is taken
// out, and the artery sealed.
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/expert.hpp>
#include <trocar/training/observe/loops.hpp>

using namespace trocar;
using namespace trocar::training;

TEST(AppendicectomySoak, TheDemonstrationPasses) {
  const Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/appendix/appendicectomy.json");
  const sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  Monitor monitor(exercise, model);
  const std::unique_ptr<Expert> surgeon = make_expert(exercise, model);
  std::uint32_t flags = 0;
  while (!surgeon->done() && state.tick < 400000) {
    const sim::StepReport report = step(model, surgeon->next(model, state), state, work);
    surgeon->after(model, state, report);
    monitor.update(model, state, report);
    flags |= report.flags;
  }
  EXPECT_FALSE(surgeon->gave_up());
  EXPECT_TRUE(monitor.finished());
  EXPECT_TRUE(monitor.score().passed);
  EXPECT_EQ(flags & std::uint32_t(tissue::StepReport::kNonFinite), 0u);
  int strand = 0;
  while (model.strands[size_t(strand)].name != "appendix") ++strand;
  const SecuredLoops loops = secured_loops(model, state, strand);
  ASSERT_EQ(loops.count, 3);
  EXPECT_LT(loops.at[0], 0.0105);
  EXPECT_LT(loops.at[1], 0.016);
  EXPECT_GT(loops.at[2], 0.016);
}
