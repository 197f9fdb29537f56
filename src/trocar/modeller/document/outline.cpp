#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/document/outline.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

void things_in(const JsonValue& value, const std::string& path, const fs::path& file, std::vector<Thing>& out) {
  for (const scene::JsonMember& m : value.members) {
    const std::string at = scene::json_path(path, m.key);
    for (const KindOfThing& kind : kinds_of_things()) {
      if (m.key != kind.list) continue;
      for (std::size_t i = 0; i < m.value.items.size(); ++i)
        if (const scene::JsonMember* name = m.value.items[i].find("name"))
          out.push_back({kind.kind, name->value.text, file, scene::json_path(at, i), m.value.items[i].line});
    }
    for (std::size_t i = 0; i < m.value.items.size(); ++i) {  // organs in organs, variants
      const JsonValue& item = m.value.items[i];
      if (m.key == "organs" && item.kind == JsonValue::Kind::object)
        things_in(item, scene::json_path(at, i), file, out);
    }
  }
}

}  // namespace

const std::vector<KindOfThing>& kinds_of_things() {
  static const std::vector<KindOfThing> kinds{{"solid", "solids", true},
                                              {"strand", "strands", true},
                                              {"wall", "walls", true},
                                              {"sheet", "sheets", true},
                                              {"membrane", "membranes", true},
                                              {"pouch", "pouches", true},
                                              {"vessel", "vessels", false},
                                              {"port", "ports", false},
                                              {"mark", "marks", false},
                                              {"rigid", "rigids", false},
                                              {"fat", "fat", false},
                                              {"bag", "bags", false},
                                              {"instrument", "instruments", false},
                                              {"tissue", "tissues", false}};
  return kinds;
}

std::vector<Thing> outline(const Document& document) {
  std::vector<Thing> out;
  for (const fs::path& file : document.files()) {
    std::vector<core::Fault> ignored;
    const scene::JsonDocument read = scene::parse_json(document.text(file), "", ignored);
    things_in(read.root, "", file, out);
  }
  return out;
}

Thing thing_named(const Document& document, std::string_view name) {
  const std::size_t colon = name.find(':');
  const std::string_view kind = colon == name.npos ? "" : name.substr(0, colon);
  const std::string_view plain = colon == name.npos ? name : name.substr(colon + 1);
  const std::vector<Thing> all = outline(document);
  for (const Thing& thing : all)
    if (thing.name == plain &&
        (kind.empty() ? thing.kind != "tissue" && thing.kind != "instrument" : thing.kind == kind))
      return thing;
  std::vector<std::string> names;
  for (const Thing& thing : all)
    if (thing.kind != "tissue") names.push_back(thing.name);
  throw core::BadInput({{{"", 0, 0}, scene::unknown_name("thing", name, names)}});  // whoever asked says where
}

JsonValue value_of(const Document& document, const Thing& thing) {
  std::vector<core::Fault> ignored;
  const scene::JsonDocument read = scene::parse_json(document.text(thing.file), "", ignored);
  const JsonValue* value = scene::json_at(read.root, thing.path);
  return value ? *value : JsonValue{};
}

}  // namespace trocar::modeller
