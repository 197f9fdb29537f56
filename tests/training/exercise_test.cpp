// The exercise file: what is read, and that every fault of it is found and located.
#include <algorithm>
#include <filesystem>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/training/exercise/monitor.hpp>

#include "changed_exercise.hpp"

using namespace trocar;
using namespace trocar::training;

namespace {

const char* const kShipped = TROCAR_SOURCE_DIR "/scenes/gynaecology/sterilisation.json";

class ExerciseFile : public testing::Test {
 protected:
  /// Replaces the first occurrence of `from` and notes its line.
  void change(const std::string& from, const std::string& to) {
    const size_t at = m_text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    m_line = 1 + int(std::count(m_text.begin(), m_text.begin() + std::ptrdiff_t(at), '\n'));
    m_text.replace(at, from.size(), to);
  }
  Faults faults() const {
    Faults found;
    read_exercise(kChanged, found, files_with(m_text));
    return found;
  }
  /// Where the change is (the object around it begins some lines before), and perhaps others that follow from it.
  void expect_fault(const std::string& saying) {
    std::string all;
    bool found = false;
    for (const core::Fault& f : faults()) {
      all += to_string(f) + "\n";
      EXPECT_GT(f.at.line, 0) << to_string(f);
      found =
          found || (f.at.line >= m_line - 8 && f.at.line <= m_line + 1 && f.message.find(saying) != std::string::npos);
    }
    EXPECT_TRUE(found) << "line " << m_line << ", " << saying << "\n" << all;
  }
  void expect_one_fault(const std::string& saying) {
    const Faults found = faults();
    std::string all;
    for (const core::Fault& f : found) all += to_string(f) + "\n";
    ASSERT_EQ(found.size(), 1u) << all;
    EXPECT_EQ(found[0].at.line, m_line) << all;
    EXPECT_GT(found[0].at.column, 0);
    EXPECT_NE(found[0].message.find(saying), std::string::npos) << all;
  }

  std::string m_text = text_of_scene_file("gynaecology/sterilisation.json");
  int m_line = 0;
};

TEST_F(ExerciseFile, AsShippedItIsRead) {
  EXPECT_TRUE(faults().empty());
  const Exercise e = read_exercise(kShipped);
  EXPECT_EQ(e.name, "sterilisation");
  EXPECT_EQ(e.group, "gynaecology");
  EXPECT_EQ(e.level, 2);
  EXPECT_TRUE(std::filesystem::exists(e.scene)) << e.scene;
  EXPECT_NEAR(e.limit("clip_angle_deg", 0), 15 * std::numbers::pi / 180, 1e-12);
  EXPECT_DOUBLE_EQ(e.limit("cut_margin_mm", 0), 0.002);
  EXPECT_DOUBLE_EQ(e.limit("pull_limit_N", 0), 4) << "of the common rules";
  ASSERT_NE(e.penalty("E11"), nullptr);
  EXPECT_TRUE(e.penalty("E11")->fail);
  EXPECT_EQ(e.penalty("E99"), nullptr);
  EXPECT_EQ(e.penalty("E12")->leaves.size(), 2u) << "what the exercise adds to the common rules";
  EXPECT_EQ(e.penalty("E1")->meaning, "Pulled with more than 4 N on delicate tissue, or more than 8 N on other tissue");
}

TEST_F(ExerciseFile, EveryLimitSaysWhereItComesFrom) {
  for (const Limit& l : read_exercise(kShipped).limits) EXPECT_FALSE(l.source.empty()) << l.name;
}

TEST_F(ExerciseFile, OfFormat2IsNotReadAnyMore) {
  change("\"format\": 3", "\"format\": 2");
  expect_one_fault("docs/guides/authoring_exercises.md");
}

TEST_F(ExerciseFile, AMissingKeyIsLocated) {
  change("\"pass_mark\": 80,", "");
  const Faults found = faults();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("pass_mark"), std::string::npos) << found[0].message;
  EXPECT_GT(found[0].at.line, 0);
}

struct Spoilt {
  const char *name, *from, *to, *saying;
};
void PrintTo(const Spoilt& s, std::ostream* os) { *os << s.name; }

class SpoiltFile : public ExerciseFile, public testing::WithParamInterface<Spoilt> {};

TEST_P(SpoiltFile, HasAFaultThatIsLocatedAndSaysWhy) {
  change(GetParam().from, GetParam().to);
  expect_fault(GetParam().saying);
}

INSTANTIATE_TEST_SUITE_P(
    Of, SpoiltFile,
    testing::Values(
        Spoilt{"AnUnknownKey", "\"hold_s\": 0.2,", "\"hold_s\": 0.2, \"hold_ms\": 200,", "hold_ms"},
        Spoilt{"ANumberOutOfRange", "\"pass_mark\": 80", "\"pass_mark\": 800", "expected"},
        Spoilt{"AnUnknownGroup", "\"group\": \"gynaecology\"", "\"group\": \"gyn\"", "gynaecology"},
        Spoilt{"ALevelOutOfRange", "\"level\": 2", "\"level\": 4", "expected"},
        Spoilt{"TimesThatLeaveNothingInBetween", "\"longest_s\": 900", "\"longest_s\": 240", "expert_s"},
        Spoilt{"ALimitOfAnotherType", "\"survey_s\": {\"value\": 1", "\"survey_s\": {\"value\": \"one\"", "a number"},
        Spoilt{"ALimitWithoutASource", "\"cut_fraction\": {\"value\": 0.99, \"source\": \"our estimate\"}",
               "\"cut_fraction\": {\"value\": 0.99}", "source"},
        Spoilt{"AnEmptyRange", "\"value\": [12, 20]", "\"value\": [22, 20]", "from <= to"},
        Spoilt{"ALimitThatNothingUses", "\"check_s\": {\"value\": 2, \"source\": \"our estimate\"}",
               "\"check_s\": {\"value\": 2, \"source\": \"our estimate\"}, \"spare_mm\": {\"value\": 2, \"source\": "
               "\"our estimate\"}",
               "a limit that is used"},
        Spoilt{"AnUnknownLimit", "\"for_s\": \"$check_s\"", "\"for_s\": \"$chek_s\"", "did you mean \"check_s\""},
        Spoilt{"ALimitOfAnotherUnit", "\"cover\": {\"below\": \"$clip_cover\"}",
               "\"cover\": {\"below\": \"$cut_depth_mm\"}", "unit"},
        Spoilt{"AnUnknownKeyInAHint", "\"hint\": \"Move the endoscope", "\"hint\": \"{key:endoscop} Move the endoscope",
               "did you mean \"endoscope\""},
        Spoilt{"AnUnknownFact", "\"fact\": \"mark.seen_for_s\", \"of\": \"uterus\"",
               "\"fact\": \"mark.sen_for_s\", \"of\": \"uterus\"", "did you mean \"mark.seen_for_s\""},
        Spoilt{"AnUnknownEvent", "{\"event\": \"clipped\", \"on\": {\"not\"",
               "{\"event\": \"cliped\", \"on\": {\"not\"", "did you mean \"clipped\""},
        Spoilt{"AnUnknownAttribute", "\"s_mm\": {\"above\": \"$ampulla_mm\"}",
               "\"place_mm\": {\"above\": \"$ampulla_mm\"}", "place_mm"},
        Spoilt{"AMissingArgument", "\"of\": \"uterus\", \"share\": \"$organ_share\",", "\"of\": \"uterus\",",
               "\"share\""},
        Spoilt{"AnArgumentOutOfRange", "\"share\": 0.5", "\"share\": 1.5", "[0, 1]"},
        Spoilt{"ANumberThatTheFactCannotBe", "\"min\": \"$straightness\"}", "\"min\": 1.5}", "a possible value"},
        Spoilt{"ANumberThatAnAttributeCannotBe", "\"angle_deg\": {\"above\": \"$clip_oblique_deg\"}",
               "\"angle_deg\": {\"min\": 500}", "a possible value of \"angle_deg\", 0 to 90 deg, got at least 500"},
        Spoilt{"ACountThatAnAttributeCannotBe", "\"tips_visible\": {\"below\": 2}", "\"tips_visible\": 3",
               "a possible value of \"tips_visible\", 0 to 2, got 3"},
        Spoilt{"ASizeThatNothingHas", "{\"fact\": \"strand.straightness\",",
               "{\"fact\": \"scope.horizon_deg\", \"max_abs\": -1}, {\"fact\": \"strand.straightness\",",
               "a possible value"},
        Spoilt{"ATruthThatIsHeldAgainstANumber", "\"kind\": \"grasper\"}", "\"kind\": \"grasper\", \"min\": 1}",
               "true or false"},
        Spoilt{"AnUnknownWord", "\"kind\": \"grasper\"}", "\"kind\": \"graspers\"}", "did you mean \"grasper\""},
        Spoilt{"AnUnknownSet", "\"step\": \"identify\",\n      \"for_each\": \"side\"",
               "\"step\": \"identify\",\n      \"for_each\": \"sides\"", "did you mean \"side\""},
        Spoilt{"AnUnknownMemberOfAnElement", "\"strand\": \"$side.tube\"", "\"strand\": \"$side.tub\"",
               "did you mean \"tube\""},
        Spoilt{"AnUnknownStep", "{\"not\": {\"step\": \"identify($side)\"}}},",
               "{\"not\": {\"step\": \"identfy($side)\"}}},", "did you mean"},
        Spoilt{"AStepTwice", "\"step\": \"check\"", "\"step\": \"cut\"", "each step once"},
        Spoilt{"AnErrorThatNothingPrices", "\"points\": 20,", "", "a penalty"},
        Spoilt{"AnErrorThatMayBringAnUnknownOne", "\"may\": [\"E4.1\", \"E4.2\"]", "\"may\": [\"E4.1\", \"E4.22\"]",
               "E4.22"},
        Spoilt{"AnErrorTwice", "\"code\": \"A1.2\"", "\"code\": \"A1.1\"", "each code once"},
        Spoilt{"ACommonErrorThatIsMadeBySomethingElse", "{\"code\": \"E12\",",
               "{\"code\": \"E12\", \"on\": {\"event\": \"cut\"},", "stricter"},
        Spoilt{"ACommonErrorThatBecomesCheaper", "{\"code\": \"E12\",", "{\"code\": \"E12\", \"points\": 1,",
               "at least 3"},
        Spoilt{"ACommonLimitThatIsLoosened", "\"limits\": {",
               "\"limits\": {\"pull_limit_N\": {\"value\": 5, \"source\": \"our estimate\"},", "at least as strict"}),
    [](const auto& of) { return of.param.name; });

TEST_F(ExerciseFile, ACommonLimitMayBeMadeStricter) {
  change("\"limits\": {", "\"limits\": {\"pull_limit_N\": {\"value\": 3, \"source\": \"our estimate\"},");
  EXPECT_TRUE(faults().empty());
  Faults none;
  const Exercise e = read_exercise(kChanged, none, files_with(m_text));
  EXPECT_DOUBLE_EQ(e.limit("pull_limit_N", 0), 3);
  EXPECT_NE(e.penalty("E1")->meaning.find("3 N"), std::string::npos) << "and people are told so";
}

TEST_F(ExerciseFile, ACommonLimitIsLoosenedOnlyWithAReason) {
  change("\"limits\": {",
         "\"limits\": {\"pull_limit_N\": {\"value\": 5, \"source\": \"our estimate\", \"loosened\": \"a model of "
         "rubber\"},");
  EXPECT_TRUE(faults().empty());
}

TEST_F(ExerciseFile, AStepThatNothingCanMakeTrueIsLocated) {
  change("\"when\": {\"all\": [\n        {\"fact\": \"strand.stumps_closed\"",
         "\"undone_when\": {\"all\": [\n        {\"fact\": \"strand.stumps_closed\"");
  const Faults found = faults();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("nothing can make it true"), std::string::npos) << found[0].message;
}

TEST_F(ExerciseFile, ACircleOfStepsIsAFault) {
  change("\"step\": \"present\",", "\"step\": \"present\", \"after\": \"check\",");
  change("\"step\": \"check\",", "\"step\": \"check\", \"needs\": [\"cut\"],");
  change("\"step\": \"cut\",", "\"step\": \"cut\", \"after\": \"previous\", \"needs\": [\"present\"],");
  const Faults found = faults();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("a cycle"), std::string::npos) << found[0].message;
}

TEST_F(ExerciseFile, AllFaultsAreFoundInOnePass) {
  change("\"pass_mark\": 80", "\"pass_mark\": 800");
  change("\"clip_cover\": {\"value\": 0.98", "\"clip_cover\": {\"value\": \"whole\"");
  change("\"fact\": \"strand.followed\"", "\"fact\": \"strand.folowed\"");
  EXPECT_GE(faults().size(), 3u);
}

TEST_F(ExerciseFile, AFileThatIsNotThereIsSaid) {
  EXPECT_THROW(read_exercise("/nowhere/exercise.json"), core::BadInput);
}

// ---- steps that common rules bring along ----------------------------------------------------------------------------

class CommonSteps : public ExerciseFile {
 protected:
  /// With a file of one step more, included.
  Exercise read_with(const std::string& step, Faults& found) {
    change("\"includes\": [", "\"includes\": [\"part.json\", ");
    scene::MemoryFiles files = *files_with(m_text);
    files[kPart] =
        R"({"format": 3, "title": "A part", "limits": {"part_s": {"value": 2, "source": "ours"}}, "steps": [)" + step +
        "]}";
    return read_exercise(kChanged, found, &files);
  }
  static constexpr const char* kPart = "scenes/changed/part.json";
  static constexpr const char* kStep =
      R"({"step": "part", "title": "A part", "when": {"fact": "blood.flow_mL_min", "max": 1}, "for_s": "$part_s"})";
};

TEST_F(CommonSteps, StandBeforeTheExercisesOwn) {
  const Exercise base = read_exercise(kChanged, files_with(m_text));
  Faults found;
  const Exercise e = read_with(kStep, found);
  ASSERT_TRUE(found.empty()) << found[0].message;
  ASSERT_EQ(e.steps.size(), base.steps.size() + 1);
  EXPECT_EQ(e.steps[0].name, "part");
  EXPECT_EQ(e.steps[1].name, base.steps[0].name);
}

TEST_F(CommonSteps, HaveFaultsWhereTheyStand) {
  Faults found;
  read_with(R"({"step": "part", "title": "A part", "when": {"fact": "hand.grabs"}, "for_s": "$part_s"})", found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at.file, kPart);
}

TEST_F(CommonSteps, AreEachThereOnce) {
  Faults found;
  read_with(
      R"({"step": "cut", "title": "A part", "when": {"fact": "blood.flow_mL_min", "max": 1}, "for_s": "$part_s"})",
      found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("each step once"), std::string::npos) << found[0].message;
}

// ---- an exercise that is like another one ---------------------------------------------------------------------------

class LikeAnother : public ExerciseFile {
 protected:
  Exercise twin(const std::string& keys, Faults& found) const {
    scene::MemoryFiles files = *files_with(m_text);
    files[kTwin] = "{\"format\": 3, \"name\": \"twin\", " + keys + "}";
    return read_exercise(kTwin, found, &files);
  }
  static constexpr const char* kTwin = "scenes/changed/twins/twin.json";
  static constexpr const char* kKeys = R"("like": "../exercise.json", "title": "Twin", "scene": "other.json")";
};

TEST_F(LikeAnother, SaysWhatDiffersAndTheRestIsAsThere) {
  Faults found;
  const Exercise base = read_exercise(kChanged, files_with(m_text));
  const Exercise e = twin(std::string(kKeys) + R"(, "pass_mark": 95)", found);
  EXPECT_TRUE(found.empty());
  EXPECT_EQ(e.name, "twin");
  EXPECT_EQ(e.title, "Twin");
  EXPECT_EQ(e.scene.lexically_normal().generic_string(), "scenes/changed/twins/other.json");
  EXPECT_EQ(e.pass_mark, 95);
  EXPECT_EQ(e.expert_time, base.expert_time);
  EXPECT_EQ(e.steps.size(), base.steps.size());
  EXPECT_EQ(e.penalties.size(), base.penalties.size()) << "with those of the common rules, named relative to that file";
  EXPECT_EQ(e.limits.size(), base.limits.size());
  EXPECT_EQ(e.demonstration.file, base.demonstration.file);
}

TEST_F(LikeAnother, AKeyReplacesTheOtherFilesAsAWhole) {
  Faults found;
  const Exercise e = twin(std::string(kKeys) + R"(, "includes": [])", found);
  EXPECT_FALSE(found.empty()) << "what the steps decide by is not there any more";
  for (const Limit& l : e.limits) EXPECT_EQ(l.at.file, kChanged) << l.name;
}

TEST_F(LikeAnother, ALimitReplacesThatOneAlone) {
  Faults found;
  const Exercise base = read_exercise(kChanged, files_with(m_text));
  const auto own = std::find_if(base.limits.begin(), base.limits.end(),
                                [](const Limit& l) { return l.at.file == kChanged && !l.is_range; });
  ASSERT_NE(own, base.limits.end());
  const Exercise e =
      twin(std::string(kKeys) + R"(, "limits": {")" + own->name + R"(": {"value": 7, "source": "ours"}})", found);
  EXPECT_TRUE(found.empty()) << found[0].message;
  ASSERT_EQ(e.limits.size(), base.limits.size());
  for (const Limit& l : base.limits) {
    if (l.is_range) continue;
    const double as_there = base.limit(l.name, -1);
    EXPECT_DOUBLE_EQ(e.limit(l.name, -1), l.name == own->name ? as_there * 7 / l.low : as_there) << l.name;
  }
}

TEST_F(LikeAnother, ALimitOfCommonRulesIsNotLoosenedByTheWay) {
  Faults found;
  twin(std::string(kKeys) + R"(, "limits": {"lost_mL": {"value": 1000, "source": "ours"}})", found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at.file, kTwin);
  EXPECT_NE(found[0].message.find("at least as strict"), std::string::npos) << found[0].message;
}

TEST_F(LikeAnother, ItsFaultsAreToldWhereTheyStand) {
  change("\"pass_mark\": 80", "\"pass_mark\": 800");
  Faults found;
  twin(kKeys, found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].at.file, kChanged);
  EXPECT_EQ(found[0].at.line, m_line);
}

TEST_F(LikeAnother, TitleAndSceneItSaysItself) {
  Faults found;
  twin(R"("like": "../exercise.json")", found);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NE(found[0].message.find("\"title\""), std::string::npos);
  EXPECT_NE(found[1].message.find("\"scene\""), std::string::npos);
}

TEST_F(LikeAnother, ACircleIsAFault) {
  Faults found;
  twin(R"("like": "twin.json", "title": "Twin", "scene": "other.json")", found);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("without a cycle"), std::string::npos) << found[0].message;
}

TEST_F(ExerciseFile, TornAnywhereItIsAFaultAndNotACrash) {
  const std::string whole = m_text;
  for (size_t n = 0; n + 3 < whole.size(); n += 197) {
    m_text = whole.substr(0, n);
    EXPECT_FALSE(faults().empty()) << "after " << n << " bytes";
  }
}

}  // namespace
