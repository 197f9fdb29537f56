// Things come, go, are doubled and renamed.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/transform.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const KindOfThing& k : kinds_of_things()) names.emplace_back(k.kind);
  return names;
}

Operation add() {
  return {{"add",
           "Puts a new thing into the document.",
           {scene::needed(keys::choice("kind", kind_names(), "what it is")),
            scene::needed(keys::any("value", "what its file would say of it")),
            keys::text("file", "the organ file that it goes into, relative to the document; default: the document")}},
          [](const JsonObject& o, Draft& draft) {
            const JsonValue* value = &o.value().find("value")->value;
            if (!value->find("name")) return o.fault("value", "expected an object with a name, got none");
            add_thing(draft, o.text("kind"), *value, o.text("file"));
          }};
}

Operation remove() {
  return {{"delete", "Takes things out of the document.", {scene::needed(keys::texts("of", "their names"))}},
          [](const JsonObject& o, Draft& draft) {
            std::vector<Thing> things;
            for (const std::string& name : o.texts("of")) things.push_back(draft.thing(name));
            // from the last one on, so that the others' places stay good
            std::stable_sort(things.begin(), things.end(), [](const Thing& a, const Thing& b) {
              return a.file == b.file ? a.line > b.line || (a.line == b.line && a.path > b.path) : a.file < b.file;
            });
            for (const Thing& thing : things) draft.remove(thing.file, thing.path);
          }};
}

Operation duplicate() {
  return {{"duplicate",
           "Puts a copy beside a thing.",
           {scene::needed(keys::text("of", "its name")), scene::needed(keys::name("as", "the copy's name")),
            keys::vec3("by_mm", -2000, 2000, "how far the copy lies from it, default 0")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            JsonValue copy = draft.value(thing.file, thing.path);
            for (scene::JsonMember& m : copy.members)
              if (m.key == "name") m.value = scene::json_text(o.text("as"));
            move_value(copy, o.vec3("by_mm"));
            const std::size_t slash = thing.path.rfind('/');
            draft.insert(thing.file, thing.path.substr(0, slash), std::stoul(thing.path.substr(slash + 1)) + 1, copy);
          }};
}

/// Keys whose texts name things.
bool refers(std::string_view key) {
  static constexpr const char* keys[] = {"of",      "on",       "solid",   "strand", "base_on", "base_organ",
                                         "held_on", "rides_on", "pool_on", "body",   "around",  "duct",
                                         "holds",   "in",       "vessel",  "pouch",  "port",    "instrument"};
  return std::any_of(std::begin(keys), std::end(keys), [&](const char* k) { return key == k; });
}

void references_to(const std::string& name, const JsonValue& value, const std::string& path,
                   std::vector<std::string>& out) {
  for (const scene::JsonMember& m : value.members) {
    const std::string at = scene::json_path(path, m.key);
    if (refers(m.key) && m.value.kind == JsonValue::Kind::string && m.value.text == name) out.push_back(at);
    if (refers(m.key))
      for (std::size_t i = 0; i < m.value.items.size(); ++i)
        if (m.value.items[i].kind == JsonValue::Kind::string && m.value.items[i].text == name)
          out.push_back(scene::json_path(at, i));
    references_to(name, m.value, at, out);
  }
  for (std::size_t i = 0; i < value.items.size(); ++i)
    references_to(name, value.items[i], scene::json_path(path, i), out);
}

Operation rename() {
  return {{"rename",
           "Gives a thing another name, everywhere in the document.",
           {scene::needed(keys::text("of", "its name")), scene::needed(keys::name("to", "the new one"))}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            draft.set(thing.file, thing.path + "/name", scene::json_text(o.text("to")));
            for (const fs::path& file : draft.document().files()) {
              std::vector<std::string> paths;
              references_to(thing.name, draft.value(file, ""), "", paths);
              for (const std::string& path : paths) draft.set(file, path, scene::json_text(o.text("to")));
            }
          }};
}

}  // namespace

std::vector<Operation> body_operations() { return {add(), remove(), duplicate(), rename()}; }

}  // namespace trocar::modeller
