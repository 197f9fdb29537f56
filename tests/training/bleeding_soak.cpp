// Bleeding control by the scripted surgeon: clipped on both sides it stops for good; with the first clip on the wrong
// side it bleeds on, and fails with its code.
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/expert.hpp>

namespace trocar::training {
namespace {

sim::Model bleeding_at(const Exercise& exercise, int place) {
  scene::Description scene = scene::read_scene(exercise.scene);
  scene.bleeder->which = place;
  return scene::compile(scene);
}

struct Attempt {
  Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/gynaecology/bleeding-control.json");
  sim::Model model;
  Monitor monitor;
  sim::State state = sim::initial_state(model);
  int tears = 0;

  /// @param place  number of the hole that opens
  explicit Attempt(const char* flaw, int place = 0) : model(bleeding_at(exercise, place)), monitor(exercise, model) {
    const auto surgeon = make_expert(exercise, model, {{}, flaw});
    sim::Work work = sim::make_work(model);
    while (!surgeon->done() && state.tick < 600'000) {
      const sim::Input input = surgeon->next(model, state);
      const sim::StepReport report = step(model, input, state, work);
      EXPECT_TRUE(report.fine());
      for (int i = 0; i < report.event_count; ++i) tears += report.events[i].kind == sim::Event::torn;
      monitor.update(model, state, report);
    }
  }
  bool made(const char* code) const {
    return std::any_of(monitor.errors().begin(), monitor.errors().end(),
                       [code](const ErrorMade& e) { return e.code == code; });
  }
};

class BleedingPlace : public testing::TestWithParam<int> {};

TEST_P(BleedingPlace, TheSurgeonStopsItAndPasses) {
  const Attempt a("", GetParam());
  EXPECT_TRUE(a.monitor.finished());
  EXPECT_TRUE(a.monitor.score().passed) << a.monitor.score().total;
  EXPECT_EQ(a.monitor.bleeding()->facts().flow, 0) << "to the picolitre";
  EXPECT_LT(a.monitor.bleeding()->facts().lost, 10e-6);
  EXPECT_TRUE(balanced(a.state.fluids.ledger));
  EXPECT_EQ(a.tears, 0) << "also after the last step, while it sucks";
}

INSTANTIATE_TEST_SUITE_P(All, BleedingPlace, testing::Range(0, 6));

TEST(BleedingControl, WithTheFirstClipOnTheWrongSideItBleedsOnAndFails) {
  const Attempt a("A3.1");
  EXPECT_TRUE(a.made("A3.1"));
  EXPECT_FALSE(a.monitor.score().passed);
  EXPECT_GT(60e6 * a.monitor.bleeding()->facts().flow, 5) << "[mL/min]";
}

/// What needs blood, fluids or energy, one run a code.
class BleedingFlaw : public testing::TestWithParam<const char*> {};

TEST_P(BleedingFlaw, TriggersItsError) {
  const Attempt a(GetParam());
  for (const ErrorMade& e : a.monitor.errors()) std::printf("%s: %s at %.1f s\n", GetParam(), e.code.c_str(), e.at);
  EXPECT_TRUE(a.made(GetParam()));
  EXPECT_EQ(a.monitor.score().failed, a.exercise.penalty(GetParam())->fail);
}
INSTANTIATE_TEST_SUITE_P(Codes, BleedingFlaw,
                         testing::Values("E4.2", "E6", "E7", "E7.1", "E7.2", "E8", "E9.1", "E9.2", "E9.3", "E10", "E12",
                                         "A3.2", "A3.3", "A3.4"),
                         [](const auto& of) {
                           std::string name = of.param;
                           std::replace(name.begin(), name.end(), '.', '_');
                           return name;
                         });

}  // namespace
}  // namespace trocar::training
