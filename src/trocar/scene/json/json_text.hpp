// JSON text of a tree, laid out for people: what fits on a line stands on one, points fill lines, keys keep their
// order.
//
//   JsonValue o = json_object();
//   put(o, "name", json_text("uterus"));
//   put(o, "cell_mm", json_number(3.4));
//   std::string text = to_text(o);          // {"name": "uterus", "cell_mm": 3.4}
#pragma once

#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>

namespace trocar::scene {

JsonValue json_object();
JsonValue json_array(std::vector<JsonValue> items = {});
JsonValue json_number(double value);
JsonValue json_flag(bool value);
JsonValue json_text(std::string value);
void put(JsonValue& object, std::string key, JsonValue value);

/// Numbers are the shortest decimals that read back as the same double. Ends with a newline. The tree must have no
/// broken values.
std::string to_text(const JsonValue& value);

}  // namespace trocar::scene
