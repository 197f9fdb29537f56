// What is controlled first: the endoscope where an exercise is about the picture, else the hand that its first step
// needs.
#include <gtest/gtest.h>

#include <trocar/attempt/controls/first_control.hpp>
#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>

namespace trocar::attempt {
namespace {

/// What the first sample of a moving mouse moves.
bool something_moves(const Lesson& lesson, int first, bool both) {
  const sim::State state = sim::initial_state(lesson.model);
  HandPilot pilot(lesson.model);
  pilot.choose(first);
  pilot.lead_both(both);
  pilot.choose(first);
  devices::HandSample sample;
  sample.dt = 0.016f;
  pilot.lead(sample, state);
  sample.dx = 5, sample.dy = 3;
  const sim::Input& input = pilot.lead(sample, state);
  if (first == devices::kScope) return input.scope.yaw != lesson.model.start.scope.yaw;
  return input.tools[first].yaw != lesson.model.start.tools[first].yaw;
}

int first_of(const char* exercise) {
  const std::unique_ptr<Lesson> lesson = load_lesson(exercise);
  const int first = first_control(Session(*lesson, 1));
  EXPECT_TRUE(something_moves(*lesson, first, false)) << exercise;
  EXPECT_TRUE(something_moves(*lesson, first, true)) << exercise << ", both hands";
  return first;
}

TEST(FirstControl, IsTheEndoscopeInCameraExercises) {
  EXPECT_EQ(first_of("basics/camera-0"), devices::kScope);
  EXPECT_EQ(first_of("basics/camera-30"), devices::kScope);
}

TEST(FirstControl, ADeclarationInASceneWithoutHandsIsToldAndEndsNothing) {
  const std::unique_ptr<Lesson> lesson = load_lesson("basics/camera-0");
  Session session(*lesson, 1);
  sim::Input input = lesson->model.start;
  input.pedals = sim::kDeclare;
  session.advance(input);
  ASSERT_EQ(session.moments().size(), 1u);
  EXPECT_EQ(session.moments()[0].what, "declared");
}

TEST(FirstControl, IsTheHandThatHoldsTheNeedle) {
  const std::unique_ptr<Lesson> lesson = load_lesson("suturing/needle-through");
  EXPECT_EQ(hand_name(lesson->model, first_control(Session(*lesson, 1))), "right");
}

}  // namespace
}  // namespace trocar::attempt
