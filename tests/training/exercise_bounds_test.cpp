// Bounds of an exercise's files are asked before work is done: small files that would come to something huge, and large
// ones, are refused at once.
#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/expert/demonstration.hpp>

#include "changed_exercise.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += (i > 0 ? "," : "") + text;
  return all;
}
std::string numbered(const char* before, std::size_t count, const char* after) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += (i > 0 ? "," : "") + (before + std::to_string(i)) + after;
  return all;
}

const std::string kNow = R"({"fact": "attempt.time_s", "min": 1})";
const std::string kStep = R"({"step": "a", "title": "A", "when": )" + kNow + "}";
const std::string kSet = R"("g": [)" + numbered("\"e", kMaxElements, "\"") + "]";

/// An exercise with these texts for its keys; `more` are further ones.
std::string text_of(const std::string& steps, const std::string& sets = "", const std::string& more = "") {
  return R"({"format": 3, "name": "small", "title": "Small", "scene": "scene.json", "hold_s": 0.2, "expert_s": 10,
    "score": {"quality": 60, "time": 25, "motion": 15, "source": "our estimate"}, "longest_s": 100, "pass_mark": 50,
    "sets": {)" +
         sets + R"(}, "steps": [)" + steps + "]" + more + "}";
}

/// What the readers say of it, without a scene; each takes far below a second of a quiet core.
Faults faults_of(const std::string& text) {
  constexpr std::chrono::seconds kPatience{20};  // a hundred times what it takes: without the bounds it takes for ever
  const auto begun = std::chrono::steady_clock::now();
  Faults faults;
  const Exercise e = read_exercise(kChanged, faults, files_with(text));
  if (faults.empty()) check_demonstration(e, nullptr, faults);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, kPatience);
  EXPECT_LE(faults.size(), scene::kMaxFaults + 1);
  return faults;
}
void expect_refused(const std::string& text, const std::string& says) {
  const Faults faults = faults_of(text);
  ASSERT_FALSE(faults.empty()) << says;
  EXPECT_NE(faults.front().message.find(says), std::string::npos) << faults.front().message;
  EXPECT_EQ(faults.size(), 1u) << "one fault, not what follows from it: " << faults.back().message;
}

std::string nested(int levels) {
  return levels == 0 ? kNow : R"({"any": [)" + nested(levels - 1) + R"(], "for_each": "g"})";
}
std::string step_when(const std::string& condition) {
  return R"({"step": "a", "title": "A", "when": )" + condition + "}";
}
std::string demonstration(const std::string& goals) { return R"(, "demonstration": [)" + goals + "]"; }

TEST(ExerciseBounds, AFileWithinThemIsGood) {
  EXPECT_TRUE(faults_of(text_of(step_when(nested(2)), kSet)).empty());
  EXPECT_TRUE(faults_of(text_of(kStep, kSet, demonstration(R"({"goal": "g", "do": [{"skill": "hold"}]})"))).empty());
}

TEST(ExerciseBounds, ConditionsWithinEachOtherAreCountedOnceForEachElement) {
  for (const int levels : {3, 4, 6, 12})
    expect_refused(text_of(step_when(nested(levels)), kSet), "at most 100000 conditions, names and skills");
  expect_refused(text_of(kStep, kSet,
                         demonstration(R"({"for_each": "g", "goals": [{"goal": "x", "until": )" + nested(3) +
                                       R"(, "do": [{"skill": "hold"}]}]})")),
                 "at most 100000 conditions, names and skills");
}

TEST(ExerciseBounds, StepsAndErrorsAreCountedFirst) {
  const std::string after = R"(", "title": "A", "after": "previous", "when": )" + kNow + "}";
  for (const std::size_t count : {65u, 3000u})
    expect_refused(text_of(numbered(R"({"step": "s)", count, after.c_str())), "at most 64 items for \"steps\"");
  const std::string error = R"(", "name": "n", "points": 1, "meaning": "m", "source": "s", "when": )" + kNow + "}";
  expect_refused(text_of(kStep, "", R"(, "errors": [)" + numbered(R"({"code": "E)", 513, error.c_str()) + "]"),
                 "at most 512 items for \"errors\"");
  const std::string each =
      R"(", "for_each": "g", "name": "n", "points": 1, "meaning": "m", "source": "s", "when": )" + kNow + "}";
  expect_refused(text_of(kStep, kSet, R"(, "errors": [)" + numbered(R"({"code": "E)", 9, each.c_str()) + "]"),
                 "at most 512 errors (one for each element), got 576");
}

TEST(ExerciseBounds, SetsAreCountedBeforeTheyAreMade) {
  expect_refused(text_of(kStep, R"("g": [)" + numbered("\"e", 30000, "\"") + "]"), "at most 64 elements of a set");
  std::string sets;
  for (int i = 0; i <= kMaxSets; ++i) sets += (i > 0 ? ", \"s" : "\"s") + std::to_string(i) + "\": [\"a\"]";
  expect_refused(text_of(kStep, sets), "at most 32 sets");
  expect_refused(text_of(kStep, R"("g": [{"name": "a", "title": ")" + std::string(201, 'x') + "\"}]"),
                 "at most 200 bytes");
}

TEST(ExerciseBounds, NamesThatStandForManyAreCounted) {
  // Each of 64 elements stands for 64 times the 64 names of another set.
  const auto set_of = [](const std::string& name, const std::string& members) {
    const std::string before = "{\"name\": \"" + name, after = "\", \"m\": [" + members + "]}";
    return "\"" + name + "\": [" + numbered(before.c_str(), kMaxElements, after.c_str()) + "]";
  };
  const std::string sets = set_of("few", "\"x\"") + ", " + set_of("g", repeated("\"$few.m\"", 64));
  const std::string error = R"({"code": "E", "name": "n", "points": 1, "meaning": "m", "source": "s",
    "on": {"event": "grasped", "on": "$g.m"}})";
  expect_refused(text_of(kStep, sets, R"(, "errors": [)" + error + "]"), "names and skills");
}

TEST(ExerciseBounds, SkillsAreCountedOnceForEachElement) {
  const std::string goal = R"({"goal": "x", "do": [)" + repeated(R"({"skill": "hold"})", 1000) + "]}";
  expect_refused(text_of(kStep, kSet, demonstration(R"({"for_each": "g", "goals": [)" + repeated(goal, 20) + "]}")),
                 "at most 100000 conditions, names and skills");
}

TEST(ExerciseBounds, AFileOfVeryManyValuesIsRefusedWhileItIsRead) {
  const std::string goal = R"({"goal": "x", "do": [)" + repeated(R"({"skill": "hold"})", 1000) + "]}";
  expect_refused(text_of(kStep, kSet, demonstration(repeated(goal, 100))), "at most 100000 values in a file");
  expect_refused(
      text_of(kStep, "",
              R"(, "sources": ["only one")" + std::string(8 << 20, ' ') + "\"" + std::string(4097, 'x') + "\"]"),
      "expected ',' or ']'");
  expect_refused(text_of(kStep, "", R"(, "sources": [")" + std::string(8 << 20, '{') + "\"]"),
                 "a text of at most 4096 bytes");
}

TEST(ExerciseBounds, IncludedFilesCountTogether) {
  scene::MemoryFiles files;
  std::string names;
  for (int i = 0; i < 16; ++i) {
    const std::string name = "part_" + std::to_string(i) + ".json";
    names += (i > 0 ? ", \"" : "\"") + name + "\"";
    files["scenes/changed/" + name] = R"({"format": 3, "title": "A part", "sources": [)" + repeated("\"x\"", 900) +
                                      R"(], "later": [)" + repeated("1", 9000) + "]}";
  }
  Faults faults;
  files[kChanged] = text_of(kStep, "", R"(, "includes": [)" + names + "]");
  read_exercise(kChanged, faults, &files);
  const auto says = [&](const char* text) {
    return std::any_of(faults.begin(), faults.end(),
                       [text](const core::Fault& f) { return f.message.find(text) != std::string::npos; });
  };
  EXPECT_TRUE(says("at most 100000 values in all files of an exercise together")) << faults.front().message;
  expect_refused(text_of(kStep, "", R"(, "includes": [)" + repeated("\"x.json\"", 17) + "]"),
                 "at most 16 items for \"includes\"");
}

TEST(ExerciseBounds, AnIncludedFileThatIsMissingIsTheOnlyFault) {
  expect_refused(text_of(R"({"step": "a", "title": "A", "when": {"fact": "attempt.time_s", "min": "$limit_s"}})", "",
                         R"(, "includes": ["nowhere.json"])"),
                 "expected a file, got none of this name");
}

TEST(ExerciseBounds, PatternsTakeNoLongerThanTheProductOfTheLengths) {
  EXPECT_TRUE(matches("*", ""));
  EXPECT_TRUE(matches("a*", "a"));
  EXPECT_TRUE(matches("*b*d", "abcbcd"));
  EXPECT_TRUE(matches("niche_*", "niche_12"));
  EXPECT_TRUE(matches("**a**", "xay"));
  EXPECT_FALSE(matches("niche_*", "niche"));
  EXPECT_FALSE(matches("*b*d", "abcbc"));
  EXPECT_FALSE(matches("", "a"));
  EXPECT_FALSE(matches("a*b*c", "acb"));
  EXPECT_FALSE(matches(std::string(100'000, '*') + "x", std::string(64, 'a')));
  std::string pairs;
  for (int i = 0; i < 2000; ++i) pairs += "*a";
  EXPECT_FALSE(matches(pairs + "b", std::string(2000, 'a')));
}

TEST(ExerciseBounds, TextsOfOpenBracesTakeNoTime) {
  const std::string braces(4000, '{');
  std::string errors;
  for (int i = 0; i < 500; ++i)
    errors += (i > 0 ? "," : "") + (R"({"code": "E)" + std::to_string(i)) +
              R"(", "name": "n", "points": 1, "source": "s", "meaning": ")" + braces + R"(", "when": )" + kNow + "}";
  EXPECT_TRUE(faults_of(text_of(kStep, "", R"(, "errors": [)" + errors + "]")).empty());
}

TEST(ExerciseBounds, ManyFaultsCostNoMoreThanTheirWords) {
  std::string errors;
  for (int i = 0; i < 500; ++i)
    errors += (i > 0 ? "," : "") + (R"({"code": "E)" + std::to_string(i)) +
              R"(", "name": "n", "points": 1, "source": "s", "meaning": "m", "when": )" + kNow + R"(, "implies": [)" +
              numbered("\"", 60, (std::string(55, 'x') + "\"").c_str()) + "]}";
  EXPECT_EQ(faults_of(text_of(kStep, "", R"(, "errors": [)" + errors + "]")).size(), scene::kMaxFaults + 1);
}

TEST(ExerciseBounds, ASetInACircleIsAFaultAlsoWhereNothingAsksForIt) {
  for (const char* sets : {R"("a": ["$a"])", R"("a": ["$b"], "b": ["$a"])"}) {
    const Faults faults = faults_of(text_of(kStep, sets));
    ASSERT_FALSE(faults.empty()) << sets;
    EXPECT_NE(faults.front().message.find("a set that contains itself"), std::string::npos) << faults.front().message;
  }
}

TEST(ExerciseBounds, ChoicesAreInOrderAndSeedsAsLargeAsANumberHolds) {
  const auto rehearsed = [](const std::string& seed, const std::string& choices) {
    return text_of(kStep, "", R"(, "rehearsed": [{"seed": )" + seed + R"(, "choices": )" + choices + "}]");
  };
  EXPECT_TRUE(faults_of(rehearsed("9007199254740991", "[[1, 2], [4, 1]]")).empty());
  expect_refused(rehearsed("3", "[[1, 2], [1, 3]]"), "ascending decision points, each once, got 1 after 1");
  expect_refused(rehearsed("3", "[[5, 2], [1, 3]]"), "ascending decision points, each once, got 1 after 5");
}

}  // namespace
