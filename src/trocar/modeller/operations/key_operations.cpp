// Single keys of things, of the scene itself, or of any file of the document.
#include <trocar/core/error.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;

scene::Key one_key() { return keys::text("of", "the thing's name, default: the document's own top level"); }
scene::Key key_key() {
  return scene::needed(
      keys::text("key", "its key; one inside another with a stroke between, items by number: sections/2/centre_mm"));
}

std::pair<fs::path, std::string> place_of(const JsonObject& o, const Draft& draft) {
  fs::path file = draft.document().root();
  std::string path;
  if (o.has("of")) {
    const Thing thing = draft.thing(o.text("of"));
    file = thing.file;
    path = thing.path;
  }
  return {file, path + "/" + o.text("key")};
}

Operation set() {
  return {{"set",
           "Gives a key of a thing a value.",
           {one_key(), key_key(), scene::needed(keys::any("value", "as the file would say it"))}},
          [](const JsonObject& o, Draft& draft) {
            const auto [file, path] = place_of(o, draft);
            draft.set(file, path, o.value().find("value")->value);
          }};
}

Operation unset() {
  return {{"unset", "Takes a key of a thing away: its default holds again.", {one_key(), key_key()}},
          [](const JsonObject& o, Draft& draft) {
            const auto [file, path] = place_of(o, draft);
            draft.remove(file, path);
          }};
}

}  // namespace

std::vector<Operation> key_operations() { return {set(), unset()}; }

}  // namespace trocar::modeller
