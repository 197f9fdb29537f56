// Tools that a tracker sees lead instruments and the camera; their file; what happens when the tracker is gone.
#include <atomic>
#include <chrono>
#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/attempt/catch_up.hpp>
#include <trocar/attempt/sources.hpp>
#include <trocar/attempt/tracker/tracked_source.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/random.hpp>
#include <trocar/scene/json/schema.hpp>

namespace trocar::attempt {
namespace {

using namespace std::chrono_literals;

const Lesson& gynaecology() {
  static const std::unique_ptr<Lesson> one = load_lesson("gynaecology");
  return *one;
}

std::string faults_in(const std::string& text) {
  try {
    read_tracker_plan_text(text, "tracker.json");
  } catch (const core::BadInput& bad) {
    std::string all;
    for (const core::Fault& f : bad.faults()) all += core::to_string(f) + "\n";
    return all;
  }
  return {};
}

/// A tracker's server on the loopback, for one who listens at a time.
class FakeTracker {
 public:
  FakeTracker() {
    m_server = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    EXPECT_EQ(bind(m_server, reinterpret_cast<sockaddr*>(&at), size), 0);
    EXPECT_EQ(listen(m_server, 4), 0);
    getsockname(m_server, reinterpret_cast<sockaddr*>(&at), &size);
    port = ntohs(at.sin_port);
  }
  ~FakeTracker() {
    hang_up();
    close(m_server);
  }
  void take_call() { m_client = accept(m_server, nullptr, nullptr); }
  void hang_up() {
    if (m_client >= 0) close(m_client);
    m_client = -1;
  }
  void say(const std::vector<std::uint8_t>& bytes) const {
    EXPECT_EQ(send(m_client, bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
  }
  int port = 0;

 private:
  int m_server = -1, m_client = -1;
};

template <class Condition>
bool before_long(Condition&& condition) {
  for (const auto end = std::chrono::steady_clock::now() + 10s; std::chrono::steady_clock::now() < end;
       std::this_thread::sleep_for(2ms))
    if (condition()) return true;
  return condition();
}

devices::TrackedPose tool_at(const std::string& name, Vec3d port, const kinematics::FulcrumPose& pose) {
  const kinematics::TipFrame frame = kinematics::forward(port, pose);
  return {name, frame.tip, frame.rotation};
}

TEST(TrackedTool, AToolThatMovesAsAnInstrumentDoesLeadsItThereWhereverTheTrackerStands) {
  const Vec3d port{0.05, -0.02, 0.01};
  TrackerPlan plan;
  plan.tools.push_back({"right", "Tool", {0.01, -0.02, -0.3}, {}});
  plan.axes = Mat3d::from_columns({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
  TrackedTool tool(plan, plan.tools[0]);
  const kinematics::FulcrumPose placed{0.2, -0.1, 0.4, 0.12};
  core::Random random(3);
  double worst = 0;
  for (int i = 0; i < 200; ++i) {
    kinematics::FulcrumPose pose = placed;
    if (i > 0)
      pose = {random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6), random.uniform(-1, 1), random.uniform(0.05, 0.2)};
    // The tool as the tracker sees it: its own frame, turned and shifted, and its origin beside the tip.
    const kinematics::TipFrame frame = kinematics::forward(port, pose);
    devices::TrackedPose seen;
    seen.turned = transposed(plan.axes) * frame.rotation;
    seen.place = transposed(plan.axes) * frame.tip + Vec3d{3, 1, -2} - seen.turned * plan.tools[0].tip;
    const kinematics::FulcrumPose led = tool.follow(seen, port, placed);
    worst = std::max(worst, length(kinematics::forward(port, led).tip - frame.tip));
    EXPECT_GT(dot(kinematics::forward(port, led).opening(), frame.opening()), 1 - 1e-9) << i;
  }
  EXPECT_LT(worst, 1e-9);
}

TEST(TrackedTool, WithAnOriginItsPlaceIsWhatTheTrackerSays) {
  TrackerPlan plan;
  plan.origin = Vec3d{0.1, 0, 0};
  plan.tools.push_back({"right", "Tool", {}, {}});
  TrackedTool tool(plan, plan.tools[0]);
  const kinematics::FulcrumPose led =
      tool.follow({"Tool", {-0.08, 0.01, -0.15}, Mat3d::identity()}, {}, {0, 0, 0, 0.1});
  EXPECT_NEAR(length(kinematics::forward({}, led).tip - Vec3d{0.02, 0.01, -0.15}), 0, 1e-12);
}

TEST(TrackerFile, AllFaultsAreToldAtTheirPlaces) {
  const std::string told = faults_in(R"({"format": 1, "server": "somewhere", "x_points": "left", "y_points": "right",
  "tools": [{"role": "left", "tip_mm": [0, 1]},
    {"role": "right", "transform": "T", "grip": {"sensor": "G", "open": 1, "closed": 1}}]})");
  EXPECT_NE(told.find("tracker.json:1:25"), std::string::npos) << told;
  EXPECT_NE(told.find("square"), std::string::npos) << told;
  EXPECT_NE(told.find("transform"), std::string::npos) << told;
  EXPECT_NE(told.find("tip_mm"), std::string::npos) << told;
  EXPECT_NE(told.find("tracker.json:3:"), std::string::npos) << told;
}

TEST(TrackerFile, ThePublishedSchemaSaysWhatTheReaderObeys) {
  std::ifstream file(TROCAR_SOURCE_DIR "/scenes/schema/tracker.schema.json");
  std::stringstream published;
  published << file.rdbuf();
  const std::filesystem::path fresh = std::filesystem::path(TROCAR_BINARY_DIR) / "schema" / "tracker.schema.json";
  std::filesystem::create_directories(fresh.parent_path());
  std::ofstream(fresh) << scene::json_schema(tracker_plan_shape());
  EXPECT_EQ(published.str(), scene::json_schema(tracker_plan_shape()))
      << "out of date: copy " << fresh.generic_string();
}

TEST(TrackerFile, TheShippedOneIsRead) {
  const TrackerPlan plan = read_tracker_plan(TROCAR_SOURCE_DIR "/scenes/inputs/tracker.json");
  EXPECT_EQ(plan.tools.size(), 3u);
  EXPECT_EQ(plan.port, 18944);
}

TEST(TrackedSource, LeadsWhatItsToolsLeadAndStandsStillWhileTheTrackerIsGone) {
  FakeTracker tracker;
  const sim::Model& model = gynaecology().model;
  TrackerPlan plan;
  plan.file = "tracker.json", plan.address = "127.0.0.1", plan.port = tracker.port;
  plan.tools = {{"camera", "Scope", {}, {}}, {model.hands[0].name, "Tool", {}, TrackerPlan::Grip{"Grips", 1, 10, 20}}};
  RestingSource rest(model);
  TrackedSource source(rest, model, plan);
  tracker.take_call();
  EXPECT_FALSE(source.ready());
  EXPECT_NE(source.waits_for().find("Scope"), std::string::npos) << source.waits_for();

  const sim::State state = sim::initial_state(model);
  const kinematics::FulcrumPose scope = sim::pose_of(model.start.scope), hand = sim::pose_of(model.start.tools[0]);
  const Vec3d port = model.tool(state, 0).port;
  const auto show = [&](double by) {
    tracker.say(devices::igtl_transform(
        tool_at("Scope", model.scope.port, {scope.yaw + by, scope.pitch, scope.roll, scope.depth})));
    tracker.say(devices::igtl_transform(tool_at("Tool", port, {hand.yaw, hand.pitch + by, hand.roll, hand.depth})));
    tracker.say(devices::igtl_sensor({"Grips", {0, by == 0 ? 10.0 : 15.0}}));
  };
  show(0);
  ASSERT_TRUE(before_long([&] { return source.ready(); })) << source.waits_for();
  sim::Input input;
  ASSERT_TRUE(source.next(state, input));
  show(0.05);
  ASSERT_TRUE(before_long([&] {
    source.next(state, input);
    return std::abs(double(input.scope.yaw) - (scope.yaw + 0.05)) < 1e-5 &&
           std::abs(double(input.tools[0].handle) - 0.5) < 1e-4;
  })) << input.scope.yaw;
  EXPECT_NEAR(double(input.tools[0].pitch), hand.pitch + 0.05, 1e-4);
  EXPECT_EQ(input.tools[1].yaw, model.start.tools[1].yaw) << "what no tool leads stays";

  tracker.hang_up();
  ASSERT_TRUE(before_long([&] { return !source.ready(); })) << "it called again at once, and nothing is said";
  tracker.take_call();  // it looks for it again by itself
  show(0);
  ASSERT_TRUE(before_long([&] { return source.ready(); })) << source.waits_for();
  EXPECT_EQ(source.describe()["tracker"]["connections"], 2);
}

TEST(TrackedSource, AToolThatIsHiddenStopsTimeUntilItIsSeenAgain) {
  FakeTracker tracker;
  const sim::Model& model = gynaecology().model;
  TrackerPlan plan;
  plan.file = "tracker.json", plan.address = "127.0.0.1", plan.port = tracker.port;
  plan.tools = {{"camera", "Scope", {}, {}}};
  RestingSource rest(model);
  TrackedSource source(rest, model, plan);
  tracker.take_call();
  const auto pose = devices::igtl_transform(tool_at("Scope", model.scope.port, sim::pose_of(model.start.scope)));
  tracker.say(pose);
  ASSERT_TRUE(before_long([&] { return source.ready(); }));
  ASSERT_TRUE(before_long([&] { return !source.ready(); })) << "nothing comes any more";
  EXPECT_NE(source.waits_for().find("not visible"), std::string::npos) << source.waits_for();
  tracker.say(pose);
  EXPECT_TRUE(before_long([&] { return source.ready(); }));
}

/// A source whose one tool is the camera's, seen once where the scene has it.
struct SeenScope {
  explicit SeenScope(const std::string& name = "Scope") {
    plan.file = "tracker.json", plan.address = "127.0.0.1", plan.port = tracker.port;
    plan.tools = {{"camera", name, {}, {}}};
    source = std::make_unique<TrackedSource>(rest, model, plan);
    tracker.take_call();
  }
  kinematics::FulcrumPose start() const { return sim::pose_of(model.start.scope); }
  devices::TrackedPose at(const std::string& name, double yaw) const {
    kinematics::FulcrumPose pose = start();
    pose.yaw += yaw;
    return tool_at(name, model.scope.port, pose);
  }
  bool ready_before_long() {
    return before_long([&] { return source->ready(); });
  }
  FakeTracker tracker;
  const sim::Model& model = gynaecology().model;
  TrackerPlan plan;
  RestingSource rest{model};
  std::unique_ptr<TrackedSource> source;
};

TEST(TrackedSource, AToolThatItsServerCallsMissingStopsTimeAndMovesNothing) {
  SeenScope seen;
  seen.tracker.say(devices::igtl_transform(seen.at("Scope", 0), 2, {{"TransformStatus", "OK"}}));
  ASSERT_TRUE(seen.ready_before_long()) << seen.source->waits_for();
  const sim::State state = sim::initial_state(seen.model);
  sim::Input input;
  const auto still_there = [&] {
    seen.source->next(state, input);
    return std::abs(double(input.scope.yaw) - seen.start().yaw) < 1e-6;
  };
  ASSERT_TRUE(still_there());
  const auto missing = devices::igtl_transform({"Scope", {}, Mat3d::identity()}, 2, {{"TransformStatus", "MISSING"}});
  ASSERT_TRUE(before_long([&] {
    seen.tracker.say(missing);
    EXPECT_TRUE(still_there()) << input.scope.yaw;
    return !seen.source->ready();
  })) << "it is sent on and on, and is not seen";
  EXPECT_NE(seen.source->waits_for().find("Scope is not visible (MISSING)"), std::string::npos)
      << seen.source->waits_for();
}

TEST(TrackedSource, AToolThatIsSeenAgainElsewhereIsGoneAfterSlowly) {
  SeenScope seen;
  seen.tracker.say(devices::igtl_transform(seen.at("Scope", 0)));
  ASSERT_TRUE(seen.ready_before_long());
  const sim::State state = sim::initial_state(seen.model);
  sim::Input input;
  ASSERT_TRUE(seen.source->next(state, input));
  ASSERT_TRUE(before_long([&] { return !seen.source->ready(); }));
  seen.tracker.say(devices::igtl_transform(seen.at("Scope", 0.3)));
  ASSERT_TRUE(seen.ready_before_long());
  float before = input.scope.yaw;
  int ticks = 0;
  for (; ticks < 2000 && std::abs(double(input.scope.yaw) - seen.start().yaw - 0.3) > 1e-3; ++ticks) {
    seen.source->next(state, input);
    ASSERT_LE(std::abs(input.scope.yaw - before), 1.5f * float(kCatchTurn) * float(core::kTick)) << ticks;
    before = input.scope.yaw;
  }
  EXPECT_GE(ticks, 290) << "0.3 rad at 1 rad/s";
  EXPECT_LT(ticks, 600);
}

TEST(TrackedSource, ALongNameIsRecognisedAsTheProtocolCutsIt) {
  const std::string whole = "EndoscopeTipToReference";
  SeenScope seen(whole);
  seen.tracker.say(devices::igtl_transform(seen.at(whole, 0)));  // cut by the protocol's field
  EXPECT_TRUE(seen.ready_before_long()) << seen.source->waits_for();
  SeenScope wrong("Another");
  wrong.tracker.say(devices::igtl_transform(wrong.at("Scope", 0)));
  EXPECT_TRUE(before_long([&] {
    return wrong.source->waits_for().find("the tracker sends Scope") != std::string::npos;
  })) << wrong.source->waits_for();
}

TEST(TrackedSource, ToolsWhoseNamesAreCutToTheSameAreRefusedWithTheRemedy) {
  FakeTracker tracker;
  const sim::Model& model = gynaecology().model;
  TrackerPlan plan;
  plan.address = "127.0.0.1", plan.port = tracker.port;
  plan.tools = {{"camera", "InstrumentTipToReferenceA", {}, {}},
                {model.hands[0].name, "InstrumentTipToReferenceB", {}, {}}};
  EXPECT_EQ(warnings_of(plan).size(), 3u) << "two are long, and both begin alike";
  RestingSource rest(model);
  TrackedSource source(rest, model, plan);
  tracker.take_call();
  tracker.say(
      devices::igtl_transform(tool_at("InstrumentTipToReferenceA", model.scope.port, sim::pose_of(model.start.scope))));
  EXPECT_TRUE(before_long([&] { return source.waits_for().find("Shorten one") != std::string::npos; }))
      << source.waits_for();
  EXPECT_FALSE(source.ready());
}

TEST(TrackerThread, AServerThatHangsUpIsCalledThreeTimesASecondAtMost) {
  FakeTracker tracker;
  devices::TrackerThread thread("127.0.0.1", tracker.port);
  std::atomic<bool> over{false};
  std::thread server([&] {
    while (!over) tracker.take_call(), tracker.hang_up();
  });
  std::this_thread::sleep_for(1500ms);
  const std::uint64_t calls = thread.status().connections;
  EXPECT_GE(calls, 2u);
  EXPECT_LE(calls, 7u);
  over = true;  // the next call ends the server's loop
  server.join();
}

TEST(TrackedSource, TwoToolsCannotLeadTheSame) {
  FakeTracker tracker;
  TrackerPlan plan;
  plan.address = "127.0.0.1", plan.port = tracker.port;
  plan.tools = {{"camera", "A", {}, {}}, {"camera", "B", {}, {}}};
  RestingSource rest(gynaecology().model);
  EXPECT_THROW(TrackedSource(rest, gynaecology().model, plan), core::BadInput);
  plan.port = 1;
  EXPECT_THROW(TrackedSource(rest, gynaecology().model, plan), core::EnvironmentLacks) << "nobody listens there";
}

}  // namespace
}  // namespace trocar::attempt
