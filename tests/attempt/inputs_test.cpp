// Several devices at one attempt: the file that says which leads what, and what comes of it.
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include <gtest/gtest.h>

#include <trocar/attempt/inputs/device_parts.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/core/error.hpp>

namespace trocar::attempt {
namespace {

using devices::Button;
using devices::DeviceReading;

const Lesson& operation() {
  static const std::unique_ptr<Lesson> one = load_lesson("gynaecology");
  return *one;
}

InputMap map_of(const std::string& parts) {
  return read_input_map_text(R"({"format": 1, "parts": [)" + parts + "]}", "map.json");
}

std::string faults_of(const std::string& text) {
  try {
    static_cast<void>(read_input_map_text(text, "map.json"));
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return {};
}

TEST(InputMap, TheSecondPadIsTheCamera) {
  const InputMap map = map_of(R"({"role": "camera", "device": "gamepad 2"})");
  std::vector<DeviceReading> all(3);
  all[0].is_pad = all[2].is_pad = true;
  EXPECT_EQ(find(map.parts[0], all), &all[2]) << "the second of those whose buttons are known";
  all[2].pad.left_x = 0.5f;
  EXPECT_EQ(pad_of(map.parts[0], all[2]).left_x, 0.5f);
  EXPECT_EQ(find(map.parts[0], std::span(all).first(2)), nullptr);
}

TEST(InputMap, AnyAxisAndButtonStandsForAGamepads) {
  const InputMap map = map_of(R"({"role": "camera", "device": "Space",
      "axes": [{"from": 4, "to": "left_y", "scale": -2, "dead": 0.5}, {"from": 1, "to": "right_trigger"}],
      "buttons": [{"from": 7, "to": "left_shoulder"}]})");
  DeviceReading mouse{"SpaceNavigator", false, {}, {0, -1, 0, 0, 0.75f}, std::vector<bool>(8)};
  mouse.buttons[7] = true;
  ASSERT_EQ(find(map.parts[0], std::span(&mouse, 1)), &mouse) << "by part of its name";
  const devices::Gamepad pad = pad_of(map.parts[0], mouse);
  EXPECT_FLOAT_EQ(pad.left_y, -1.0f) << "half of what is beyond its rest, twice";
  EXPECT_FLOAT_EQ(pad.right_trigger, 0.0f) << "a trigger is not pushed";
  EXPECT_TRUE(pad.has(Button::left_shoulder));
  mouse.axes[4] = 0.49f;
  EXPECT_FLOAT_EQ(pad_of(map.parts[0], mouse).left_y, 0.0f);
  mouse.axes[4] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FLOAT_EQ(pad_of(map.parts[0], mouse).left_y, 0.0f) << "a broken device may send anything";
  mouse.axes.clear(), mouse.buttons.clear();
  EXPECT_EQ(pad_of(map.parts[0], mouse).buttons, 0u) << "one with less than it should have";
}

TEST(InputMap, AllFaultsAreToldAtTheirPlaces) {
  const std::string told = faults_of(R"({"format": 1, "parts": [
  {"role": "camera", "device": "gamepad 2", "axes": [{"from": -1, "to": "left_x"}]},
  {"role": "left", "axes": [{"from": 0, "to": "yaw"}], "buttons": [{"from": 0, "to": "trigger"}]}]})");
  EXPECT_NE(told.find("map.json:2:63"), std::string::npos) << told;
  EXPECT_NE(told.find("map.json:3:"), std::string::npos) << told;
  EXPECT_NE(told.find("yaw"), std::string::npos) << told;
  EXPECT_NE(told.find("trigger"), std::string::npos) << told;
  EXPECT_NE(told.find("device"), std::string::npos) << told;
}

TEST(InputMap, ThePublishedSchemaSaysWhatTheReaderObeys) {
  std::ifstream file(TROCAR_SOURCE_DIR "/scenes/schema/input_map.schema.json");
  std::stringstream published;
  published << file.rdbuf();
  const std::filesystem::path fresh = std::filesystem::path(TROCAR_BINARY_DIR) / "schema" / "input_map.schema.json";
  std::filesystem::create_directories(fresh.parent_path());
  std::ofstream(fresh) << scene::json_schema(input_map_shape());
  EXPECT_EQ(published.str(), scene::json_schema(input_map_shape())) << "out of date: copy " << fresh.generic_string();
}

TEST(DeviceParts, EachLeadsItsOwnAndNothingElse) {
  const sim::Model& model = operation().model;
  DeviceParts parts(
      map_of(R"({"role": "camera", "device": "gamepad 1"}, {"role": "assistant", "device": "gamepad 2"})"), model);
  std::vector<DeviceReading> all(2);
  all[0].is_pad = all[1].is_pad = true;
  const sim::State state = sim::initial_state(model);
  sim::Input operators = model.start;
  operators.tools[0].yaw += 0.05f;
  parts.take_up(all);
  static_cast<void>(parts.lead(operators, all, 1.0f / 60, state));
  all[0].pad.left_x = 1, all[1].pad.left_x = 1;  // both to the right
  sim::Input now;
  for (int i = 0; i < 30; ++i) now = parts.lead(operators, all, 1.0f / 60, state);
  EXPECT_NE(now.scope.yaw, model.start.scope.yaw);
  EXPECT_NE(now.tools[2].yaw, model.start.tools[2].yaw);
  EXPECT_EQ(now.tools[0].yaw, operators.tools[0].yaw);
  EXPECT_EQ(now.tools[1].yaw, operators.tools[1].yaw);
}

TEST(DeviceParts, AButtonThatChoosesAnotherHandLeavesTheDeviceWithItsOwn) {
  const sim::Model& model = operation().model;
  DeviceParts parts(map_of(R"({"role": "camera", "device": "gamepad 1"})"), model);
  std::vector<DeviceReading> all(1);
  all[0].is_pad = true;
  const sim::State state = sim::initial_state(model);
  sim::Input now;
  for (int i = 0; i < 40; ++i) {
    all[0].pad.set(Button::right_shoulder, i % 8 < 4);
    all[0].pad.left_y = -1;
    now = parts.lead(model.start, all, 1.0f / 60, state);
    for (int h = 0; h < 3; ++h) EXPECT_EQ(now.tools[h].yaw, model.start.tools[h].yaw);
  }
  EXPECT_NE(now.scope.pitch, model.start.scope.pitch);
}

TEST(DeviceParts, ADeviceThatIsAwayIsNamed) {
  DeviceParts parts(map_of(R"({"role": "camera", "device": "gamepad 2"})"), operation().model);
  std::vector<DeviceReading> all(2);
  all[0].is_pad = true;
  EXPECT_NE(parts.missing(all).find("gamepad 2"), std::string::npos);
  all[1].is_pad = true;
  EXPECT_EQ(parts.missing(all), "");
  EXPECT_TRUE(parts.claims(all[1], all));
  EXPECT_FALSE(parts.claims(all[0], all));
}

TEST(DeviceParts, TwoDevicesMayNotLeadTheSame) {
  EXPECT_THROW(
      DeviceParts(map_of(R"({"role": "camera", "device": "a"}, {"role": "camera", "device": "b"})"), operation().model),
      core::BadInput);
}

}  // namespace
}  // namespace trocar::attempt
