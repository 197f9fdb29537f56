// In every shipped exercise and scene something is under control from the first moment, with one hand and with both.
#include <gtest/gtest.h>

#include <trocar/attempt/controls/first_control.hpp>
#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/paths.hpp>

namespace trocar::attempt {
namespace {

bool moves(HandPilot& pilot, const sim::State& state) {
  devices::HandSample sample;
  sample.dt = 0.016f;
  const sim::Input before = pilot.lead(sample, state);
  sample.dx = 5, sample.dy = 3;
  const sim::Input& after = pilot.lead(sample, state);
  bool moved = after.scope.yaw != before.scope.yaw;
  for (int h = 0; h < sim::kMaxTools; ++h) moved |= after.tools[h].yaw != before.tools[h].yaw;
  return moved;
}

TEST(FirstControl, IsThereInEveryShippedExerciseAndScene) {
  int looked_at = 0;
  for (const ExerciseEntry& entry : list_trainings(scenes_folder())) {
    const std::unique_ptr<Lesson> lesson = load_lesson(entry.name);
    const Session session(*lesson, 1);
    const int first = first_control(session);
    for (const bool both : {false, true}) {
      HandPilot pilot(lesson->model);
      pilot.choose(first);
      pilot.lead_both(both);
      pilot.choose(first);
      EXPECT_TRUE(moves(pilot, session.state())) << entry.name << (both ? ", both hands" : "");
    }
    ++looked_at;
  }
  EXPECT_GT(looked_at, 30);
}

}  // namespace
}  // namespace trocar::attempt
