#include <cmath>
#include <stdexcept>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::scene {
namespace {

struct ParameterUnit {
  const char* key;
  double per_file;  ///< what one of the file's is in SI
};
constexpr ParameterUnit kParameterUnits[] = {{"length_mm", 1e-3}, {"angle_deg", portable::pi / 180}, {"ratio", 1}};
constexpr double kParts = 1e6;  // of what is written: nanometres, millionths of a degree

}  // namespace

std::string mechanism_text_with(std::string_view text, std::span<const double> values) {
  std::vector<core::Fault> faults;
  const JsonDocument document = parse_json(text, "mechanism", faults);
  if (!faults.empty()) throw std::invalid_argument(core::to_string(faults.front()));
  const JsonValue* parameters = json_at(document.root, "/parameters");
  std::vector<std::pair<std::string, JsonValue>> changes;
  for (std::size_t i = 0; parameters && i < parameters->items.size() && i < values.size(); ++i)
    for (const ParameterUnit& unit : kParameterUnits) {
      const std::string path = json_path(json_path("/parameters", i), unit.key);
      const JsonValue* there = json_at(document.root, path);
      const double value = std::round(values[i] / unit.per_file * kParts) / kParts;
      if (there && std::fabs(there->number - value) > 0.5 / kParts) changes.emplace_back(path, json_number(value));
    }
  return changes.empty() ? std::string(text) : json_set_all(text, std::move(changes));
}

}  // namespace trocar::scene
