#include <algorithm>
#include <cmath>

#include <trocar/modeller/operations/values.hpp>

namespace trocar::modeller {

using scene::JsonValue;

JsonValue number(double value) { return scene::json_number(std::round(value * 1e4) / 1e4); }

JsonValue point(Vec3d v) { return scene::json_array({number(v.x), number(v.y), number(v.z)}); }

JsonValue points(const std::vector<Vec3d>& values) {
  std::vector<JsonValue> items;
  for (const Vec3d& v : values) items.push_back(point(v));
  return scene::json_array(std::move(items));
}

bool is_point(const JsonValue& value) {
  return value.kind == JsonValue::Kind::array && value.items.size() == 3 &&
         std::all_of(value.items.begin(), value.items.end(),
                     [](const JsonValue& i) { return i.kind == JsonValue::Kind::number; });
}

Vec3d point_of(const JsonValue& value) { return {value.items[0].number, value.items[1].number, value.items[2].number}; }

std::vector<Vec3d> points_of(const JsonValue& value) {
  std::vector<Vec3d> out;
  for (const JsonValue& item : value.items)
    if (is_point(item)) out.push_back(point_of(item));
  return out;
}

double number_in(const JsonValue& object, std::string_view key, double fallback) {
  const scene::JsonMember* member = object.find(key);
  return member && member->value.kind == JsonValue::Kind::number ? member->value.number : fallback;
}

}  // namespace trocar::modeller
