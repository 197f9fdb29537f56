// Bleeding control by the scripted surgeon: clipped on both sides it stops for good; with the first clip on the wrong
// side it bleeds on, and fails with its code.
#include <algorithm>

#include <gtest/gtest.h>

#include <trocar/scene/compile.hpp>
#include <trocar/scene/reader.hpp>
#include <trocar/training/expert.hpp>
#include <trocar/training/monitor.hpp>

namespace trocar::training {
namespace {

struct Attempt {
  Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/bleeding-control.json");
  sim::Model model = scene::compile(scene::read_scene(exercise.scene));
  Monitor monitor{exercise, model};
  sim::State state = sim::initial_state(model);

  explicit Attempt(const char* flaw) {
    const auto surgeon = make_expert(exercise, model, {{}, flaw});
    sim::Work work = sim::make_work(model);
    while (!surgeon->done() && state.tick < 120'000) {
      const sim::Input input = surgeon->next(model, state);
      const sim::StepReport report = step(model, input, state, work);
      EXPECT_TRUE(report.fine());
      monitor.update(model, state, report);
    }
  }
  bool made(const char* code) const {
    return std::any_of(monitor.errors().begin(), monitor.errors().end(),
                       [code](const ErrorMade& e) { return e.code == code; });
  }
};

TEST(BleedingControl, TheSurgeonStopsItAndPassesAtTheFirstPlace) {
  const Attempt a("");
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.score().passed) << a.monitor.score().total;
  EXPECT_EQ(a.monitor.bleeding()->facts().flow, 0) << "to the picolitre";
  EXPECT_LT(a.monitor.bleeding()->facts().lost, 10e-6);
  EXPECT_TRUE(balanced(a.state.fluids.ledger));
}

TEST(BleedingControl, WithTheFirstClipOnTheWrongSideItBleedsOnAndFails) {
  const Attempt a("A3.1");
  EXPECT_TRUE(a.made("A3.1"));
  EXPECT_FALSE(a.monitor.score().passed);
  EXPECT_GT(60e6 * a.monitor.bleeding()->facts().flow, 5) << "[mL/min]";
}

}  // namespace
}  // namespace trocar::training
