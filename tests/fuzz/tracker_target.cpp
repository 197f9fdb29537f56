// What a tracker's server sends, in portions whose sizes are in the bytes; and the file that says which tool leads
// what.
#include <cmath>

#include <trocar/attempt/tracker/tracked_source.hpp>
#include <trocar/core/error.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

void check_pose(const devices::TrackedPose& pose) {
  require(length(pose.place) < 1000, "tools are where a tracker sees them");
  for (int c = 0; c < 3; ++c) require(std::fabs(length(pose.turned.column(c)) - 1) < 0.02, "and stand somehow");
  static const attempt::TrackerPlan plan{};
  static const attempt::TrackerPlan::Tool tool{};
  const kinematics::FulcrumPose led = attempt::TrackedTool(plan, tool).follow(pose, {}, {0, 0, 0, 0.1});
  require(std::isfinite(led.yaw + led.pitch + led.roll + led.depth), "what they lead is somewhere, too");
}

}  // namespace

void tracker_stream(Bytes bytes) {
  devices::IgtlReader reader;
  std::uint64_t poses = 0, heard = 0;
  while (bytes.size() > 1) {
    const std::size_t size = std::min<std::size_t>(std::size_t(bytes[0]) + 1, bytes.size() - 1);
    const bool sound =
        reader.hear(bytes.subspan(1, size),
                    {[&poses](const devices::TrackedPose& pose) { check_pose(pose), ++poses; },
                     [](const devices::UnseenTool& tool) {
                       require(!tool.why.empty() && tool.why.size() <= 60, "a server's word is short");
                       require(tool.name.size() <= devices::kLongestName, "names are bounded");
                     },
                     [](const devices::SensorValues& sensor) {
                       require(sensor.values.size() <= devices::IgtlReader::kMostValues, "values are bounded");
                       for (const double v : sensor.values) require(std::isfinite(v), "and numbers");
                     }});
    heard += size;
    bytes = bytes.subspan(1 + size);
    require(reader.kept() <= devices::IgtlReader::kMostBody, "no more is kept than a message");
    if (!sound) break;
  }
  require(28 * poses <= heard, "every pose has come byte by byte");
}

std::vector<Seed> tracker_seeds() {
  std::vector<Seed> seeds;
  const auto portions = [&seeds](const char* name, const std::vector<std::uint8_t>& all) {
    std::vector<std::uint8_t> out;
    for (std::size_t i = 0; i < all.size(); i += 100) {
      const std::size_t some = std::min<std::size_t>(100, all.size() - i);
      out.push_back(std::uint8_t(some - 1));
      out.insert(out.end(), all.begin() + std::ptrdiff_t(i), all.begin() + std::ptrdiff_t(i + some));
    }
    seeds.push_back({name, out});
  };
  std::vector<std::uint8_t> bytes = devices::igtl_transform({"Tool", {0.1, 0.2, 0.3}, Mat3d::identity()});
  portions("transform", bytes);
  const std::vector<std::uint8_t> sensor = devices::igtl_sensor({"Grips", {0.25, 0.75, -3}});
  portions("sensor", sensor);
  bytes.insert(bytes.end(), sensor.begin(), sensor.end());
  bytes.insert(bytes.end(), bytes.begin(), bytes.end());
  portions("both", bytes);
  portions("texts", devices::igtl_transform(
                        {"LeftGrasperTipToReference", {0.1, 0.2, 0.3}, Mat3d::identity()}, 2,
                        {{"TransformStatus", "MISSING"}, {"IGTL_DEVICE_NAME", "LeftGrasperTipToReference"}}));
  for (const auto& [type, size] :
       {std::pair("TDATA", 140u), std::pair("QTDATA", 100u), std::pair("STATUS", 36u), std::pair("POSITION", 24u)})
    portions(type, devices::igtl_message(type, "Tool", std::vector<std::uint8_t>(size, 0), 3, {{"ToolStatus", "OK"}}));
  bytes = devices::igtl_transform({"Tool", {0.1, 0.2, 0.3}, Mat3d::identity()});
  std::copy_n("IMAGE\0\0\0\0", 9, bytes.begin() + 2);
  bytes.insert(bytes.end(), sensor.begin(), sensor.end());
  portions("another_kind_before", bytes);
  return seeds;
}

void tracker_file(Bytes bytes) {
  try {
    const attempt::TrackerPlan plan = attempt::read_tracker_plan_text(text_of(bytes), "tracker.json");
    require(plan.port >= 0 && plan.port <= 65535, "ports are ports");
    require(!plan.tools.empty(), "some tool leads something");
    for (int c = 0; c < 3; ++c) require(length(plan.axes.column(c)) == 1, "axes point somewhere");
    for (const attempt::TrackerPlan::Tool& tool : plan.tools)
      require(!tool.grip || tool.grip->open != tool.grip->closed, "a grip opens and closes");
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) require(!f.message.empty(), "a fault says what was expected");
  }
}

std::vector<Seed> tracker_file_seeds() {
  return {{"tracker", bytes_of(R"({"format": 1, "server": "127.0.0.1:18944", "x_points": "left", "y_points": "head",
  "scale": 1.5, "origin_mm": [1, 2, 3],
  "tools": [{"role": "right", "transform": "Right", "tip_mm": [0, 0, -310],
             "grip": {"sensor": "Grips", "index": 1, "open": 0, "closed": 1}},
            {"role": "camera", "transform": "Scope"}]})")}};
}

}  // namespace trocar::fuzz
