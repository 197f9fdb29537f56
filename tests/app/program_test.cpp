// The command line as scripts meet it: exit codes, JSON, and recordings that verify or do not.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/json.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "run_program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

std::string read(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A folder of the test's own, gone afterwards.
class Program : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar_app_test_" + std::to_string(getpid()) + "_" +
                                            testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(m_folder);
    setenv("TROCAR_DATA", (m_folder / "data").c_str(), 1);
  }
  void TearDown() override { fs::remove_all(m_folder); }
  std::string file(const std::string& name) const { return (m_folder / name).string(); }

  /// One second of the scene with both hands moving: left.csv-like motion, short enough for a quick test.
  std::string motion_file() const {
    std::ofstream out(file("motion.csv"));
    out << "operator,trial,t_ms,xL,yL,zL,rollL,handleL,xR,yR,zR,rollR,handleR\n";
    out << "A,1,0,0,0,0,0,0,0,0,0,0,0\n";
    out << "A,1,1000,8,2,-6,0.3,0.5,-5,3,4,0.1,0.2\n";
    out << "A,1,2000,3,9,-2,0.1,1,2,-4,-3,0.2,0.9\n";
    return file("motion.csv");
  }

 private:
  fs::path m_folder;
};

TEST_F(Program, EveryCommandHasHelpWithAnExample) {
  for (const std::string command :
       {"train", "replay", "report", "list", "help", "model", "check", "facts", "gallery", "rehearse", "join", "trials",
        "mechanism", "room", "compare", "precompute", "box", "tracker", "bench"}) {
    const Outcome o = trocar({command, "--help"});
    EXPECT_EQ(o.exit, core::kDone) << command;
    EXPECT_NE(o.out.find("Example:\n  trocar " + command), std::string::npos) << o.out;
  }
}

/// As on a machine without a display.
class NoDisplay {
 public:
  NoDisplay() {
    for (const char* name : kNames) {
      if (const char* value = std::getenv(name)) m_values.emplace_back(name, value);
      unsetenv(name);
    }
  }
  ~NoDisplay() {
    for (const auto& [name, value] : m_values) setenv(name.c_str(), value.c_str(), 1);
  }

 private:
  static constexpr const char* kNames[] = {"DISPLAY", "WAYLAND_DISPLAY"};
  std::vector<std::pair<std::string, std::string>> m_values;
};

TEST_F(Program, TheStartScreenNeedsADisplayAndSaysSo) {
  const NoDisplay none;
  for (const std::vector<std::string>& words : {std::vector<std::string>{}, {"train"}, {"train", "--no-store"}}) {
    const Outcome o = trocar(words);
    EXPECT_EQ(o.exit, core::kEnvironment);
    EXPECT_NE(o.err.find("DISPLAY"), std::string::npos) << o.err;
  }
  EXPECT_EQ(trocar({"train", "--headless", "--input", "demo"}).exit, core::kBadInput);
  EXPECT_EQ(trocar({"train", "--input", "demo"}).exit, core::kBadInput);
}

TEST_F(Program, UnknownCommandsAndUnknownOptionsAreBadInput) {
  EXPECT_EQ(trocar({"operate"}).exit, core::kBadInput);
  EXPECT_EQ(trocar({"list", "--fast"}).exit, core::kBadInput);
}

TEST_F(Program, ListKnowsEveryKind) {
  const Outcome o = trocar({"list", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  EXPECT_EQ(o.err, "") << "every shipped file can be read";
  const Json all = o.json();
  const auto has = [&](const char* kind, const char* name) {
    return std::any_of(all[kind].begin(), all[kind].end(), [&](const Json& e) { return e["name"] == name; });
  };
  EXPECT_TRUE(has("exercises", "gynaecology/sterilisation"));
  EXPECT_TRUE(has("scenes", "gynaecology"));
  EXPECT_TRUE(has("instruments", "clip_applier"));
  EXPECT_TRUE(has("mechanisms", "four_bar"));
  EXPECT_TRUE(has("rooms", "telemanipulated"));
  EXPECT_TRUE(has("programmes", "triangle"));
  EXPECT_TRUE(has("materials", "liver"));
  EXPECT_TRUE(has("vessels", "pelvis"));
  EXPECT_TRUE(has("inputs", "two_pads"));
  EXPECT_NE(trocar({"list", "rooms"}).out.find("telemanipulated"), std::string::npos);
  EXPECT_EQ(trocar({"list", "rooms", "--names"}).out, "telemanipulated\n");
  EXPECT_NE(trocar({"list", "organs"}).err.find("known: exercises, scenes"), std::string::npos);
}

/// An exercise that takes all but its title from a shipped one, in the user's own folder.
constexpr const char* kOwnExercise = R"({
  "format": 3,
  "name": "mine",
  "title": "My clips",
  "like": "../basics/clip-application.json",
  "scene": "../box_vessels/scene.json"
})";

TEST_F(Program, OwnExercisesAreListedAndNameShippedFilesAsNeighbours) {
  fs::create_directories(file("data/scenes/own"));
  std::ofstream(file("data/scenes/own/mine.json")) << kOwnExercise;
  const Json all = trocar({"list", "exercises", "--json"}).json();
  EXPECT_TRUE(std::any_of(all["exercises"].begin(), all["exercises"].end(),
                          [](const Json& e) { return e["name"] == "own/mine" && e["title"] == "My clips"; }));
  EXPECT_EQ(trocar({"check", file("data/scenes/own/mine.json")}).exit, core::kDone);
  const Outcome run =
      trocar({"train", "own/mine", "--input", "motion:" + motion_file(), "--headless", "--seconds", "0.02", "--json"});
  EXPECT_EQ(run.exit, core::kDone) << run.err;
}

TEST_F(Program, AnExerciseThatCannotBeReadIsNotListedButItsFaultIs) {
  fs::create_directories(file("data/scenes/own"));
  std::ofstream(file("data/scenes/own/late.json")) << R"({"format": 3, "name": "late", "title": "Late",
    "like": "nowhere.json", "scene": "../box_reach/scene.json"})";
  const Outcome o = trocar({"list", "exercises"});
  EXPECT_EQ(o.exit, core::kDone);
  EXPECT_EQ(o.out.find("own/late"), std::string::npos) << o.out;
  EXPECT_NE(o.err.find("not listed: own/late: "), std::string::npos) << o.err;
}

TEST_F(Program, AMissingCommaIsTheOnlyFaultOfItsFile) {
  std::string text = read(TROCAR_SOURCE_DIR "/scenes/basics/camera-0.json");
  const std::size_t comma = text.find(",\n", text.find("\"title\""));
  text.erase(comma, 1);
  fs::create_directories(file("data/scenes/basics"));
  std::ofstream(file("data/scenes/basics/spoilt.json")) << text;
  const Outcome o = trocar({"check", file("data/scenes/basics/spoilt.json"), "--json"});
  EXPECT_EQ(o.exit, core::kBadInput);
  ASSERT_EQ(o.json()["faults"].size(), 1u) << o.err;
  EXPECT_NE(o.err.find("expected ',' or '}'"), std::string::npos) << o.err;
}

TEST_F(Program, AnUnknownExerciseIsBadInputWithTheNearestName) {
  const Outcome o = trocar({"train", "gynaecology/sterilization", "--input", "demo", "--headless", "--json"});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("gynaecology/sterilisation"), std::string::npos) << o.err;
  EXPECT_EQ(o.json()["exit"], 2);
}

TEST_F(Program, CheckTellsAllFaultsOfAllFilesWithTheirPlaces) {
  std::ofstream(file("a.json")) << "{\n  \"format\": 1,\n  \"name\": \"a\",\n  \"solids\": 7\n}\n";
  std::ofstream(file("b.json")) << "{\"format\": 1, \"name\": ";
  const Outcome o = trocar({"check", file("a.json"), file("b.json"), "--json"});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("a.json:4:13"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("b.json:1:"), std::string::npos) << o.err;
  EXPECT_GE(o.json()["faults"].size(), 2u);
}

TEST_F(Program, CheckSaysWhatIsWrongWithAMeshAndWhatCanBeMended) {
  std::ofstream(file("body.msh")) << "$NOD\n6\n1 0 0 0\n2 10 0 0\n3 0 10 0\n4 0 0 10\n5 0 0 -10\n9 1 1 1\n$ENDNOD\n"
                                     "$ELM\n2\n1 4 1 1 4 1 2 4 3\n2 4 1 1 4 1 3 2 5\n$ENDELM\n";
  const Outcome o = trocar({"check", file("body.msh"), "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json mesh = o.json()["files"][0];
  EXPECT_EQ(mesh["format"], "Gmsh 1, text");
  EXPECT_NEAR(mesh["mesh"]["volume_ml"].get<double>(), 1.0 / 3, 1e-9);
  EXPECT_EQ(mesh["repairs"], (Json{"1 inverted cell turned", "1 node without a cell left out"}));
  EXPECT_EQ(mesh["repaired"]["nodes"], 5);
  EXPECT_NE(trocar({"check", file("body.msh")}).out.find("to mend: 1 inverted cell turned"), std::string::npos);
  const Json metres = trocar({"check", file("body.msh"), "--unit-mm", "1000", "--json"}).json()["files"][0];
  EXPECT_NEAR(metres["mesh"]["volume_ml"].get<double>(), 1e9 / 3, 1);
}

TEST_F(Program, CheckTellsEveryFaultOfAMesh) {
  std::ofstream(file("bad.msh"))
      << "$NOD\n4\n1 0 0 0\n2 nan 0 0\n3 0 1 0\n4 0 0 1\n$ENDNOD\n$ELM\n1\n1 4 1 1 4 1 2 3 7\n$ENDELM\n";
  const Outcome o = trocar({"check", file("bad.msh"), file("none.vtk")});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("bad.msh:4:3: expected an x coordinate, got 'nan'"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("bad.msh:10:11: expected the number of a node that is there, got 7"), std::string::npos)
      << o.err;
  EXPECT_NE(o.err.find("none.vtk: expected a file, got none of this name"), std::string::npos) << o.err;
}

TEST_F(Program, CheckSaysWhatAnExerciseIsMadeOf) {
  const Outcome o = trocar({"check", TROCAR_SOURCE_DIR "/scenes/gynaecology/bleeding-control.json", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json exercise = o.json()["files"][0];
  EXPECT_EQ(exercise["steps"].size(), 5u);
  EXPECT_EQ(exercise["steps"][0]["step"], "find");
  for (const Json& error : exercise["errors"])
    EXPECT_TRUE(error["fails"].get<bool>() || error["points"].get<double>() > 0) << error.dump();
  EXPECT_FALSE(exercise["facts"].empty());
  EXPECT_FALSE(exercise["events"].empty());
}

TEST_F(Program, CheckSaysWhatTheSceneCompilesTo) {
  const Outcome o = trocar({"check", TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json scene = o.json()["files"][0];
  EXPECT_GE(scene["free_nodes"].get<int>(), 6000);
  for (const Json& body : scene["bodies"])
    if (body.contains("substeps")) {
      EXPECT_GT(body["dt_margin"].get<double>(), 1.0) << body.dump();
      if (body["kind"] == "membrane") continue;  // the limit as printed is one of springs
      EXPECT_GT(body["dt_limit_as_printed_ms"].get<double>(), body["dt_limit_ms"].get<double>()) << body.dump();
    }
}

TEST_F(Program, AMotionFileIsPerformedToItsLengthAndTheRecordingVerifies) {
  const std::string recording = file("a.rec");
  const Outcome o = trocar({"train", "gynaecology/sterilisation", "--input", "motion:" + motion_file(), "--headless",
                            "--record", recording, "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json result = o.json();
  EXPECT_FALSE(result["passed"].get<bool>());
  for (const Json& hand : result["hands"]) {
    EXPECT_EQ(hand["unreachable_share"].get<double>(), 0);
    EXPECT_GT(hand["file_path_length_reachable_mm"].get<double>(), 15);
    EXPECT_NEAR(hand["path_ratio"].get<double>(), 1, 0.01);
  }
  const Outcome verified = trocar({"replay", recording, "--verify", "--json"});
  EXPECT_EQ(verified.exit, core::kDone) << verified.err;
  EXPECT_TRUE(verified.json()["verified"].get<bool>());
  EXPECT_EQ(verified.json()["state_hash"], result["state_hash"]);
  EXPECT_TRUE(verified.json()["score_compared"].get<bool>()) << verified.out;

  // Another result, sealed as any is.
  const sim::Recording honest = sim::read_recording(recording);
  {
    sim::RecordingWriter writer(file("forged.rec"), honest.header);
    for (std::size_t tick = 0; tick <= honest.inputs.size(); ++tick) {
      for (const sim::HashMark& mark : honest.hashes)
        if (mark.tick == tick) writer.hash(tick, mark.hash);
      for (const sim::Keyframe& key : honest.keyframes)
        if (key.tick == tick) writer.keyframe(tick, key.bytes);
      if (tick < honest.inputs.size()) writer.tick(tick, honest.inputs[tick]);
    }
    Json better = Json::parse(honest.result_json);
    better["passed"] = true;
    better["assessment"]["score"]["total"] = 100;
    writer.finish(better.dump());
  }
  const Outcome forged = trocar({"replay", file("forged.rec"), "--verify"});
  EXPECT_EQ(forged.exit, core::kGoalNotReached);
  EXPECT_NE(
      forged.out.find("the result differs from what its inputs give, recorded value first: passed: true and false"),
      std::string::npos)
      << forged.out;

  // One bit of one input, which leaves no trace in the State a tick later: does not verify, and says where.
  // (The instrument is where it is commanded to be and touches nothing.)
  sim::Recording changed = sim::read_recording(recording);
  ASSERT_GT(changed.inputs.size(), 650u);
  float& depth = changed.inputs[650].tools[0].depth;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &depth, sizeof bits);
  bits ^= 1;
  std::memcpy(&depth, &bits, sizeof bits);
  {
    sim::RecordingWriter writer(file("b.rec"), changed.header);
    std::size_t mark = 0;
    for (std::size_t tick = 0; tick <= changed.inputs.size(); ++tick) {
      for (; mark < changed.hashes.size() && changed.hashes[mark].tick == tick; ++mark)
        writer.hash(tick, changed.hashes[mark].hash);
      if (tick < changed.inputs.size()) writer.tick(tick, changed.inputs[tick]);
    }
    writer.finish("{}");
  }
  const Outcome refused = trocar({"replay", file("b.rec"), "--verify", "--json"});
  EXPECT_EQ(refused.exit, core::kGoalNotReached);
  EXPECT_FALSE(refused.json()["verified"].get<bool>());
  EXPECT_EQ(refused.json()["differs_between_ticks"], Json::parse("[600, 700]"));

  // One bit of the file itself: its block's checksum tells.
  std::string bytes = read(recording);
  bytes[bytes.size() / 2] = char(bytes[bytes.size() / 2] ^ 4);
  std::ofstream(file("c.rec"), std::ios::binary) << bytes;
  const Outcome damaged = trocar({"replay", file("c.rec"), "--verify", "--json"});
  EXPECT_EQ(damaged.exit, core::kGoalNotReached);
  EXPECT_NE(damaged.json()["difference"].get<std::string>().find("damaged"), std::string::npos) << damaged.out;
}

TEST_F(Program, AnotherVersionOfThePhysicsRefusesToVerifyAndShowsKeyframes) {
  const Outcome o = trocar({"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--seconds",
                            "0.5", "--record", file("a.rec"), "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const sim::Recording ours = sim::read_recording(file("a.rec"));
  sim::RecordingHeader header = ours.header;
  header.model_hash ^= 1;
  {
    sim::RecordingWriter writer(file("b.rec"), header);
    for (std::size_t tick = 0; tick < ours.inputs.size(); ++tick) writer.tick(tick, ours.inputs[tick]);
    for (const sim::Keyframe& k : ours.keyframes) writer.keyframe(k.tick, k.bytes);
    writer.finish("{}");
  }
  const Outcome refused = trocar({"replay", file("b.rec"), "--verify", "--json"});
  EXPECT_EQ(refused.exit, core::kGoalNotReached);
  EXPECT_NE(refused.json()["difference"].get<std::string>().find("another version"), std::string::npos);
  const Outcome played = trocar({"replay", file("b.rec"), "--json"});
  EXPECT_EQ(played.exit, core::kDone) << played.err;
  EXPECT_EQ(played.json()["played"], "keyframes");
  EXPECT_EQ(played.json()["keyframes"], ours.keyframes.size());
}

TEST_F(Program, ADamagedRecordingIsBadInput) {
  std::ofstream(file("a.rec")) << "this is no recording";
  EXPECT_EQ(trocar({"replay", file("a.rec"), "--verify"}).exit, core::kBadInput);
  EXPECT_EQ(trocar({"report", file("a.rec")}).exit, core::kBadInput);
  EXPECT_EQ(trocar({"replay", file("missing.rec")}).exit, core::kBadInput);
}

TEST_F(Program, AWindowWithoutADisplayLacksSomethingAndSaysWhat) {
  const char* display = getenv("DISPLAY");
  const std::string before = display ? display : "";
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  const Outcome o = trocar({"train", "gynaecology", "--record", file("a.rec")});
  if (display) setenv("DISPLAY", before.c_str(), 1);
  EXPECT_EQ(o.exit, core::kEnvironment);
  EXPECT_NE(o.err.find("--headless"), std::string::npos) << o.err;
}

TEST_F(Program, AReportIsAPageWithTheResult) {
  const std::string recording = file("a.rec");
  ASSERT_EQ(trocar({"train", "gynaecology/sterilisation", "--input", "motion:" + motion_file(), "--headless",
                    "--seconds", "0.2", "--record", recording, "--trainee", "A <b> & C"})
                .exit,
            core::kDone);
  const Outcome o = trocar({"report", recording, "--out", file("page"), "--names", "--no-pictures", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const std::string page = read(file("page/index.html"));
  EXPECT_NE(page.find("gynaecology/sterilisation"), std::string::npos);
  EXPECT_NE(page.find("A &lt;b&gt; &amp; C"), std::string::npos);
}

TEST_F(Program, AnUnknownCommandIsBadInputWithTheNearestName) {
  const Outcome o = trocar({"repot", "--json"});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("report"), std::string::npos) << o.err;
  EXPECT_EQ(o.json()["exit"], 2);
}

TEST_F(Program, AWrongNumberOfThreadsIsBadInput) {
  for (const char* wrong : {"many", "0", "-1", "65", "2x", ""}) {
    setenv("TROCAR_THREADS", wrong, 1);
    EXPECT_EQ(trocar({"list"}).exit, core::kBadInput) << wrong;
  }
  unsetenv("TROCAR_THREADS");
  EXPECT_EQ(trocar({"list"}).exit, core::kDone);
}

TEST_F(Program, NumbersOfOptionsAreFiniteAndWithinBounds) {
  const std::vector<std::vector<std::string>> wrong{
      {"train", "gynaecology", "--seed", "-1"},
      {"train", "gynaecology", "--seed", "1.5"},
      {"train", "gynaecology", "--seed", "0x10"},
      {"train", "gynaecology", "--seed", "18446744073709551617"},
      {"train", "gynaecology", "--seconds", "nan"},
      {"train", "gynaecology", "--seconds", "0"},
      {"train", "gynaecology", "--data-rate", "nan"},
      {"check", "a.msh", "--unit-mm", "nan"},
      {"check", "a.msh", "--unit-mm", "0"},
      {"replay", "a.rec", "--from", "nan"},
      {"replay", "a.rec", "--to", "NaN"},
      {"replay", "a.rec", "--to", "inf"},
      {"replay", "a.rec", "--slow", "nan"},
      {"bench", "kernel", "--seconds", "nan"},
      {"bench", "gynaecology", "--at", "nan"},
      {"bench", "gynaecology", "--at", "-1"},
      {"bench", "gynaecology", "--frames", "3.5"},
      {"bench", "gynaecology", "--frames", "0x10"},
      {"train", "gynaecology", "--seconds", "1e999"},
  };
  for (const std::vector<std::string>& words : wrong) {
    const Outcome o = trocar(words);
    EXPECT_EQ(o.exit, core::kBadInput) << words[0] << ' ' << words[2] << ' ' << words[3];
    EXPECT_NE((o.out + o.err).find(words[2] + ": expected a "), std::string::npos) << o.out << o.err;
    EXPECT_NE((o.out + o.err).find("got '" + words[3] + "'"), std::string::npos) << o.out << o.err;
  }
}

TEST_F(Program, AWholeNumberIsDecimalWhateverItBeginsWith) {
  const Outcome o = trocar({"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--seconds",
                            "0.01", "--seed", "010", "--no-store", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  EXPECT_EQ(o.json()["seed"], 10);
}

TEST_F(Program, APictureNameThatNoPictureHasIsToldBeforeAnythingIsDrawn) {
  const Outcome o = trocar({"gallery", file("pictures"), "--only", "wiped lense"});
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("did you mean \"wiped lens\"?"), std::string::npos) << o.err;
  EXPECT_FALSE(fs::exists(file("pictures")));
  // Of another scene than the chosen one.
  EXPECT_EQ(trocar({"gallery", file("pictures"), "--scene", "digestive", "--only", "tube_left"}).exit, core::kBadInput);
}

TEST_F(Program, ALogThatCannotBeWrittenIsToldOnceAndInTheExitCode) {
  const Outcome o = trocar({"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--seconds",
                            "0.6", "--log", "/dev/full", "--no-store", "--json"});
  EXPECT_EQ(o.exit, core::kEnvironment);
  const std::size_t told = o.err.find("/dev/full are lost: No space left");
  ASSERT_NE(told, std::string::npos) << o.err;
  EXPECT_EQ(o.err.find("/dev/full", told + 1), std::string::npos) << "once: " << o.err;
  EXPECT_NE(o.json()["log_failure"].get<std::string>().find("No space left"), std::string::npos);
  EXPECT_EQ(o.json()["ticks"], 600) << "the result is there all the same";
}

TEST_F(Program, AStoreThatIsNoFileIsToldInsteadOfWaitedFor) {
  ASSERT_EQ(trocar({"report", "--list"}).exit, core::kDone) << "there is a store now";
  for (const char* name : {"data/sessions.sqlite-wal", "data/sessions.sqlite-journal", "data/sessions.sqlite"}) {
    fs::remove(file(name));
    ASSERT_EQ(mkfifo(file(name).c_str(), 0600), 0);
    alarm(60);  // it would wait for ever
    const Outcome o = trocar({"report", "--list"});
    alarm(0);
    EXPECT_EQ(o.exit, core::kEnvironment) << o.err;
    EXPECT_NE(o.err.find(file(name) + ": expected a file"), std::string::npos) << o.err;
    fs::remove(file(name));
  }
}

TEST_F(Program, ARecordingThatEndsBetweenTwoBlocksIsVerifiedOnlyUpToThere) {
  ASSERT_EQ(trocar({"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--seconds", "1.5",
                    "--record", file("a.rec"), "--no-store"})
                .exit,
            core::kDone);
  const sim::Recording whole = sim::read_recording(file("a.rec"));
  {
    sim::RecordingWriter writer(file("cut.rec"), whole.header);  // ends without finish(), at a block's end
    std::size_t mark = 0;
    for (std::size_t tick = 0; tick < 1000; ++tick) {
      for (; mark < whole.hashes.size() && whole.hashes[mark].tick == tick; ++mark)
        writer.hash(tick, whole.hashes[mark].hash);
      writer.tick(tick, whole.inputs[tick]);
    }
  }
  const Outcome o = trocar({"replay", file("cut.rec"), "--verify", "--json"});
  EXPECT_EQ(o.exit, core::kGoalNotReached);
  EXPECT_FALSE(o.json()["verified"].get<bool>());
  EXPECT_EQ(o.json()["verified_until_tick"], 900);
  EXPECT_NE(o.json()["difference"].get<std::string>().find("verified up to tick 900; the recording ends early"),
            std::string::npos)
      << o.out;
}

TEST_F(Program, WhatCannotBeWrittenIsToldBeforeAnythingIsDone) {
  const Outcome o = trocar(
      {"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--video", "/nowhere/at/all/a.mp4"});
  EXPECT_EQ(o.exit, core::kEnvironment) << o.err;
  EXPECT_EQ(trocar({"report", "--list", "--json"}).json()["attempts"].size(), 0u) << "an attempt that never began";
}

TEST_F(Program, AttemptsAreListedExportedAndForgotten) {
  const auto train = [&](std::vector<std::string> more) {
    std::vector<std::string> words{
        "train", "gynaecology/sterilisation", "--input", "motion:" + motion_file(), "--headless", "--seconds", "0.3",
        "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return trocar(words);
  };
  const Outcome first = train({"--trainee", "Ada"});
  ASSERT_EQ(first.exit, core::kDone) << first.err;
  EXPECT_EQ(first.json()["attempt"]["number"], 1);
  const Outcome second = train({"--trainee", "Bob", "--familiarisation", "--seed", "3", "--record", file("b.rec")});
  ASSERT_EQ(second.exit, core::kDone) << second.err;
  EXPECT_TRUE(second.json()["passed"].is_null());
  EXPECT_FALSE(second.json()["assessment"]["score"].contains("total")) << "familiarisation is not scored";
  EXPECT_NE(second.json()["model_hash"], first.json()["model_hash"]) << "another anatomy";
  EXPECT_EQ(trocar({"replay", file("b.rec"), "--verify"}).exit, core::kDone) << "a replay makes the same anatomy";
  const Json again = trocar({"replay", file("b.rec"), "--json"}).json();
  EXPECT_TRUE(again["passed"].is_null()) << "nor is it scored when it is played again";
  EXPECT_FALSE(again["assessment"]["score"].contains("total"));
  const Json repeated = trocar({"train", "gynaecology/sterilisation", "--input", "replay:" + file("b.rec"),
                                "--headless", "--seed", "3", "--no-store", "--json"})
                            .json();
  EXPECT_TRUE(repeated["passed"].is_null()) << "nor when it is done again";
  train({"--no-store"});

  const Json list = trocar({"report", "--list", "--json"}).json()["attempts"];
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["trainee"], "Ada");
  EXPECT_EQ(list[1]["mode"], "familiarisation");
  EXPECT_EQ(list[1]["seed"], 3);
  EXPECT_TRUE(list[1]["score"].is_null());

  ASSERT_EQ(trocar({"report", "--csv", file("all.csv")}).exit, core::kDone);
  EXPECT_NE(read(file("all.csv")).find("both.path_m"), std::string::npos);
  ASSERT_EQ(trocar({"report", "1", "--trace", file("motion.trace.csv")}).exit, core::kDone);
  EXPECT_GT(read(file("motion.trace.csv")).size(), 500u);
  ASSERT_EQ(trocar({"report", "2", "--trace", file("kept.csv")}).exit, core::kDone);
  setenv("TROCAR_DATA", file("elsewhere").c_str(), 1);
  const Outcome handed_in = trocar({"report", file("b.rec"), "--trace", file("b.csv")});
  setenv("TROCAR_DATA", file("data").c_str(), 1);
  EXPECT_EQ(handed_in.exit, core::kDone) << handed_in.err;
  const auto motion = [&](const std::string& name) {
    const std::string text = read(file(name));
    return text.substr(text.find("# rate_hz"));
  };
  EXPECT_EQ(motion("b.csv"), motion("kept.csv")) << "a recording of another store is simulated again";
  ASSERT_EQ(trocar({"report", "--traces", file("motions"), "--names"}).exit, core::kDone);
  const Json study = trocar({"trials", file("motions"), "--json"}).json();
  EXPECT_EQ(study["persons"], (Json{"Ada", "Bob"}));
  EXPECT_EQ(study["attempts"].size(), 2u);

  const Outcome nobody = trocar({"report", "--list", "--trainee", "Nobody"});
  EXPECT_NE(nobody.out.find("no attempts of Nobody; known: Bob, Ada"), std::string::npos) << nobody.out;

  fs::create_directories(file("data"));
  std::ofstream(file("data/settings.json")) << R"({"format": 1, "trainee": "Ada"})";
  EXPECT_EQ(trocar({"report", "--forget", "Ada"}).exit, core::kBadInput) << "nobody can be asked here";
  const Outcome dry = trocar({"report", "--forget", "Ada", "--dry-run"});
  EXPECT_EQ(dry.exit, core::kDone);
  EXPECT_NE(dry.out.find("Ada: 1 attempt and 0 recordings would be deleted"), std::string::npos) << dry.out;
  EXPECT_NE(dry.out.find("gynaecology/sterilisation"), std::string::npos) << dry.out;
  EXPECT_EQ(trocar({"report", "--list", "--json"}).json()["attempts"].size(), 2u) << "so far all is there";
  const Outcome gone = trocar({"report", "--forget", "Ada", "--yes"});
  EXPECT_EQ(gone.exit, core::kDone);
  EXPECT_NE(gone.out.find("Ada: 1 attempt and 0 recordings deleted"), std::string::npos) << gone.out;
  EXPECT_EQ(read(file("data/settings.json")).find("Ada"), std::string::npos);
  std::ofstream(file("data/settings.json")) << R"({"format": 1, "trainee": "Ada"})";  // settings without attempts
  for (const char* unsure : {"--dry-run", "--json"}) {
    EXPECT_EQ(trocar({"report", "--forget", "Ada", unsure}).exit, core::kGoalNotReached);
    EXPECT_NE(read(file("data/settings.json")).find("Ada"), std::string::npos) << "deleted by " << unsure;
  }
  EXPECT_EQ(trocar({"report", "--forget", "Ada", "--yes"}).exit, core::kGoalNotReached);
  EXPECT_EQ(read(file("data/settings.json")).find("Ada"), std::string::npos);
  EXPECT_EQ(trocar({"report", "--list", "--json"}).json()["attempts"].size(), 1u);
}

TEST_F(Program, AReplayOfADamagedOrOtherRecordingIsWarnedOf) {
  ASSERT_EQ(trocar({"train", "gynaecology", "--input", "motion:" + motion_file(), "--headless", "--seconds", "0.3",
                    "--record", file("a.rec"), "--no-store"})
                .exit,
            core::kDone);
  std::string bytes = read(file("a.rec"));
  std::ofstream(file("torn.rec"), std::ios::binary) << bytes.substr(0, bytes.size() - 10);
  const Outcome o = trocar({"train", "gynaecology/sterilisation", "--input", "replay:" + file("torn.rec"), "--headless",
                            "--log", file("log"), "--no-store", "--json"});
  EXPECT_NE(o.err.find("torn.rec"), std::string::npos) << o.err;
  EXPECT_NE(o.err.find("was made in gynaecology"), std::string::npos) << o.err;
  EXPECT_NE(read(file("log")).find("\"event\":\"end\""), std::string::npos);
}

TEST_F(Program, BenchSaysWhatEachPassOfAPictureCosts) {
  const Outcome o = trocar({"bench", "digestive", "--picture", "--size", "160x120", "--seconds", "0.3", "--at", "0.2",
                            "--frames", "3", "--json"});
  ASSERT_EQ(o.exit, core::kDone) << o.err;
  const Json result = o.json()["benchmarks"][0];
  bool opaque = false;
  for (const Json& row : result["passes"]) {
    opaque |= row["pass"] == "opaque" && row["detail_2"]["processor_ms"].get<double>() > 0;
    for (const char* column : {"detail_2", "detail_1", "detail_0", "cheapest"})
      EXPECT_GE(row[column]["wall_ms"].get<double>(), 0) << row.dump();
  }
  EXPECT_TRUE(opaque) << result.dump(1);
  EXPECT_GT(result["fineness"][0]["triangles"].get<int>(), result["fineness"][3]["triangles"].get<int>());
  EXPECT_EQ(trocar({"bench", "digestive", "--picture", "--size", "1x1"}).exit, core::kBadInput);
}

}  // namespace
}  // namespace trocar::app
