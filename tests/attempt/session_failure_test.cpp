// A simulation that fails, or that runs out of room: who hears of it, and that nobody is charged with it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/attempt/attempt_log.hpp>
#include <trocar/core/log.hpp>

#include "../training/two_sides.hpp"

namespace trocar::attempt {
namespace {

namespace fs = std::filesystem;

/// The tubes' exercise, in which a declaration is an error.
const Lesson& lesson() {
  static const auto made = [] {
    auto l = std::make_unique<Lesson>();
    l->name = "two_sides";
    l->model = two_sides::model();
    l->exercise = two_sides::exercise_with(
        {{"\"errors\": [", R"("errors": [{"code": "Z1", "name": "declared", "on": {"event": "declared"}, "points": 7,
          "meaning": "A key was pressed", "hint": "Do not press it", "source": "our estimate"},)"}});
    return l;
  }();
  return *made;
}

sim::Input declaring() {
  sim::Input input = lesson().model.start;
  input.pedals = sim::kDeclare;
  return input;
}

/// As a fault of the physics would leave it.
void break_physics(Session& session) {
  auto& state = const_cast<sim::State&>(session.state());
  state.strands[two_sides::kLeft].x[3].x = std::numeric_limits<double>::quiet_NaN();
}

/// An error is made, then the simulation fails.
void fail_after_an_error(Session& session) {
  session.advance(declaring());
  ASSERT_EQ(session.monitor()->errors().size(), 1u);
  break_physics(session);
  for (int i = 0; i < 5; ++i) session.advance(lesson().model.start);
  ASSERT_FALSE(session.broken().empty());
}

class SessionFailure : public testing::Test {
 protected:
  void SetUp() override { core::log::set_level(core::log::Level::info); }
};

TEST_F(SessionFailure, IsReportedOnStandardErrorOnceWithTimeAndBody) {
  Session session(lesson(), 1);
  testing::internal::CaptureStderr();
  fail_after_an_error(session);
  const std::string text = testing::internal::GetCapturedStderr();
  const std::size_t at = text.find("The simulation failed at 0.002 s (body tube_left");
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_NE(text.find("the attempt is not assessed", at), std::string::npos);
  EXPECT_EQ(text.find("The simulation failed", at + 1), std::string::npos);
}

TEST_F(SessionFailure, LeavesNoScoreNoVerdictAndNoErrors) {
  Session session(lesson(), 1);
  fail_after_an_error(session);
  const Json result = session.result(false);
  EXPECT_TRUE(result["assessment"].is_null());
  EXPECT_TRUE(result["passed"].is_null());
  EXPECT_EQ(result["failure"], session.broken());
  EXPECT_FALSE(result["tissue_survived"].get<bool>());
  for (const Json& moment : result["moments"]) EXPECT_NE(moment["what"], "error");
  EXPECT_EQ(session.state().tick, 2u) << "nothing is simulated after it";
}

TEST_F(SessionFailure, IsKeptInTheStoreAsNotAssessedAndReadFromTheRecordingLikewise) {
  const fs::path root = fs::temp_directory_path() / ("trocar_session_failure_test_" + std::to_string(getpid()));
  fs::create_directories(root);
  training::Attempt kept, read;
  {
    training::Store store(root / "data");
    Session session(lesson(), 1);
    AttemptPlan plan;
    plan.recording = root / "failed.rec";
    AttemptLog log(&store, session, plan);
    fail_after_an_error(session);
    Json result = session.result(false);
    log.end(result, training::AttemptState::finished);
    EXPECT_EQ(result["attempt"]["state"], "not assessed");
    kept = store.list().front();
    ASSERT_TRUE(training::fill_from_recording(plan.recording, read));
  }
  for (const training::Attempt& a : {kept, read}) {
    EXPECT_EQ(a.state, training::AttemptState::not_assessed);
    EXPECT_FALSE(a.score);
    EXPECT_FALSE(a.passed);
  }
  fs::remove_all(root);
}

TEST(SessionWarnings, AFlagThatLimitsTheSimulationIsReportedOnceWithItsRemedy) {
  core::log::set_level(core::log::Level::info);
  Session session(lesson(), 1);
  sim::Input input = lesson().model.start;
  input.tools[0].yaw = std::numeric_limits<float>::quiet_NaN();
  testing::internal::CaptureStderr();
  for (int i = 0; i < 5; ++i) session.advance(input);
  const std::string text = testing::internal::GetCapturedStderr();
  ASSERT_EQ(session.warnings().size(), 1u);
  EXPECT_NE(session.warnings()[0].find("not finite"), std::string::npos);
  const std::size_t at = text.find(session.warnings()[0]);
  ASSERT_NE(at, std::string::npos) << text;
  EXPECT_EQ(text.find(session.warnings()[0], at + 1), std::string::npos);
  EXPECT_TRUE(session.broken().empty());
}

TEST(SessionRecords, WhatFoundNoRoomIsInTheResultToTheEndOfTheAttempt) {
  Session session(lesson(), 1);
  const int applier = two_sides::kApplier;
  sim::Input input = lesson().model.start;
  input.tools[applier].handle = 1;
  session.advance(input);
  EXPECT_FALSE(session.result(false).contains("not_recorded"));
  auto& state = const_cast<sim::State&>(session.state());
  state.clip_count = interactions::kMaxClips;
  state.tools[applier].armed = 1;
  for (int i = 0; i < 500; ++i) session.advance(input);
  state.clip_count = 0;
  session.advance(input);
  const Json missing = session.result(false)["not_recorded"];
  ASSERT_EQ(missing.size(), 2u) << "so many clips at once are more events than a tick has room for, too";
  EXPECT_NE(missing[0].get<std::string>().find("clips, cuts, wounds, seals or stitches were not recorded"),
            std::string::npos);
  EXPECT_NE(missing[1].get<std::string>().find("Some events were not recorded"), std::string::npos);
}

/// A node that something keeps on the far side of its cells.
TEST(SessionFlags, CellsThatArePushedOpenCountWhenThatLasts) {
  Session session(lesson(), 1);
  const auto has_flag = [&session] {
    const std::vector<std::string> names = flag_names(session.flags());
    return std::find(names.begin(), names.end(), "inverted_cells") != names.end();
  };
  auto& nodes = const_cast<sim::State&>(session.state()).solids[0].nodes;
  const tissue::NetworkModel& network = lesson().model.solids[0].network;
  const tissue::TetRest& cell = network.tets[network.tets.size() / 2];
  const tissue::NodeState a = nodes[size_t(cell.row[0])], b = nodes[size_t(cell.row[1])];
  const auto mirror = [&] {  // through the cell's other corners
    nodes[size_t(cell.row[0])] = {2 * b.x - a.x, 2 * b.y - a.y, 2 * b.z - a.z, 0, 0, 0};
  };
  for (int i = 0; i < 100; ++i) {
    if (i % 20 == 0) mirror();
    session.advance(lesson().model.start);
  }
  ASSERT_TRUE(session.broken().empty());
  EXPECT_FALSE(has_flag());
  for (int i = 0; i < 1200 && session.broken().empty(); ++i) {
    mirror();
    session.advance(lesson().model.start);
  }
  EXPECT_TRUE(has_flag());
}

}  // namespace
}  // namespace trocar::attempt
