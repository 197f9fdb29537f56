#include <array>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/tracker/tracker_file.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/tracker/igtl_texts.hpp>
#include <trocar/scene/json/schema.hpp>

namespace trocar::attempt {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::Shape;

struct Direction {
  const char* name;
  Vec3d points;
};
// As scenes have them: x to the patient's left, y to the head, z to the front.
constexpr std::array<Direction, 6> kDirections = {{{"left", {1, 0, 0}},
                                                   {"right", {-1, 0, 0}},
                                                   {"head", {0, 1, 0}},
                                                   {"feet", {0, -1, 0}},
                                                   {"front", {0, 0, 1}},
                                                   {"back", {0, 0, -1}}}};

std::vector<std::string> direction_names() {
  std::vector<std::string> names;
  for (const Direction& d : kDirections) names.emplace_back(d.name);
  return names;
}

Vec3d direction_of(const std::string& name) {
  for (const Direction& d : kDirections)
    if (name == d.name) return d.points;
  return {};
}

const Shape& grip_shape() {
  static const Shape shape{"grip",
                           "A sensor that measures how far the handle is closed.",
                           {scene::needed(keys::text("sensor", "its name at the tracker (a SENSOR message)")),
                            keys::integer("index", 0, 63, "index of its value, default 0"),
                            scene::needed(keys::number("open", -1e9, 1e9, "its value with the handle open")),
                            scene::needed(keys::number("closed", -1e9, 1e9, "its value with the handle closed"))}};
  return shape;
}

const Shape& tool_shape() {
  static const Shape shape{
      "tool",
      "A tracked tool and its target.",
      {scene::needed(keys::text("role", "camera, left, right, or a trocar's name")),
       scene::needed(keys::text("transform", "its name at the tracker (TRANSFORM, POSITION or an entry of TDATA)")),
       keys::vec3("tip_mm", -2000, 2000, "where the instrument's tip is in the tool's frame, default its origin"),
       keys::object("grip", grip_shape,
                    "a sensor that measures how far the handle is closed; without it other inputs close it")}};
  return shape;
}

TrackerPlan::Tool read_tool(const JsonObject& o) {
  TrackerPlan::Tool tool{o.text("role"), o.text("transform"), 1e-3 * o.vec3("tip_mm"), {}, o.at("transform")};
  for (const JsonObject& g : o.objects("grip")) {
    tool.grip = TrackerPlan::Grip{g.text("sensor"), g.integer("index", 0), g.number("open", 0), g.number("closed", 1)};
    if (tool.grip->open == tool.grip->closed)
      g.fault("closed", tr("expected another value than \"open\", got {}", tool.grip->closed));
  }
  return tool;
}

TrackerPlan read(const scene::JsonDocument& document, std::vector<core::Fault>& faults) {
  TrackerPlan plan;
  plan.file = document.file;
  const JsonObject o(document.root, tracker_plan_shape(), document.file, faults);
  const std::string server = o.text("server");
  const auto colon = server.rfind(':');
  const std::string port = colon == std::string::npos ? "" : server.substr(colon + 1);
  if (!port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos &&
      std::stoi(port) <= 65535 && colon > 0)
    plan.address = server.substr(0, colon), plan.port = std::stoi(port);
  else if (o.has("server"))
    o.fault("server", tr("expected ADDRESS:PORT as 127.0.0.1:18944, got \"{}\"", server));
  const Vec3d x = direction_of(o.text("x_points", "left")), y = direction_of(o.text("y_points", "head"));
  if (dot(x, y) != 0)
    o.fault(o.has("y_points") ? "y_points" : "x_points", tr("expected directions square to each other, got {} and {}",
                                                            o.text("x_points", "left"), o.text("y_points", "head")));
  plan.axes = Mat3d::from_columns(x, y, cross(x, y));
  plan.scale = o.number("scale", 1);
  if (o.has("origin_mm")) plan.origin = 1e-3 * o.vec3("origin_mm");
  for (const JsonObject& tool : o.objects("tools")) plan.tools.push_back(read_tool(tool));
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return plan;
}

}  // namespace

const Shape& tracker_plan_shape() {
  static const Shape shape{
      "tracker",
      "Which tool of a tracker (OpenIGTLink) controls which hand. Other inputs control hands without a tool.",
      {keys::text("$schema", "format of this file"), scene::needed(keys::format(1)),
       scene::needed(keys::text("server", "ADDRESS:PORT where the tracker's server listens")),
       keys::choice("x_points", direction_names(), "where the tracker's x points in the patient, default left"),
       keys::choice("y_points", direction_names(), "where its y points, default head"),
       keys::number("scale", 0.01, 100, "scale of displacements, default 1"),
       keys::vec3("origin_mm", -10000, 10000,
                  "position of the tracker's origin in the scene; without it every tip is at the scene's pose when "
                  "its tool is first seen"),
       scene::needed(keys::objects("tools", tool_shape, 1, "tracked tools and their targets"))}};
  return shape;
}

std::vector<core::Fault> warnings_of(const TrackerPlan& plan) {
  constexpr std::size_t kRoom = devices::kIgtlName;
  std::vector<core::Fault> out;
  for (std::size_t i = 0; i < plan.tools.size(); ++i) {
    const TrackerPlan::Tool& tool = plan.tools[i];
    if (tool.transform.size() > kRoom)
      out.push_back(
          {tool.at, tr("\"{}\" has {} letters: OpenIGTLink sends {} of a name. It is recognised as \"{}\", or "
                       "as the whole where the server sends it as metadata. Shorten it at the server to be sure.",
                       tool.transform, tool.transform.size(), kRoom, tool.transform.substr(0, kRoom))});
    for (std::size_t k = 0; k < i; ++k)
      if (tool.transform != plan.tools[k].transform && tool.transform.size() >= kRoom &&
          tool.transform.substr(0, kRoom) == plan.tools[k].transform.substr(0, kRoom))
        out.push_back({tool.at, tr("\"{}\" and \"{}\" begin with the same {} letters: servers that cut names send the "
                                   "same one for both. Shorten one of them.",
                                   plan.tools[k].transform, tool.transform, kRoom)});
  }
  return out;
}

TrackerPlan read_tracker_plan(const std::filesystem::path& file) {
  std::vector<core::Fault> faults;
  return read(scene::load_json(file, faults), faults);
}

TrackerPlan read_tracker_plan_text(const std::string& text, const std::string& name) {
  std::vector<core::Fault> faults;
  return read(scene::parse_json(text, name, faults), faults);
}

}  // namespace trocar::attempt
