#include <algorithm>

#include <trocar/scene/json/json_text.hpp>
#include <trocar/scene/json/like.hpp>
#include <trocar/scene/json/schema.hpp>

namespace trocar::scene {
namespace {

using Type = Key::Type;

JsonValue type(const char* name) {
  JsonValue v = json_object();
  put(v, "type", json_text(name));
  return v;
}

/// The shapes that a schema needs beside its own, each once.
class Writer {
 public:
  JsonValue object(const Shape& shape) {
    JsonValue v = type("object");
    put(v, "description", json_text(shape.meaning));
    JsonValue properties = json_object();
    std::vector<JsonValue> required;
    for (const Key& key : shape.keys) {
      JsonValue p = property(key);
      put(p, "description", json_text(key.meaning));
      put(properties, key.name, std::move(p));
      if (key.required) required.push_back(json_text(key.name));
    }
    put(v, "properties", std::move(properties));
    if (!required.empty()) put_required(v, shape, std::move(required));
    put(v, "additionalProperties", json_flag(false));
    return v;
  }

  JsonValue definitions() {
    JsonValue v = json_object();
    for (std::size_t i = 0; i < m_shapes.size(); ++i) put(v, m_shapes[i]->name, object(*m_shapes[i]));
    return v;
  }

 private:
  std::vector<const Shape*> m_shapes;

  static void put_required(JsonValue& v, const Shape& shape, std::vector<JsonValue> required) {
    if (!shape.find(kLike)) return put(v, "required", json_array(std::move(required)));
    std::vector<JsonValue> own;
    for (const Key& key : like_another(shape).keys)
      if (key.required) own.push_back(json_text(key.name));
    own.push_back(json_text(kLike));
    JsonValue whole = json_object(), less = json_object();
    put(whole, "required", json_array(std::move(required)));
    put(less, "required", json_array(std::move(own)));
    put(v, "anyOf", json_array({std::move(whole), std::move(less)}));
  }

  JsonValue reference(const Shape& shape) {
    const auto same = [&](const Shape* s) { return s->name == shape.name; };
    if (std::none_of(m_shapes.begin(), m_shapes.end(), same)) m_shapes.push_back(&shape);
    JsonValue v = json_object();
    std::string pointer = "#/$defs/";
    for (const char c : shape.name) pointer += c == ' ' ? std::string("%20") : std::string(1, c);
    put(v, "$ref", json_text(pointer));
    return v;
  }

  static JsonValue number(const Key& key, const char* name) {
    JsonValue v = type(name);
    if (key.low == key.high) {
      put(v, "const", json_number(key.low));
    } else {
      put(v, "minimum", json_number(key.low));
      put(v, "maximum", json_number(key.high));
    }
    return v;
  }
  static JsonValue array(JsonValue item, std::size_t least, std::size_t most) {
    JsonValue v = type("array");
    put(v, "items", std::move(item));
    if (least > 0) put(v, "minItems", json_number(double(least)));
    put(v, "maxItems", json_number(double(most)));
    return v;
  }
  static JsonValue text(const Key& key) {
    JsonValue v = type("string");
    if (key.choices.empty()) return v;
    std::vector<JsonValue> choices;
    for (const std::string& choice : key.choices) choices.push_back(json_text(choice));
    put(v, "enum", json_array(std::move(choices)));
    return v;
  }
  static JsonValue point(const Key& key) { return array(number(key, "number"), 3, 3); }

  JsonValue property(const Key& key) {
    switch (key.type) {
      case Type::number:
        return number(key, "number");
      case Type::integer:
        return number(key, "integer");
      case Type::flag:
        return type("boolean");
      case Type::text:
        return text(key);
      case Type::name: {
        JsonValue v = type("string");
        put(v, "pattern", json_text("^[A-Za-z0-9_-]{1,64}$"));
        return v;
      }
      case Type::texts:
        return array(text(key), key.min_count, key.max_count);
      case Type::vec3:
        return point(key);
      case Type::points:
        return array(point(key), key.min_count, key.max_count);
      case Type::lines:
        return array(array(point(key), key.min_count, key.max_count), 1, key.max_count);
      case Type::grid:
        return array(array(point(key), key.min_count, key.max_count), key.min_count, key.max_count);
      case Type::numbers:
        return array(number(key, "number"), key.min_count, key.max_count);
      case Type::table:
        return array(array(number(key, "number"), key.min_count, key.max_count), key.min_count, key.max_count);
      case Type::object:
        return reference(key.shape());
      case Type::objects:
        return array(reference(key.shape()), key.min_count, key.max_count);
      case Type::includes: {
        JsonValue either = json_object();
        put(either, "anyOf", json_array({type("string"), reference(key.shape())}));
        return array(std::move(either), key.min_count, key.max_count);
      }
      case Type::any:
        return json_object();
    }
    return json_object();
  }
};

}  // namespace

std::string json_schema(const Shape& shape) {
  JsonValue v = json_object();
  put(v, "$schema", json_text("https://json-schema.org/draft/2020-12/schema"));
  put(v, "title", json_text(shape.name));
  Writer writer;
  for (JsonMember& m : writer.object(shape).members) put(v, m.key, std::move(m.value));
  JsonValue definitions = writer.definitions();
  if (!definitions.members.empty()) put(v, "$defs", std::move(definitions));
  return to_text(v);
}

}  // namespace trocar::scene
