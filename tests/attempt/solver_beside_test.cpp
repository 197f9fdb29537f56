// One organ with both solvers under the same hands, and the hands that press it in.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/attempt/solver_comparison.hpp>
#include <trocar/core/error.hpp>

#include "../sim/small_scene.hpp"

namespace trocar::attempt {
namespace {

constexpr int kPressed = 1;          // the pad, which lies on springs
constexpr double kShallow = 0.0005;  // [m]

std::unique_ptr<Lesson> small_lesson(scene::Solver solver) {
  scene::Description d = small::description();
  d.solids[kPressed].solver = solver;
  auto lesson = std::make_unique<Lesson>();
  lesson->name = "small";
  lesson->model = scene::compile(d);
  return lesson;
}

const SolverPair& small_pair() {
  static const SolverPair pair{small_lesson(scene::Solver::dynamic_network), small_lesson(scene::Solver::elastostatic),
                               kPressed};
  return pair;
}

SolverComparison pressed(double depth) {
  const sim::Model& model = small_pair().dynamic->model;
  PressSource hands(model, plan_press(model, kPressed, depth));
  return compare_solvers(small_pair(), hands, 0, [&] { return hands.settled(); });
}

const SolverComparison& shallow() {
  static const SolverComparison comparison = pressed(kShallow);
  return comparison;
}

}  // namespace

TEST(SolverBeside, BothStartAlikeAndStayAlikeUntouched) {
  SolverBeside beside(small_pair().at_once->model, kPressed, 1);
  OrganSkin drawn(small_pair().dynamic->model, kPressed);
  const std::vector<Vec3f> start = drawn.at(sim::initial_state(small_pair().dynamic->model));
  ASSERT_EQ(start.size(), beside.skin().size());
  for (int tick = 0; tick < 100; ++tick) beside.advance(beside.model().start);
  for (std::size_t v = 0; v < start.size(); ++v) EXPECT_LT(length(start[v] - beside.skin()[v]), 5e-5f) << v;
}

TEST(SolverBeside, PressedInALittleBothAreWithinSomePercentOfEachOther) {
  const SolverSummary sum = shallow().summary();
  ASSERT_TRUE(sum.held.settled);
  EXPECT_GT(sum.held.moved, 0.4 * kShallow);
  EXPECT_GT(sum.held.dynamic_force, 0.01);
  EXPECT_LT(sum.held.share(sum.held.rms), 0.03);
  EXPECT_LT(sum.held.share(sum.held.largest), 0.10);
  EXPECT_LT(std::fabs(sum.held.force_share()), 0.05);
}

TEST(SolverBeside, WithdrawnBothAreWhereTheyWere) {
  const SolverSample& last = shallow().samples().back();
  EXPECT_LT(last.moved, 1e-4);
  EXPECT_LT(last.largest, 1e-4);
  EXPECT_TRUE(std::isnan(last.share(last.largest))) << "there is no indentation to take a share of";
}

TEST(SolverBeside, TheStateThatIsKeptIsTheOneWhereBothAreFarthestApart) {
  const SolverComparison& c = shallow();
  const std::vector<Vec3f> a = OrganSkin(small_pair().dynamic->model, kPressed).at(c.dynamic_state());
  const std::vector<Vec3f> b = OrganSkin(small_pair().at_once->model, kPressed).at(c.static_state());
  const SolverSample worst = c.summary().worst;
  EXPECT_NEAR(double(length(a[std::size_t(worst.vertex)] - b[std::size_t(worst.vertex)])), worst.largest, 1e-7);
  for (const SolverSample& s : c.samples()) EXPECT_LE(s.rms, s.largest);
}

TEST(SolverBeside, TheSameHandsGiveTheSameFiguresToTheBit) {
  const std::vector<SolverSample> again = pressed(kShallow).samples();
  ASSERT_EQ(again.size(), shallow().samples().size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    const SolverSample &a = again[i], &b = shallow().samples()[i];
    EXPECT_TRUE(a.moved == b.moved && a.rms == b.rms && a.largest == b.largest && a.dynamic_force == b.dynamic_force &&
                a.static_force == b.static_force)
        << i;
  }
}

TEST(SolverBeside, AnOrganThatThereIsNotIsToldAtTheOptionWithWhatThereIs) {
  try {
    static_cast<void>(load_beside("gynaecology", 0, "bladdr", "--beside"));
    FAIL() << "there is no such organ";
  } catch (const core::BadInput& bad) {
    const std::string told = bad.what();
    EXPECT_EQ(told.rfind("--beside:", 0), 0u) << told;
    EXPECT_NE(told.find("did you mean \"bladder\""), std::string::npos) << told;
  }
}

TEST(Press, GoesAsDeepAsItWasToldFromWhereItTouches) {
  const sim::Model& model = small_pair().dynamic->model;
  const Press plan = plan_press(model, kPressed, 0.002);
  PressSource hands(model, plan);
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  sim::Input input;
  double lowest = 1, touched = 1;
  while (hands.next(state, input)) {
    sim::step(model, input, state, work);
    const Vec3d tip =
        kinematics::forward(model.hands[std::size_t(plan.hand)].port, pose_of(input.tools[std::size_t(plan.hand)])).tip;
    const double height = dot(tip - plan.at, plan.out);
    lowest = std::min(lowest, height);
    if (touched == 1 && length(Vec3d{state.tools[std::size_t(plan.hand)].contact_force[0],
                                     state.tools[std::size_t(plan.hand)].contact_force[1],
                                     state.tools[std::size_t(plan.hand)].contact_force[2]}) > 0)
      touched = height;
  }
  EXPECT_NEAR(lowest, model.placed(std::size_t(plan.hand)).jaw_thickness - 0.002, 2e-4);
  EXPECT_GT(touched, lowest);
}

TEST(Press, WhatNoHandReachesIsAFaultWithARemedy) {
  sim::Model model = small_pair().dynamic->model;
  for (sim::HandModel& hand : model.hands)
    for (interactions::ToolModel& tool : hand.rack) tool.limits.depth_max = 0.03;
  try {
    static_cast<void>(plan_press(model, kPressed, kShallow));
    FAIL() << "no hand reaches it";
  } catch (const core::BadInput& bad) {
    EXPECT_NE(std::string(bad.what()).find("--hands"), std::string::npos) << bad.what();
  }
}

}  // namespace trocar::attempt
