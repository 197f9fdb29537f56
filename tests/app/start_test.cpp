// The start screen without a window: the order of exercises, what comes next, results for people, settings of persons.
#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "shell/settings.hpp"
#include "shell/window.hpp"
#include "start/catalogue.hpp"
#include "start/children.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

attempt::ExerciseEntry exercise_named(const std::string& name, const std::string& group, bool task = true) {
  attempt::ExerciseEntry e;
  e.name = name;
  e.title = "Title of " + name;
  e.group = group;
  e.task = task;
  return e;
}

std::vector<attempt::ExerciseEntry> some_exercises() {
  return {exercise_named("camera", "basics"), exercise_named("clip", "basics"), exercise_named("own", ""),
          exercise_named("stitch", "suturing"), exercise_named("liver", "free practice", false)};
}

PastAttempt attempt_at(const std::string& exercise, double score, bool passed) {
  PastAttempt a;
  a.exercise = exercise;
  a.mode = "assessed";
  a.state = "finished";
  a.score = score;
  a.passed = passed;
  a.seconds = 60;
  return a;
}

TEST(Catalogue, GroupsFollowTheLearningOrderAndFreePracticeIsLast) {
  std::vector<std::string> titles;
  for (const Group& g : groups_of(some_exercises(), {})) titles.push_back(g.title);
  EXPECT_EQ(titles, (std::vector<std::string>{"Basics", "Suturing", "Other exercises", "Free practice"}));
}

TEST(Catalogue, EveryShippedExerciseHasAGroupAndFreeScenesAreFreePractice) {
  for (const attempt::ExerciseEntry& e : attempt::list_trainings(TROCAR_SOURCE_DIR "/scenes")) {
    EXPECT_FALSE(e.group.empty()) << e.name;
    EXPECT_EQ(e.task, e.group != "free practice") << e.name;
    if (!e.task) continue;
    EXPECT_GE(e.level, 1) << e.name;
    EXPECT_GT(e.expert_time, 0) << e.name;
    EXPECT_GT(e.pass_mark, 0) << e.name;
    EXPECT_FALSE(e.summary.empty()) << e.name;
  }
}

TEST(Catalogue, ACameraExerciseComesFirstAndWholeOperationsLast) {
  const std::vector<attempt::ExerciseEntry> all = attempt::list_trainings(TROCAR_SOURCE_DIR "/scenes");
  EXPECT_EQ(all[std::size_t(next_for(all, {}))].name, "basics/camera-0");
  for (const Group& g : groups_of(all, {})) {
    if (g.name != "gallbladder") continue;
    EXPECT_EQ(all[std::size_t(g.exercises.front())].name, "cholecystectomy/expose");
    EXPECT_EQ(all[std::size_t(g.exercises.back())].name, "cholecystectomy/operation-inflamed");
  }
}

TEST(Catalogue, NextIsTheFirstThatWasNotPassed) {
  const std::vector<attempt::ExerciseEntry> all = some_exercises();
  Standings standings = standings_of({attempt_at("camera", 90, true), attempt_at("clip", 20, false)});
  EXPECT_EQ(next_for(all, standings), 1);
  standings["clip"].passed = standings["stitch"].passed = true;
  EXPECT_EQ(next_for(all, standings), 2);
  standings["own"].passed = true;
  EXPECT_EQ(next_for(all, standings), -1) << "free practice has nothing to pass";
}

TEST(Catalogue, SearchFindsEveryWordInTitleSummaryOrGroup) {
  attempt::ExerciseEntry e = exercise_named("calot", "gallbladder");
  e.title = "Dissect the triangle";
  e.summary = "Free duct and artery.";
  for (const char* words : {"", "TRIANGLE", "duct dissect", "gallbladder", "calot"})
    EXPECT_TRUE(matches(e, words)) << words;
  EXPECT_FALSE(matches(e, "triangle camera"));
}

TEST(Catalogue, OneMinuteIsSingular) {
  EXPECT_EQ(duration_text(25), "about 1 minute");
  EXPECT_EQ(duration_text(75), "about 1 minute");
  EXPECT_EQ(duration_text(240), "about 4 minutes");
}

TEST(Past, BestIsOfAttemptsThatCount) {
  PastAttempt demonstration = attempt_at("camera", 100, true), left = attempt_at("camera", 95, false);
  demonstration.mode = "demonstration";
  left.state = "aborted";
  const Standings s =
      standings_of({demonstration, left, attempt_at("camera", 40, false), attempt_at("camera", 70, false)});
  EXPECT_EQ(s.at("camera").best, 70);
  EXPECT_EQ(s.at("camera").last, 40);
  EXPECT_EQ(s.at("camera").attempts, 2);
  EXPECT_FALSE(s.at("camera").passed);
}

TEST(Past, FreePracticeIsNeverNotPassed) {
  PastAttempt a;
  a.state = "finished";
  a.mode = "free practice";
  EXPECT_EQ(result_of(a), "Free practice");
  a.mode = "assessed";  // as older versions kept it
  EXPECT_EQ(result_of(a), "Free practice");
  EXPECT_EQ(result_of(attempt_at("camera", 85, true)), "85 of 100, passed");
}

TEST(Past, AttemptsOfAFewSecondsThatWereLeftAreNotListed) {
  PastAttempt a = attempt_at("camera", 0, false);
  a.seconds = 2;
  EXPECT_TRUE(worth_listing(a)) << "it was finished";
  a.state = "aborted";
  EXPECT_FALSE(worth_listing(a));
  a.seconds = 40;
  EXPECT_TRUE(worth_listing(a));
}

TEST(Past, NamesOfProgramsAreNobodys) {
  EXPECT_TRUE(is_reserved_name("scripted surgeon"));
  EXPECT_FALSE(is_reserved_name("Ada"));
}

TEST(PersonSettings, EachPersonHasOwnOnesAndANewPersonTheDefaults) {
  Settings s;
  choose_person(s, "Ada");
  s.left_handed = true;
  s.text_size = 1.3;
  choose_person(s, "Bob");
  EXPECT_FALSE(s.left_handed);
  EXPECT_EQ(s.text_size, 1.3) << "of the machine";
  s.both_hands = true;
  choose_person(s, "");
  EXPECT_FALSE(s.both_hands || s.left_handed);
  choose_person(s, "Ada");
  EXPECT_TRUE(s.left_handed);
  EXPECT_FALSE(s.both_hands);
  ASSERT_EQ(s.others.size(), 1u);
  EXPECT_EQ(s.others[0].name, "Bob");
}

TEST(PersonSettings, AreWrittenReadAndForgotten) {
  const fs::path file = fs::temp_directory_path() / ("trocar_people_" + std::to_string(getpid())) / "settings.json";
  Settings s;
  choose_person(s, "Ada");
  s.show_hint = false;
  choose_person(s, "Bob");
  s.mouse = 2;
  write_settings(file, s);
  std::vector<core::Fault> faults;
  EXPECT_EQ(read_settings(file, faults), s);
  EXPECT_TRUE(faults.empty());
  EXPECT_TRUE(forget_in_settings(file, "Ada"));
  EXPECT_TRUE(read_settings(file, faults).others.empty());
  fs::remove_all(file.parent_path());
}

TEST(PersonSettings, OfAnOlderFileBelongToItsTrainee) {
  const scene::MemoryFiles files{
      {"settings.json", "{\"format\": 1, \"trainee\": \"Ada\", \"left_handed\": true, \"text_size\": 2.5}"}};
  std::vector<core::Fault> faults;
  Settings s = read_settings("settings.json", faults, &files);
  EXPECT_TRUE(faults.empty());
  EXPECT_TRUE(s.left_handed);
  EXPECT_EQ(s.text_size, kMostText);
  choose_person(s, "Bob");
  EXPECT_FALSE(s.left_handed);
}

TEST(PersonSettings, DefaultsKeepEveryName) {
  Settings s;
  choose_person(s, "Ada");
  choose_person(s, "Bob");
  s.left_handed = true;
  reset_settings(s);
  EXPECT_EQ(s.trainee, "Bob");
  EXPECT_EQ(s.others.size(), 1u);
  EXPECT_FALSE(s.left_handed);
}

TEST(PersonSettings, DirectionsAreOneChoice) {
  PersonSettings p;
  EXPECT_EQ(directions_of(p), Directions::screen);
  set_directions(p, Directions::theatre);
  EXPECT_TRUE(p.invert_x && p.invert_y && p.invert_view_x && p.invert_view_y);
  p.invert_view_x = false;
  EXPECT_EQ(directions_of(p), Directions::custom);
}

TEST(TextFit, GrowsWithTheWindow) {
  EXPECT_FLOAT_EQ(fit_of(1280, 720, 1), 1);
  EXPECT_FLOAT_EQ(fit_of(1920, 1080, 1), 1.5);
  EXPECT_FLOAT_EQ(fit_of(2560, 1440, 2), 1) << "the display's own scale already doubles it";
  EXPECT_FLOAT_EQ(fit_of(400, 300, 1), 0.8f);
}

TEST(Children, MessagesLoseTimesAndLevels) {
  EXPECT_EQ(last_lines("[12:00:01] [warning] one\n\ntwo\nthree\n", 2), "two\nthree");
  EXPECT_EQ(last_lines("[12:00:01] [warning] one\n", 2), "one");
}

}  // namespace
}  // namespace trocar::app
