// A demonstration that does not succeed as it is written is rehearsed, and succeeds again by the choices alone.
#include <gtest/gtest.h>

#include <trocar/attempt/rehearsal/rehearsal.hpp>
#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/training/expert/performer.hpp>

#include "../training/changed_exercise.hpp"

namespace trocar::attempt {
namespace {

/// A disc seen from 55 mm, where 50 to 52 are asked for.
std::string exercise_seen_from(const char* near, const char* rehearsed = "", const char* tries = "1") {
  return std::string(R"({"format": 3, "name": "see", "title": "See a disc", "scene": "../box_pegs/scene.json",
 "limits": {"near_mm": {"value": )") +
         near + R"(, "source": "test"}},
 "steps": [{"step": "see", "title": "see it", "when": {"fact": "mark.distance_mm", "of": "target_1", "in": "$near_mm"}, "for_s": 0.5}],
 "demonstration": [{"goals": [{"goal": "show it", "until": {"step": "see"}, "tries": )" +
         tries + R"(,
   "do": [{"skill": "view", "mark": "target_1", "from_mm": 55, "for_s": 1}]}]}],)" +
         rehearsed + R"(
 "score": {"quality": 100, "time": 0, "motion": 0, "source": "test"},
 "hold_s": 0.2, "expert_s": 10, "longest_s": 100, "pass_mark": 50})";
}

Lesson lesson_seen_from(const char* near, const char* tries = "1") {
  Lesson lesson;
  lesson.exercise = training::read_exercise(kChanged, files_with(exercise_seen_from(near, "", tries)));
  lesson.model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_pegs/scene.json"));
  return lesson;
}

double score_of(const Lesson& lesson) {
  const std::unique_ptr<training::Expert> expert =
      training::make_expert(*lesson.exercise, lesson.model, {}, lesson.seed);
  const std::unique_ptr<training::Monitor> monitor = lesson.monitor();
  sim::State state = sim::initial_state(lesson.model);
  sim::Work work = sim::make_work(lesson.model);
  while (!expert->done() && state.tick < 60'000) {
    const sim::StepReport report = sim::step(lesson.model, expert->next(lesson.model, state), state, work);
    expert->after(lesson.model, state, report);
    monitor->update(lesson.model, state, report);
  }
  return monitor->score().total;
}

TEST(Rehearsal, WhatFailsAsWrittenSucceedsWithAPerturbationAndAgainByTheChoicesAlone) {
  Lesson lesson = lesson_seen_from("[50, 52]");
  EXPECT_LT(score_of(lesson), 50);
  const Rehearsal r = rehearse(lesson, {.points = 8, .seconds = 600});
  ASSERT_TRUE(r.passed) << r.obstacle;
  EXPECT_GT(r.attempts, 1);
  ASSERT_FALSE(r.choices.empty());
  EXPECT_EQ(r.score, 100);
  lesson.exercise->recorded_choices = {{lesson.seed, r.choices}};
  EXPECT_EQ(score_of(lesson), 100);
  lesson.exercise->recorded_choices = {{lesson.seed + 1, r.choices}};  // of another anatomy
  EXPECT_LT(score_of(lesson), 50);
}

TEST(Rehearsal, WhatSucceedsAsWrittenNeedsNoChoice) {
  const Rehearsal r = rehearse(lesson_seen_from("[54, 56]"), {});
  EXPECT_TRUE(r.passed) << r.obstacle;
  EXPECT_EQ(r.attempts, 1);
  EXPECT_TRUE(r.choices.empty());
}

TEST(Rehearsal, AFailedTryEndsTheAttemptWhereAllMustSucceedAtFirst) {
  const Lesson lesson = lesson_seen_from("[300, 301]", "3");
  const Rehearsal in_the_end = rehearse(lesson, {.points = 8, .seconds = 20});
  const Rehearsal at_first = rehearse(lesson, {.points = 8, .seconds = 20, .at_first = true});
  EXPECT_FALSE(in_the_end.passed);
  EXPECT_FALSE(at_first.passed);
  EXPECT_LT(at_first.lasted, in_the_end.lasted - 1) << "of three tries";
}

TEST(Rehearsal, WhatNoWayLeadsToIsGivenUpWhenTheTimeIsSpentAndSaysWhy) {
  const Rehearsal r = rehearse(lesson_seen_from("[300, 301]"), {.points = 8, .seconds = 20});
  EXPECT_FALSE(r.passed);
  EXPECT_GE(r.seconds, 20);
  EXPECT_LT(r.seconds, 21);
  EXPECT_NE(r.obstacle.find("show it"), std::string::npos) << r.obstacle;
}

TEST(Rehearsal, ChoicesThatAreNoneAreTold) {
  for (const char* wrong : {R"([[1]])", R"([[1, -2]])", R"([[0.5, 1]])", R"([3, 4])", R"("none")"}) {
    const std::string keys = std::string(R"("rehearsed": [{"seed": 1, "choices": )") + wrong + "}],";
    training::Faults faults;
    training::read_exercise(kChanged, faults, files_with(exercise_seen_from("[50, 52]", keys.c_str())));
    ASSERT_FALSE(faults.empty()) << wrong;
    EXPECT_NE(faults.front().message.find("expected"), std::string::npos);
  }
  training::Faults faults;
  const char* twice = R"("rehearsed": [{"seed": 1, "choices": []}, {"seed": 1, "choices": [[2, 3]]}],)";
  training::read_exercise(kChanged, faults, files_with(exercise_seen_from("[50, 52]", twice)));
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults.front().message, "expected each seed once, got it again");
}

}  // namespace
}  // namespace trocar::attempt
