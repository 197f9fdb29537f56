// Trees of vessels as they are drawn: a tree, its branches one after another, radii by Murray's law.
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/sketch.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/operations/vessel_text.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

fs::path beside(const Draft& draft, const std::string& file) {
  return whole_path(draft.document().root().parent_path() / file);
}

std::vector<scene::Key> drawn_keys(std::vector<scene::Key> keys) {
  for (scene::Key& key : sketch_keys()) keys.push_back(std::move(key));
  return keys;
}

scene::Key file_key() { return scene::needed(keys::text("file", "the file of vessels, relative to the document")); }

Operation new_tree() {
  return {{"vessel_tree", "Begins a tree of vessels in a file of its own, with its first vessel.",
           drawn_keys({file_key(), scene::needed(keys::name("name", "of the tree")),
                       keys::choice("kind", {"arteries", "veins"}, "default arteries"),
                       scene::needed(keys::name("vessel", "name of the first vessel")),
                       scene::needed(
                           keys::points("path_mm", -2000, 2000, 2, "its middle line, away from the heart in arteries")),
                       scene::needed(keys::number("radius_mm", 0.01, 50, "of its lumen")),
                       scene::needed(keys::number("flow_mL_min", 0.001, 20000, "what all of the tree carries at rest")),
                       keys::texts("rides_on", "bodies that it goes with where they are near")})},
          [](const JsonObject& o, Draft& draft) {
            if (draft.has(beside(draft, o.text("file"))))
              return o.fault("file", "expected the name of a new file, got one that is there");
            const std::string to = o.text("vessel") + "_end";
            VesselText tree;
            tree.name = o.text("name");
            tree.veins = o.text("kind") == "veins";
            tree.flow_mL_min = o.number("flow_mL_min", tree.flow_mL_min);
            JsonValue vessel = scene::json_object();
            scene::put(vessel, "name", scene::json_text(o.text("vessel")));
            scene::put(vessel, "from", scene::json_text("root"));
            scene::put(vessel, "to", scene::json_text(to));
            scene::put(vessel, "path_mm", points(sketched(o, draft, o.points("path_mm"))));
            scene::put(vessel, "radius_mm", number(o.number("radius_mm")));
            scene::put(vessel, "wave_speed_m_s", number(tree.veins ? 3 : 7));
            std::vector<JsonValue> rides;
            for (const std::string& on : o.texts("rides_on")) rides.push_back(scene::json_text(on));
            if (!rides.empty()) scene::put(vessel, "rides_on", scene::json_array(rides));
            tree.vessels.push_back(std::move(vessel));
            tree.ends.push_back(vessel_end(to, tree.flow_mL_min));
            put_vessel_file(draft, o.text("file"), written_vessels(tree));
          }};
}

const JsonValue* member(const JsonValue& object, const char* key) {
  const scene::JsonMember* m = object.find(key);
  return m ? &m->value : nullptr;
}
std::string text_in(const JsonValue& object, const char* key) {
  const JsonValue* v = member(object, key);
  return v ? v->text : "";
}

/// Radii of a tree's vessels by Murray's law: r^3 of what comes is the sum of those of what goes. What leaves a node
/// has equal shares unless its file says otherwise; ends take up flow in proportion to r^3.  [Murray 1926]
void lay_out_by_murray(Draft& draft, const fs::path& file, double flow) {
  const JsonValue tree = draft.value(file, "");
  const JsonValue* vessels = member(tree, "vessels");
  std::map<std::string, std::vector<std::size_t>> leaving;
  for (std::size_t i = 0; vessels && i < vessels->items.size(); ++i)
    leaving[text_in(vessels->items[i], "from")].push_back(i);
  std::vector<std::pair<std::string, JsonValue>> values;
  std::vector<JsonValue> ends;
  double leaves = 0;
  std::vector<std::pair<std::string, double>> leaf_cubes;
  std::vector<std::size_t> open = leaving["root"];
  std::map<std::size_t, double> radius;
  for (const std::size_t i : open) radius[i] = number_in(vessels->items[i], "radius_mm", 1);
  for (std::size_t at = 0; at < open.size() && at < vessels->items.size(); ++at) {
    const std::size_t i = open[at];
    const std::string to = text_in(vessels->items[i], "to");
    const std::vector<std::size_t>& children = leaving[to];
    for (const std::size_t child : children) {
      radius[child] = radius[i] / std::cbrt(double(children.size()));
      values.emplace_back(scene::json_path("/vessels", child) + "/radius_mm", number(radius[child]));
      open.push_back(child);
    }
    if (children.empty()) {
      leaf_cubes.emplace_back(to, radius[i] * radius[i] * radius[i]);
      leaves += leaf_cubes.back().second;
    }
  }
  for (const auto& [node, cube] : leaf_cubes) {
    ends.push_back(vessel_end(node, flow * cube / leaves));
  }
  draft.set_all(file, std::move(values));
  draft.set(file, "/ends", scene::json_array(std::move(ends)));
}

double whole_flow(const JsonValue& tree) {
  double sum = 0;
  if (const JsonValue* ends = member(tree, "ends"))
    for (const JsonValue& end : ends->items) sum += number_in(end, "flow_mL_min", 0);
  return sum;
}

Operation branch() {
  return {
      {"branch",
       "Extends a vessel from its end along a line, or branches it. Radii follow from Murray's law, r^3 = sum r_i^3, "
       "and "
       "the flow at the ends with them.",
       drawn_keys({scene::needed(keys::text("of", "the vessel from whose end it goes")),
                   scene::needed(keys::name("name", "of the new one")),
                   scene::needed(keys::points("path_mm", -2000, 2000, 1, "its points after that end")),
                   keys::texts("rides_on", "bodies that it goes with where they are near, default: as the other")})},
      [](const JsonObject& o, Draft& draft) {
        const Thing parent = draft.thing("vessel:" + o.text("of"));
        const JsonValue from = draft.value(parent.file, parent.path);
        const JsonValue tree = draft.value(parent.file, "");
        const double flow = whole_flow(tree);
        const std::vector<Vec3d> there = points_of(*member(from, "path_mm"));
        std::vector<Vec3d> path{there.back()};
        for (const Vec3d& p : sketched(o, draft, o.points("path_mm"))) path.push_back(p);
        JsonValue vessel = scene::json_object();
        scene::put(vessel, "name", scene::json_text(o.text("name")));
        scene::put(vessel, "from", scene::json_text(text_in(from, "to")));
        scene::put(vessel, "to", scene::json_text(o.text("name") + "_end"));
        scene::put(vessel, "path_mm", points(path));
        scene::put(vessel, "radius_mm", number(number_in(from, "radius_mm", 1)));
        scene::put(vessel, "wave_speed_m_s", number(number_in(from, "wave_speed_m_s", 7)));
        std::vector<JsonValue> rides;
        for (const std::string& on : o.texts("rides_on")) rides.push_back(scene::json_text(on));
        if (!rides.empty())
          scene::put(vessel, "rides_on", scene::json_array(rides));
        else if (const JsonValue* on = member(from, "rides_on"))
          scene::put(vessel, "rides_on", *on);
        draft.insert(parent.file, "/vessels", member(tree, "vessels")->items.size(), vessel);
        lay_out_by_murray(draft, parent.file, flow);
      }};
}

}  // namespace

std::vector<Operation> vessel_operations() { return {new_tree(), branch()}; }

}  // namespace trocar::modeller
