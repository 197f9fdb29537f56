#include "commands/checks/check_inputs.hpp"

#include <fmt/format.h>

#include <trocar/attempt/inputs/input_map.hpp>
#include <trocar/attempt/tracker/tracker_file.hpp>

#include "commands/checks/check_warnings.hpp"

namespace trocar::app {
namespace {

bool is_tracker(const scene::JsonValue& root) { return root.find("server") != nullptr; }

}  // namespace

bool is_inputs_file(const scene::JsonValue& root) {
  if (root.find("name") != nullptr) return false;
  return root.find("parts") != nullptr || is_tracker(root);
}

Json describe_inputs(const std::filesystem::path& path, const scene::JsonValue& root) {
  Json out{{"file", path.string()}, {"kind", is_tracker(root) ? "tracker" : "input map"}, {"leads", Json::array()}};
  const auto lead = [&out](const std::string& role, const std::string& by) {
    out["leads"].push_back({{"role", role}, {"by", by}});
  };
  if (is_tracker(root)) {
    const attempt::TrackerPlan plan = attempt::read_tracker_plan(path);
    for (const auto& tool : plan.tools) lead(tool.role, tool.transform);
    add_warnings(out, attempt::warnings_of(plan));
  } else {
    for (const auto& part : attempt::read_input_map(path).parts) lead(part.role, part.device);
  }
  return out;
}

void print_inputs(const Json& inputs) {
  for (const Json& lead : inputs["leads"])
    fmt::print("  {}: {}\n", lead["role"].get<std::string>(), lead["by"].get<std::string>());
}

}  // namespace trocar::app
