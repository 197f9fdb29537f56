#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/json/json_edit.hpp>
#include <trocar/scene/json/json_text.hpp>

namespace trocar::modeller {
namespace {

using scene::JsonValue;

const KindOfThing& kind_of(const std::string& kind) {
  for (const KindOfThing& k : kinds_of_things())
    if (kind == k.kind) return k;
  throw core::BadInput({{{"", 0, 0}, tr("expected a kind of thing, got \"{}\"", kind)}});
}

bool is_scene(const Draft& draft, const fs::path& file) {
  const scene::MemoryFiles memory = draft.document().over_disk();
  return scene::kind_of_file(file, &memory) == scene::FileKind::scene;
}

/// The scene's own organ, an object in its list; made where there is none.
std::string own_organ(Draft& draft, const fs::path& file) {
  const JsonValue organs = draft.value(file, "/organs");
  for (std::size_t i = 0; i < organs.items.size(); ++i)
    if (organs.items[i].kind == JsonValue::Kind::object) return scene::json_path("/organs", i);
  if (organs.kind != JsonValue::Kind::array) draft.set(file, "/organs", scene::json_array());
  draft.insert(file, "/organs", organs.items.size(), scene::json_object());
  return scene::json_path("/organs", organs.items.size());
}

}  // namespace

void add_thing(Draft& draft, const std::string& kind, const JsonValue& value, const std::string& named) {
  const KindOfThing& of_kind = kind_of(kind);
  const Document& document = draft.document();
  const fs::path file = named.empty() ? document.root() : whole_path(document.root().parent_path() / named);
  const std::string name = value.find("name") ? value.find("name")->value.text : "";
  for (const Thing& thing : outline(document))
    if (thing.name == name && thing.kind == kind)
      throw core::BadInput({{{thing.file.generic_string(), thing.line, 1},
                             tr("expected a name that is free, got \"{}\", which is this {}", name, kind)}});
  const std::string above = of_kind.in_organs && is_scene(draft, file) ? own_organ(draft, file) : "";
  const std::string list = scene::json_path(above, of_kind.list);
  const JsonValue there = draft.value(file, list);
  if (there.kind == JsonValue::Kind::array)
    draft.insert(file, list, there.items.size(), value);
  else
    draft.set(file, list, scene::json_array({value}));
}

}  // namespace trocar::modeller
