#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/operations/vessel_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

constexpr double kArterialDrop = 15, kVenousDrop = 2, kVenousPressure = 8;  ///< [mmHg]

JsonValue source_of(const VesselText& tree) {
  const double flow = tree.flow_mL_min / 60;  // [mL/s]
  JsonValue source = scene::json_object();
  scene::put(source, "node", scene::json_text("root"));
  scene::put(source, "resistance_mmHg_s_mL", number((tree.veins ? kVenousDrop : kArterialDrop) / flow));
  if (tree.veins) {
    scene::put(source, "kind", scene::json_text("steady"));
    scene::put(source, "pressure_mmHg", number(kVenousPressure));
    scene::put(source, "venous", scene::json_flag(true));
  }
  return source;
}

}  // namespace

std::string written_vessels(const VesselText& tree) {
  JsonValue text = scene::json_object();
  scene::put(text, "format", number(1));
  scene::put(text, "name", scene::json_text(tree.name));
  if (tree.veins) scene::put(text, "kind", scene::json_text("veins"));
  scene::put(text, "vessels", scene::json_array(tree.vessels));
  scene::put(text, "ends", scene::json_array(tree.ends));
  scene::put(text, "sources", scene::json_array({source_of(tree)}));
  return scene::to_text(text);
}

JsonValue vessel_end(const std::string& node, double flow_mL_min) {
  JsonValue end = scene::json_object();
  scene::put(end, "node", scene::json_text(node));
  scene::put(end, "flow_mL_min", number(flow_mL_min));
  return end;
}

void put_vessel_file(Draft& draft, const std::string& file, std::string text) {
  const fs::path root = draft.document().root();
  draft.put(whole_path(root.parent_path() / file), std::move(text));
  const JsonValue there = draft.value(root, "/vessels"), name = scene::json_text(file);
  if (there.kind == JsonValue::Kind::array)
    draft.insert(root, "/vessels", there.items.size(), name);
  else
    draft.set(root, "/vessels", scene::json_array({name}));
}

}  // namespace trocar::modeller
