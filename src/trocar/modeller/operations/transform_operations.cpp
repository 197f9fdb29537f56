// Move, rotate, scale, mirror.
#include <algorithm>

#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/transform.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

bool among(std::string_view key, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), key) != words.end();
}

bool holds_points(const JsonValue& v) {
  return v.kind == JsonValue::Kind::array && !v.items.empty() && (is_point(v.items[0]) || holds_points(v.items[0]));
}

/// Places and vectors in arrays of any depth.
JsonValue moved_points(const JsonValue& v, const std::function<Vec3d(Vec3d)>& f) {
  if (is_point(v)) return point(f(point_of(v)));
  std::vector<JsonValue> items;
  for (const JsonValue& item : v.items) items.push_back(moved_points(item, f));
  return scene::json_array(std::move(items));
}

/// Mirrored, a net's other side would be its outer one: its rows run backwards then.
JsonValue reversed_rows(JsonValue net) {
  for (JsonValue& row : net.items) std::reverse(row.items.begin(), row.items.end());
  return net;
}

void places_in(const JsonValue& value, std::string_view key, std::vector<Vec3d>& out) {
  if (is_point(value)) {
    if (role_of(key, value) == Role::place) out.push_back(point_of(value));
    return;
  }
  for (const scene::JsonMember& m : value.members) places_in(m.value, m.key, out);
  for (const JsonValue& item : value.items) places_in(item, key, out);
}

scene::Key things_key() { return scene::needed(keys::texts("of", "names of things")); }
scene::Key about_key() { return keys::vec3("about_mm", -2000, 2000, "what stays, default: their middle"); }

void apply_to(const JsonObject& o, Draft& draft, const std::function<Movement(Vec3d middle)>& movement) {
  std::vector<Thing> things;
  std::vector<Vec3d> places;
  for (const std::string& name : o.texts("of")) {
    things.push_back(draft.thing(name));
    places_in(draft.value(things.back().file, things.back().path), "", places);
  }
  Vec3d middle{0, 0, 0};
  for (const Vec3d& p : places) middle += p / double(places.size());
  const Movement m = movement(o.has("about_mm") ? o.vec3("about_mm") : middle);
  for (const Thing& thing : things) {
    std::vector<std::pair<std::string, JsonValue>> values;
    moved_values(draft.value(thing.file, thing.path), thing.path, m,
                 [&](std::string path, JsonValue value) { values.emplace_back(std::move(path), std::move(value)); });
    draft.set_all(thing.file, std::move(values));
  }
}

Operation move() {
  return {
      {"move", "Moves things.", {things_key(), scene::needed(keys::vec3("by_mm", -2000, 2000, "how far"))}},
      [](const JsonObject& o, Draft& draft) {
        const Vec3d by = o.vec3("by_mm");
        apply_to(o, draft, [&](Vec3d) { return Movement{[=](Vec3d p) { return p + by; }, [](Vec3d v) { return v; }}; });
      }};
}

/// About an axis through the origin by an angle [rad].  [Rodrigues 1840]
Vec3d turned(Vec3d v, Vec3d axis, double angle) {
  const double c = portable::cos(angle), s = portable::sin(angle);
  return v * c + cross(axis, v) * s + axis * (dot(axis, v) * (1 - c));
}

Operation rotate() {
  return {{"rotate",
           "Turns things about an axis, as a right-handed screw.",
           {things_key(), scene::needed(keys::vec3("axis", -1, 1, "the direction that stays")),
            scene::needed(keys::number("by_deg", -36000, 36000, "how far")), about_key()}},
          [](const JsonObject& o, Draft& draft) {
            const Vec3d given = o.vec3("axis");
            if (!(length(given) > 1e-9)) return o.fault("axis", "expected a direction, got none");
            const Vec3d axis = given / length(given);
            const double angle = o.number("by_deg") * portable::pi / 180;
            apply_to(o, draft, [&](Vec3d about) {
              return Movement{[=](Vec3d p) { return about + turned(p - about, axis, angle); },
                              [=](Vec3d v) { return turned(v, axis, angle); }};
            });
          }};
}

Operation scale() {
  return {{"scale",
           "Makes things larger or smaller, thickness and all.",
           {things_key(), scene::needed(keys::number("by", 0.001, 1000, "factor")), about_key()}},
          [](const JsonObject& o, Draft& draft) {
            const double by = o.number("by", 1);
            apply_to(o, draft, [&](Vec3d about) {
              return Movement{[=](Vec3d p) { return about + (p - about) * by; }, [=](Vec3d v) { return v * by; }, by};
            });
          }};
}

Operation stretch() {
  return {{"stretch",
           "Makes things longer or shorter along the axes.",
           {things_key(), scene::needed(keys::vec3("by", 0.01, 100, "factors along x, y and z")), about_key()}},
          [](const JsonObject& o, Draft& draft) {
            const Vec3d by = o.vec3("by");
            const auto each = [=](Vec3d v) { return Vec3d{v.x * by.x, v.y * by.y, v.z * by.z}; };
            apply_to(o, draft, [&](Vec3d about) {
              return Movement{[=](Vec3d p) { return about + each(p - about); }, each};
            });
          }};
}

Operation mirror() {
  return {{"mirror",
           "Left becomes right: things on the other side of a plane across the patient's x.",
           {things_key(), keys::number("x_mm", -2000, 2000, "where that plane is, default 0")}},
          [](const JsonObject& o, Draft& draft) {
            const double x = o.number("x_mm");
            apply_to(o, draft, [&](Vec3d) {
              return Movement{[=](Vec3d p) {
                                return Vec3d{2 * x - p.x, p.y, p.z};
                              },
                              [](Vec3d v) {
                                return Vec3d{-v.x, v.y, v.z};
                              },
                              1, true};
            });
          }};
}

}  // namespace

Role role_of(std::string_view key, const JsonValue& value) {
  const bool mm = key.size() > 3 && key.substr(key.size() - 3) == "_mm";
  if (is_point(value) || holds_points(value)) {
    if (among(key, {"across_mm", "deep_mm", "normal", "axis", "towards", "direction", "fibre"})) return Role::vector;
    return mm && !among(key, {"pebble_mm", "by_mm", "profile_mm"}) ? Role::place : Role::none;
  }
  if (value.kind == JsonValue::Kind::number &&
      among(key, {"radius_mm", "radius_to_mm", "lumen_mm", "s_mm", "from_mm", "to_mm", "at_mm", "wall_mm", "reach_mm"}))
    return Role::length;
  return Role::none;
}

void moved_values(const JsonValue& value, const std::string& path, const Movement& movement,
                  const std::function<void(std::string, JsonValue)>& put) {
  for (const scene::JsonMember& m : value.members) {
    const std::string at = scene::json_path(path, m.key);
    const Role role = role_of(m.key, m.value);
    if (m.key == "unit_mm" && m.value.kind == JsonValue::Kind::number) {  // of a file whose coordinates stay
      if (movement.length != 1) put(at, scene::json_number(m.value.number * movement.length));
    } else if (role == Role::length) {
      if (movement.length != 1) put(at, number(m.value.number * movement.length));
    } else if (role == Role::none) {
      moved_values(m.value, at, movement, put);
    } else {
      JsonValue moved = moved_points(m.value, role == Role::place ? movement.place : movement.vector);
      if (movement.mirrors && m.key == "net_mm") moved = reversed_rows(std::move(moved));
      // a mirrored section keeps its turning sense by its second half axis backwards, the same super-ellipse
      if (movement.mirrors && m.key == "deep_mm")
        moved = moved_points(moved, [](Vec3d v) { return Vec3d{0, 0, 0} - v; });
      if (moved.items.size() == m.value.items.size() && !is_point(m.value) && !movement.mirrors) {
        for (std::size_t i = 0; i < moved.items.size(); ++i) put(scene::json_path(at, i), moved.items[i]);
        continue;  // item by item, so that comments between them stay
      }
      put(at, std::move(moved));
    }
  }
  for (std::size_t i = 0; i < value.items.size(); ++i)
    moved_values(value.items[i], scene::json_path(path, i), movement, put);
}

void move_value(JsonValue& value, Vec3d by) {
  const Movement movement{[=](Vec3d p) { return p + by; }, [](Vec3d v) { return v; }};
  for (scene::JsonMember& m : value.members) {
    const Role role = role_of(m.key, m.value);
    if (role == Role::place)
      m.value = moved_points(m.value, movement.place);
    else if (role == Role::none)
      move_value(m.value, by);
  }
  for (JsonValue& item : value.items) move_value(item, by);
}

Vec3d middle_of(const JsonValue& value) {
  std::vector<Vec3d> places;
  places_in(value, "", places);
  Vec3d sum{0, 0, 0};
  for (const Vec3d& p : places) sum += p;
  return places.empty() ? sum : sum / double(places.size());
}

std::vector<Operation> transform_operations() { return {move(), rotate(), scale(), stretch(), mirror()}; }

}  // namespace trocar::modeller
