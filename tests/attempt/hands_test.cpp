// Hands and their instruments: the led tip goes where the hand goes in the picture.
#include <algorithm>
#include <fstream>

#include <gtest/gtest.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/session.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::attempt {
namespace {

const attempt::Lesson& scene() {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("gynaecology");
  return *lesson;
}

Vec3d commanded(const sim::Input& input, int tool) {
  return kinematics::forward(scene().model.hands[size_t(tool)].port, pose_of(input.tools[tool])).tip;
}

devices::HandSample mouse(float dx, float dy) {
  devices::HandSample sample;
  sample.dt = 0.016f;
  sample.dx = dx;
  sample.dy = dy;
  return sample;
}

TEST(HandPilot, TheLedTipGoesWhereTheMouseGoesInThePicture) {
  const sim::State state = sim::initial_state(scene().model);
  const kinematics::ScopeFrame view = sim::scope_of(scene().model, state);
  attempt::HandPilot pilot(scene().model);
  const Vec3d before = commanded(scene().model.start, 0);
  const sim::Input input = pilot.lead(mouse(30, -20), state);
  const Vec3d moved = commanded(input, 0) - before;
  EXPECT_NEAR(dot(moved, view.right), 0.003, 1e-6);
  EXPECT_NEAR(dot(moved, view.up), 0.002, 1e-6);
  EXPECT_NEAR(dot(moved, view.forward), 0, 1e-6);
}

TEST(HandPilot, ValvesOfTheLedSuctionIrrigatorArePedalsOfItsHand) {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("bleeding");
  const sim::Model& model = lesson->model;
  sim::State state = sim::initial_state(model);
  const int tube = model.hands[1].find("suction_irrigator");
  ASSERT_GE(tube, 0) << "it fits a 5 mm trocar";
  attempt::HandPilot pilot(model);
  devices::HandSample sample = mouse(0, 0);
  sample.held.set(devices::Key::a);
  pilot.choose(1);
  pilot.lead(mouse(0, 0), state);
  EXPECT_EQ(pilot.lead(sample, state).pedals, 0u) << "scissors have no valves";
  state.tools[1].instrument = tube;
  pilot.take(tube);
  EXPECT_EQ(pilot.lead(sample, state).pedals, sim::irrigates(1));
  sample.held.set(devices::Key::d);
  sample.held.set(devices::Key::t);
  EXPECT_EQ(pilot.lead(sample, state).pedals, sim::irrigates(1) | sim::sucks(1) | sim::kWipe);
  EXPECT_EQ(pilot.lead(mouse(0, 0), state).pedals, 0u);
  pilot.lead(sample, state);
  EXPECT_EQ(pilot.rest(0.016f, state).pedals, 0u) << "nobody's hand presses anything";
}

TEST(PatientInWords, SaysPulseAndPressuresWhichFallWithTheLossAndByHowMuchThePulseIsEnlarged) {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("bleeding");
  sim::State state = sim::initial_state(lesson->model);
  const std::vector<std::string> before = attempt::patient_in_words(lesson->model, state);
  ASSERT_EQ(before.size(), 3u);
  EXPECT_EQ(before[0], "pulse 72/min, 120/80 mmHg");
  EXPECT_EQ(before[1], "gas in the abdomen 12 mmHg");
  EXPECT_EQ(before[2], "arteries' pulse shown and felt 5 times");
  state.fluids.gas.pressure /= 2;
  EXPECT_EQ(attempt::patient_in_words(lesson->model, state)[1], "gas in the abdomen 6 mmHg, low");
  state.flow.bled = 2'000'000'000'000;  // two litres
  EXPECT_EQ(attempt::patient_in_words(lesson->model, state)[0], "pulse 133/min, 73/59 mmHg");
  EXPECT_TRUE(attempt::patient_in_words(scene().model, sim::initial_state(scene().model)).empty());
}

TEST(FluidAccount, AddsUp) {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("bleeding");
  sim::State state = sim::initial_state(lesson->model);
  fluids::Ledger& ledger = state.fluids.ledger;
  fluids::receive(ledger, fluids::Source::kBled, fluids::Place::kDroplets, {.blood = 5 * fluids::kMillilitre});
  fluids::receive(ledger, fluids::Source::kIrrigated, fluids::Place::kPool, {.saline = 20 * fluids::kMillilitre});
  fluids::move(ledger, fluids::Place::kDroplets, fluids::Place::kFilm, {.blood = fluids::kMillilitre});
  fluids::move(ledger, fluids::Place::kDroplets, fluids::Place::kPool, {.blood = fluids::kMillilitre});
  fluids::move(ledger, fluids::Place::kPool, fluids::Place::kSucked, {.saline = 3 * fluids::kMillilitre});
  EXPECT_EQ(attempt::fluid_account(lesson->model, state),
            (std::vector<std::string>{"bled 5.0 mL", "irrigated 20.0 mL", "in the pool 18.0 mL", "sucked away 3.0 mL",
                                      "drops and film 4.0 mL"}));
  EXPECT_TRUE(attempt::fluid_account(scene().model, sim::initial_state(scene().model)).empty());
}

TEST(FlagNames, EveryFlagOfAStepHasOne) {
  for (const std::uint32_t flag :
       {std::uint32_t(tissue::StepReport::kNonFinite), std::uint32_t(tissue::StepReport::kInverted),
        std::uint32_t(tissue::StepReport::kBadLoad), std::uint32_t(tissue::StepReport::kIndefinite),
        std::uint32_t(sim::StepReport::kTooManyLoads), std::uint32_t(sim::StepReport::kBadInput),
        std::uint32_t(sim::StepReport::kRecordsFull), std::uint32_t(sim::StepReport::kBloodFlow),
        std::uint32_t(sim::StepReport::kHeatFull), std::uint32_t(sim::StepReport::kDropsFull)})
    EXPECT_EQ(attempt::flag_names(flag).size(), 1u) << flag;
  EXPECT_EQ(attempt::flag_names(sim::StepReport::kDropsFull | sim::StepReport::kRecordsFull).size(), 2u);
}

TEST(LensInWords, SaysFogAndAWipeAndNothingOfAClearLensOrWhereThereAreNoFluids) {
  static const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("bleeding");
  sim::State state = sim::initial_state(lesson->model);
  EXPECT_EQ(attempt::lens_in_words(lesson->model, state), "");
  state.fluids.smoke.fog = 0.4;
  EXPECT_EQ(attempt::lens_in_words(lesson->model, state), "lens fogged, 40 %");
  state.fluids.smoke.wipe_left = 4.2;
  EXPECT_EQ(attempt::lens_in_words(lesson->model, state), "lens is being wiped, 5 s");
  EXPECT_EQ(attempt::lens_in_words(scene().model, sim::initial_state(scene().model)), "");
}

TEST(HandPilot, TheOthersKeepPoseAndGrip) {
  const sim::State state = sim::initial_state(scene().model);
  attempt::HandPilot pilot(scene().model);
  devices::HandSample close = mouse(5, 5);
  close.left_button = true;
  for (int i = 0; i < 60; ++i) pilot.lead(close, state);
  devices::HandSample next = mouse(0, 0);
  next.pressed.set(devices::Key::two);
  pilot.lead(next, state);
  const sim::Input before = pilot.lead(mouse(0, 0), state);
  const sim::Input after = pilot.lead(mouse(40, 40), state);
  EXPECT_EQ(after.tools[0].handle, 1.0f);
  EXPECT_EQ(after.tools[0].yaw, before.tools[0].yaw);
  EXPECT_EQ(after.tools[0].depth, before.tools[0].depth);
  EXPECT_NE(after.tools[1].yaw, before.tools[1].yaw);
}

TEST(HandPilot, BothTipsGoWhereTheirSticksGoInThePictureInOneSample) {
  const sim::State state = sim::initial_state(scene().model);
  const kinematics::ScopeFrame view = sim::scope_of(scene().model, state);
  attempt::HandPilot pilot(scene().model);
  pilot.lead_both(true);
  pilot.lead(mouse(0, 0), state);
  const auto [left, right] = pilot.both().pair;
  const auto aside = [&](int hand) { return dot(scene().model.hands[size_t(hand)].port, view.right); };
  EXPECT_LT(aside(left), aside(right)) << "each stick is on the side of its trocar";
  devices::HandSample sticks = mouse(0, 0);
  sticks.gamepad.left_x = 1;
  sticks.gamepad.right_y = -1;
  const sim::Input before = scene().model.start, after = pilot.lead(sticks, state);
  const Vec3d moved_left = commanded(after, left) - commanded(before, left);
  const Vec3d moved_right = commanded(after, right) - commanded(before, right);
  const double step = 0.016 * double(pilot.settings().stick_speed);
  EXPECT_NEAR(dot(moved_left, view.right), step, 1e-6);
  EXPECT_NEAR(dot(moved_left, view.up), 0, 1e-6);
  EXPECT_NEAR(dot(moved_right, view.up), step, 1e-6);
  EXPECT_NEAR(dot(moved_right, view.right), 0, 1e-6);
}

TEST(HandPilot, SidesAreTheSameWhereTheEndoscopeBeginsWithALookTheOtherWay) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("sterilisation");
  const sim::Model& model = lesson->model;
  const kinematics::ScopeFrame first =
      kinematics::scope_frame(model.scope.port, pose_of(model.start.scope), model.scope.angle, 0);
  ASSERT_LT(dot(model.hands[1].port - model.hands[0].port, first.right), 0);
  EXPECT_EQ(attempt::HandPilot(model).both().pair, attempt::HandPilot(scene().model).both().pair);
}

TEST(HandPilot, OneHandClosesWhileTheOtherMovesAndBothKeepTheirGripsWhileOneLooks) {
  const sim::State state = sim::initial_state(scene().model);
  attempt::HandPilot pilot(scene().model);
  pilot.lead_both(true);
  pilot.lead(mouse(0, 0), state);
  const auto [left, right] = pilot.both().pair;
  devices::HandSample sample = mouse(0, 0);
  sample.gamepad.left_trigger = 1;
  sample.gamepad.right_x = 1;
  sim::Input input;
  for (int i = 0; i < 60; ++i) input = pilot.lead(sample, state);
  EXPECT_EQ(input.tools[left].handle, 1.0f);
  EXPECT_EQ(input.tools[right].handle, scene().model.start.tools[right].handle);
  sample.gamepad = {};
  sample.gamepad.set(devices::Button::left_shoulder);
  sample.gamepad.set(devices::Button::right_shoulder);
  sample.gamepad.left_x = 1;
  const sim::Input looked = pilot.lead(sample, state);
  EXPECT_NE(looked.scope.yaw, input.scope.yaw);
  for (const int hand : {left, right}) {
    EXPECT_EQ(looked.tools[hand].yaw, input.tools[hand].yaw);
    EXPECT_EQ(looked.tools[hand].pitch, input.tools[hand].pitch);
    EXPECT_EQ(looked.tools[hand].depth, input.tools[hand].depth);
    EXPECT_EQ(looked.tools[hand].handle, input.tools[hand].handle);
  }
}

TEST(HandPilot, AnInsertionWaitsUnderTheTrocarUntilItIsSeen) {
  sim::State state = sim::initial_state(scene().model);
  attempt::HandPilot pilot(scene().model);
  devices::HandSample back = mouse(0, 0);  // out as far as a changed instrument is
  back.wheel = -60;
  const auto give = [&](const devices::HandSample& sample) {
    const double depth = double(pilot.lead(sample, state).tools[0].depth);
    return state.tools[0].depth = depth;  // it follows at once
  };
  for (int i = 0; i < 12; ++i) give(back);
  ASSERT_LT(state.tools[0].depth, 0.035);
  std::fill(state.seen.begin(), state.seen.end(), std::uint8_t(0));
  devices::HandSample insert = mouse(0, 0);
  insert.pressed.set(devices::Key::v);
  give(insert);
  for (int i = 0; i < 200; ++i) give(mouse(0, 0));
  EXPECT_NEAR(state.tools[0].depth, 0.040, 0.002);
  EXPECT_TRUE(pilot.waits_for_eye(0));
  // The endoscope finds its shaft, then its jaws.
  const sim::VisibilityTarget& shaft =
      scene().model.targets[size_t(scene().model.target_index(scene().model.hands[0].name + ".shaft"))];
  std::fill_n(state.seen.begin() + shaft.first, shaft.count, std::uint8_t(1));
  for (int i = 0; i < 10; ++i) give(mouse(0, 0));
  EXPECT_GT(state.tools[0].depth, 0.043);
  EXPECT_FALSE(pilot.waits_for_eye(0));
  std::fill(state.seen.begin(), state.seen.end(), std::uint8_t(1));
  for (int i = 0; i < 200; ++i) give(mouse(0, 0));
  EXPECT_FALSE(pilot.inserting(0));
  EXPECT_LT(state.tools[0].depth, double(scene().model.start.tools[0].depth));
}

TEST(HandPilot, EClockwiseSeenFromTheHand) {
  const sim::State state = sim::initial_state(scene().model);
  attempt::HandPilot pilot(scene().model);
  devices::HandSample roll = mouse(0, 0);
  roll.held.set(devices::Key::e);
  const kinematics::TipFrame before =
      kinematics::forward(scene().model.hands[0].port, pose_of(scene().model.start.tools[0]));
  sim::Input input;
  for (int i = 0; i < 10; ++i) input = pilot.lead(roll, state);
  const kinematics::TipFrame after = kinematics::forward(scene().model.hands[0].port, pose_of(input.tools[0]));
  // Looking along the shaft, clockwise is a right-handed turn about it.
  EXPECT_GT(dot(cross(before.opening(), after.opening()), before.axis()), 0.1);
}

TEST(HandPilot, TheViewGoesWhereTheMouseGoes) {
  const sim::Model& model = scene().model;
  sim::State state = sim::initial_state(model);
  const kinematics::ScopeFrame before = sim::scope_of(model, state);
  attempt::HandPilot pilot(model);
  devices::HandSample choose = mouse(0, 0);
  choose.pressed.set(devices::Key::zero);
  pilot.lead(choose, state);
  state.scope = pilot.lead(mouse(50, -80), state).scope;
  const kinematics::ScopeFrame after = sim::scope_of(model, state);
  EXPECT_NEAR(dot(after.forward, before.right), 0.05, 2e-3);
  EXPECT_NEAR(dot(after.forward, before.up), 0.08, 2e-3);
}

TEST(SmoothInput, ArrivesWithoutOvershoot) {
  sim::Input target = scene().model.start;
  attempt::SmoothInput smooth(target);
  target.tools[0].depth += 0.02f;
  float last = scene().model.start.tools[0].depth;
  for (int i = 0; i < 300; ++i) {
    const float now = smooth.step(target).tools[0].depth;
    ASSERT_GE(now, last);
    ASSERT_LE(now, target.tools[0].depth);
    last = now;
  }
  EXPECT_NEAR(last, target.tools[0].depth, 1e-6);
}

TEST(MotionSource, HandsComeIntoTheSceneByARotationWithTheirCentroidWhereTheInstrumentStands) {
  devices::MotionTrial trial;
  trial.name = "A/1";
  for (int i = 0; i < 5; ++i) {
    devices::MotionSample s;
    s.time = i;
    s.hands[0].tip = {0.01 * i, 0.002 * i * i, 0.03 - 0.004 * i};
    s.hands[1].tip = {-0.02 * i, 0.001, 0.01 * i};
    trial.samples.push_back(s);
  }
  const sim::Model& model = scene().model;
  const auto hands = attempt::place_hands(model, trial);
  const kinematics::ScopeFrame view = sim::scope_of(model, sim::initial_state(model));
  for (const attempt::HandPlacement& hand : hands) {
    const interactions::ToolModel& tool = model.placed(size_t(hand.tool));
    const Vec3d start = commanded(model.start, hand.tool);
    EXPECT_NEAR(length(hand.to_scene(hand.centroid) - start), 0, 1e-12);
    const Vec3d x = hand.axes.column(0), y = hand.axes.column(1), z = hand.axes.column(2);
    EXPECT_NEAR(dot(cross(x, y), z), 1, 1e-12);
    EXPECT_NEAR(dot(x, y), 0, 1e-12);
    EXPECT_GT(dot(x, view.right), 0.5);
    EXPECT_NEAR(length(z - normalised(start - tool.port)), 0, 1e-12);
  }
  // The left hand leads what comes from the picture's left.
  EXPECT_LT(dot(model.hands[size_t(hands[0].tool)].port - model.hands[size_t(hands[1].tool)].port, view.right), 0);
}

TEST(Session, ForcesAreHeldAgainstTheExercisesOwnLimits) {
  const std::unique_ptr<attempt::Lesson> lesson = attempt::load_lesson("gynaecology/sterilisation");
  for (training::Limit& limit : lesson->exercise->limits) {
    if (limit.name == "pull_limit_N") limit.low = limit.high = 3.25;
    if (limit.name == "pinch_limit_N") limit.low = limit.high = 12.5;
  }
  attempt::Session session(*lesson, 1);
  for (int i = 0; i < 200; ++i) session.advance(lesson->model.start);
  const Json forces = session.result(false)["metrics"]["both"]["forces"];
  EXPECT_EQ(forces["pull"]["limit_N"], 3.25);
  EXPECT_EQ(forces["pinch"]["limit_N"], 12.5);
}

TEST(Session, DrawingOrNotWatchingOrNotTheSameBits) {
  attempt::Session watched(scene(), 1), alone(scene(), 2);
  sim::Input input = scene().model.start;
  for (int i = 0; i < 200; ++i) {
    input.tools[0].depth += 1e-4f;
    watched.advance(input);
    static_cast<void>(watched.result(false));
    static_cast<void>(sim::display_bytes(scene().model, watched.state()));
    alone.advance(input);
  }
  EXPECT_EQ(sim::hash_of(watched.state()), sim::hash_of(alone.state()));
  EXPECT_NEAR(watched.path_length(0), 0.02, 1e-4);
}

}  // namespace
}  // namespace trocar::attempt
