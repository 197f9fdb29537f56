// What a scene is besides its bodies: how the patient lies, ports, what stands in them, the scope, marks, what another
// patient has otherwise.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/document/home.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/description/description.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/like.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

constexpr double kStandardGravity = 9.81;  // [m/s^2]
constexpr double kDegree = portable::pi / 180;

/// Lying level is gravity along -z. Head down is a turn about the patient's x, a side down one about his y.
Operation tilt() {
  return {{"tilt",
           "How the patient lies on the table: which way things fall.",
           {keys::number("head_down_deg", -60, 60, "Trendelenburg; negative: head up; default 0"),
            keys::number("left_down_deg", -45, 45, "left side down; negative: right side; default 0")}},
          [](const JsonObject& o, Draft& draft) {
            const double head = o.number("head_down_deg") * kDegree, left = o.number("left_down_deg") * kDegree;
            const Vec3d down{portable::sin(left) * portable::cos(head), portable::sin(head),
                             -portable::cos(left) * portable::cos(head)};
            draft.set(draft.document().root(), "/gravity_m_s2", point(down * kStandardGravity));
          }};
}

/// What the scene says under a key, itself or through the one that it is like. As its own from now on: a list of its
/// own stands for all of the other's.
JsonValue own_value(Draft& draft, const std::string& key) {
  fs::path file = draft.document().root();
  for (int depth = 0; depth < 8; ++depth) {
    const JsonValue scene = draft.value(file, "");
    if (const scene::JsonMember* m = scene.find(key)) {
      if (depth == 0) return m->value;
      const fs::path& root = draft.document().root();
      JsonValue own = renamed_value(key, m->value, file.parent_path(), root.parent_path());
      draft.set(root, "/" + key, own);
      return own;
    }
    const scene::JsonMember* like = scene.find(scene::kLike);
    if (!like) break;
    const fs::path below = named_file(draft.document(), file.parent_path(), like->value.text);
    if (!draft.has(below)) break;
    file = below;
  }
  return {};
}

void append(Draft& draft, const std::string& key, const JsonValue& item) {
  const JsonValue there = own_value(draft, key);
  const fs::path& root = draft.document().root();
  if (there.kind == JsonValue::Kind::array)
    draft.insert(root, "/" + key, there.items.size(), item);
  else
    draft.set(root, "/" + key, scene::json_array({item}));
}

Operation port() {
  return {{"port",
           "A trocar through the wall of the abdomen.",
           {scene::needed(keys::name("name", "what tools call it")),
            scene::needed(keys::vec3("position_mm", -2000, 2000, "where it goes through the wall")),
            keys::number("diameter_mm", 2, 40, "default 5")}},
          [](const JsonObject& o, Draft& draft) {
            JsonValue made = scene::json_object();
            scene::put(made, "name", scene::json_text(o.text("name")));
            scene::put(made, "position_mm", point(o.vec3("position_mm")));
            scene::put(made, "diameter_mm", number(o.number("diameter_mm", 5)));
            own_value(draft, "ports");
            add_thing(draft, "port", made, "");
          }};
}

/// Makes an instrument's file one of the scene's. @return the name that the file gives it
std::string added_instrument(Draft& draft, const std::string& named) {
  const fs::path folder = draft.document().root().parent_path();
  const fs::path file = named_file(draft.document(), folder, named);
  const scene::Library library(draft.document().root());
  if (!library.holds(file)) throw core::BadInput({{{"", 0, 0}, library.refusal(named)}});
  const JsonValue instrument = draft.value(file, "");
  const JsonValue there = own_value(draft, "instruments");
  const bool has = std::any_of(there.items.begin(), there.items.end(), [&](const JsonValue& item) {
    return named_file(draft.document(), folder, item.text) == file;
  });
  if (!has) append(draft, "instruments", scene::json_text(named));
  const scene::JsonMember* name = instrument.find("name");
  return name && !name->value.text.empty() ? name->value.text : fs::path(named).stem().string();
}

Operation tool() {
  return {{"tool",
           "An instrument in a port, for a hand of its own: the first in the list is the left one.",
           {scene::needed(keys::text("instrument", "one of the scene's, or a file of one")),
            scene::needed(keys::text("port", "the port that it passes")),
            scene::needed(keys::vec3("tip_mm", -2000, 2000, "where its tip is at the start")),
            keys::number("roll_deg", -360, 360, "turned about its shaft, default 0")}},
          [](const JsonObject& o, Draft& draft) {
            std::string instrument = o.text("instrument");
            if (fs::path(instrument).extension() == ".json") instrument = added_instrument(draft, instrument);
            JsonValue placed = scene::json_object();
            scene::put(placed, "instrument", scene::json_text(instrument));
            scene::put(placed, "port", scene::json_text(o.text("port")));
            scene::put(placed, "tip_mm", point(o.vec3("tip_mm")));
            if (o.has("roll_deg")) scene::put(placed, "roll_deg", number(o.number("roll_deg")));
            append(draft, "tools", placed);
          }};
}

Operation scope() {
  return {{"scope",
           "The endoscope: its port, tip and optics. Fields that are left out stay.",
           {keys::text("port", "the port that it passes"), keys::vec3("tip_mm", -2000, 2000, "where its tip is"),
            keys::number("angle_deg", 0, 90, "between its shaft and its view"),
            keys::number("field_of_view_deg", 20, 140, "full cone"),
            keys::number("roll_deg", -360, 360, "turned about its shaft")}},
          [](const JsonObject& o, Draft& draft) {
            JsonValue scope = own_value(draft, "scope");
            const fs::path& root = draft.document().root();
            if (scope.kind != JsonValue::Kind::object) draft.set(root, "/scope", scene::json_object());
            if (o.has("port")) draft.set(root, "/scope/port", scene::json_text(o.text("port")));
            if (o.has("tip_mm")) draft.set(root, "/scope/tip_mm", point(o.vec3("tip_mm")));
            for (const char* key : {"angle_deg", "field_of_view_deg", "roll_deg"})
              if (o.has(key)) draft.set(root, std::string("/scope/") + key, number(o.number(key)));
          }};
}

Operation mark() {
  return {
      {"mark",
       "A mark that exercises can name: what must be found, touched or left alone.",
       {scene::needed(keys::name("name", "what exercises call it")),
        keys::text("on", "the body that it is on, default: it stays in space"),
        scene::needed(keys::vec3("place_mm", -2000, 2000, "its middle")),
        keys::number("diameter_mm", 0.5, 50, "default 5"), keys::text("label", "written on it: at most three digits"),
        keys::choice("colour", {scene::kMarkColours.begin(), scene::kMarkColours.end()},
                     "none: it is not drawn; default white")}},
      [](const JsonObject& o, Draft& draft) {
        JsonValue made = scene::json_object();
        scene::put(made, "name", scene::json_text(o.text("name")));
        if (o.has("on")) scene::put(made, "on", scene::json_text(draft.thing(o.text("on")).name));
        scene::put(made, "place_mm", point(o.vec3("place_mm")));
        if (o.has("diameter_mm")) scene::put(made, "diameter_mm", number(o.number("diameter_mm")));
        for (const char* key : {"label", "colour"})
          if (o.has(key)) scene::put(made, key, scene::json_text(o.text(key)));
        own_value(draft, "marks");
        add_thing(draft, "mark", made, "");
      }};
}

/// What another seed makes different, of a body: how wide it is, how stiff.
Operation vary() {
  return {{"vary",
           "What another patient has otherwise: widths of bodies, stiffness, each within so much of what is drawn.",
           {keys::texts("girths_of", "bodies that are wider or narrower"),
            keys::number("radius", 0.001, 0.9, "their widths, as a share: 0.1 is a tenth more or less; default 0.1"),
            keys::number("stiffness", 0, 0.9, "of all tissue, as a share; default: as it is")}},
          [](const JsonObject& o, Draft& draft) {
            const fs::path& root = draft.document().root();
            if (own_value(draft, "variation").kind != JsonValue::Kind::object)
              draft.set(root, "/variation", scene::json_object());
            if (o.has("stiffness")) draft.set(root, "/variation/stiffness", number(o.number("stiffness")));
            if (!o.has("girths_of")) return;
            std::vector<JsonValue> of;
            for (const std::string& name : o.texts("girths_of")) of.push_back(scene::json_text(draft.thing(name).name));
            JsonValue girth = scene::json_object();
            scene::put(girth, "of", scene::json_array(std::move(of)));
            scene::put(girth, "radius", number(o.number("radius", 0.1)));
            const JsonValue there = draft.value(root, "/variation/girths");
            if (there.kind == JsonValue::Kind::array)
              draft.insert(root, "/variation/girths", there.items.size(), girth);
            else
              draft.set(root, "/variation/girths", scene::json_array({girth}));
          }};
}

}  // namespace

std::vector<Operation> place_operations() { return {tilt(), port(), tool(), scope(), mark(), vary()}; }

}  // namespace trocar::modeller
