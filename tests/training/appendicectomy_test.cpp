// The appendicectomy: how the exercise is read, what it counts of loops and of the mesentery, and what its cuts are
// told to be. States are written by hand.
#include <gtest/gtest.h>

#include <trocar/training/events/registry.hpp>
#include <trocar/training/exercise/monitor.hpp>
#include <trocar/training/expert/performer.hpp>
#include <trocar/training/facts/registry.hpp>
#include <trocar/training/observe/folds.hpp>
#include <trocar/training/observe/loops.hpp>

#include "../sim/shipped.hpp"

namespace trocar::training {
namespace {

const sim::Model& fossa() { return shipped("appendix"); }
int appendix() {
  std::int32_t index = -1;
  std::vector<std::string> known;
  EXPECT_TRUE(find_named(fossa(), ArgumentKind::strand, "appendix", index, known));
  return index;
}
int mesentery() { return fossa().membrane_index("mesoappendix"); }

/// The scene's n-th loop tied off at that place, its tail cut.
void tie(sim::State& state, size_t n, double s, double inner = 0.0018) {
  const interactions::StrandPlace at = interactions::place_at(fossa().strand_bodies[size_t(appendix())], s);
  interactions::SlingState& g = state.objects.sutures[n].sling;
  g.stage = interactions::SlingState::left;
  g.around_count = 1;
  g.around[0] = {};
  g.around[0].at.body = BodyId::strand(size_t(appendix()));
  g.around[0].at.element = at.element;
  g.around[0].at.weight[0] = float(at.w);
  g.around[0].radius = inner;
}
Value asked(const char* fact, sim::State& state, const Arguments& a) {
  const Fact* found = find_fact(fact);
  EXPECT_NE(found, nullptr) << fact;
  const auto observer = found->watch(fossa(), a);
  observer->sample({fossa(), state}, 0.02);
  return observer->value({fossa(), state});
}
Argument strand() { return {true, appendix(), 0, 0, {}, {}}; }
Argument number(double v) { return {true, -1, v, v, {}, {}}; }
Argument range(double low, double high) { return {true, -1, low, high, {}, {}}; }

TEST(Appendicectomy, IsReadWithItsDemonstration) {
  const Exercise exercise = read_exercise(TROCAR_SOURCE_DIR "/scenes/appendix/appendicectomy.json");
  const Performer performer(fossa(), read_demonstration(exercise, fossa(), 0));
  EXPECT_FALSE(performer.done());
  Monitor monitor(exercise, fossa());
  EXPECT_FALSE(monitor.finished());
}

TEST(Appendicectomy, LoopsCountThatCloseAndWhoseTailsAreCut) {
  sim::State state = sim::initial_state(fossa());
  EXPECT_EQ(asked("loops.count", state, {strand(), {}}).number, 0);
  tie(state, 0, 0.0125);
  tie(state, 1, 0.009);
  tie(state, 2, 0.027, 0.0035);  // hardly drawn: its lumen is open
  EXPECT_EQ(asked("loops.count", state, {strand(), {}}).number, 2);
  EXPECT_EQ(asked("loops.count", state, {strand(), range(0.004, 0.0105)}).number, 1);
  EXPECT_NEAR(asked("loops.at_mm", state, {strand(), number(1)}).number, 0.009, 1e-9);
  EXPECT_NEAR(asked("loops.at_mm", state, {strand(), number(2)}).number, 0.0125, 1e-9);
  EXPECT_FALSE(asked("loops.at_mm", state, {strand(), number(3)}).known);
  state.objects.sutures[0].sling.stage = interactions::SlingState::off;
  EXPECT_EQ(asked("loops.count", state, {strand(), {}}).number, 1);
}

TEST(Appendicectomy, TheMesenteryIsWholeUntilItsColumnsAreCut) {
  sim::State state = sim::initial_state(fossa());
  const Argument fold{true, BodyId::membrane(size_t(mesentery())).code(), 0, 0, {}, {}};
  const double before = asked("fold.whole_mm", state, {fold, range(0, 0.1)}).number;
  EXPECT_NEAR(before, 0.069, 0.002);
  const FoldColumns columns(fossa(), mesentery());
  const tissue::MembraneModel& sheet = fossa().membranes[size_t(mesentery())].sheet;
  for (int s = 0; s < sheet.network.springs; ++s) {  // from the first row to the second, on the outer half
    const int a = sheet.network.spring_nodes[size_t(2 * s)], b = sheet.network.spring_nodes[size_t(2 * s) + 1];
    if (a / sheet.columns == b / sheet.columns || std::min(a, b) / sheet.columns != 0) continue;
    if (std::min(a, b) % sheet.columns >= columns.count() / 2)
      tissue::cut_spring(sheet.network, state.membranes[size_t(mesentery())].network, s);
  }
  EXPECT_NEAR(asked("fold.whole_mm", state, {fold, range(0, 0.1)}).number, 0.5 * before, 0.005);
}

TEST(Appendicectomy, TheArteryIsSealedWhereASealOfItHolds) {
  sim::State state = sim::initial_state(fossa());
  std::int32_t artery = -1;
  std::vector<std::string> known;
  ASSERT_TRUE(find_named(fossa(), ArgumentKind::vessel, "appendicular", artery, known));
  const Argument of{true, artery, 0, 0, {}, {}};
  EXPECT_EQ(asked("vessel.sealed", state, {of}).number, 0);
  interactions::VesselSeal& seal = state.seals[0];
  state.seal_count = 1;
  seal.vessel = artery;
  seal.from = 0.9, seal.to = 0.95;
  EXPECT_EQ(asked("vessel.sealed", state, {of}).number, 0);  // hardly warm
  seal.state.damage = 1e4;
  EXPECT_EQ(asked("vessel.sealed", state, {of}).number, 1);
}

}  // namespace
}  // namespace trocar::training
