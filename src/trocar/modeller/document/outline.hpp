// The things of a document that have names, and where their texts stand: what a list in a window shows, what an
// operation is about. Made from the texts alone, so that it is there whatever else is wrong with them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <trocar/modeller/document/document.hpp>

namespace trocar::modeller {

struct Thing {
  std::string kind;  ///< "solid", "strand", "wall", "sheet", "membrane", "pouch", "vessel", "port", "mark", ...
  std::string name;
  fs::path file;
  std::string path;  ///< JSON pointer to its object
  int line = 0;
};

/// Kinds of things, and the key of the list in which each stands.
struct KindOfThing {
  const char *kind, *list;
  bool in_organs;  ///< bodies, which organ files hold; else what scenes and vessel files hold
};
const std::vector<KindOfThing>& kinds_of_things();

/// In the order of the files, and within each as they stand there.
std::vector<Thing> outline(const Document& document);

/// The thing of that name: "uterus", or with its kind where two kinds share it, "port:umbilical".
/// @throws core::BadInput with what there is
Thing thing_named(const Document& document, std::string_view name);

/// What its text says now.
scene::JsonValue value_of(const Document& document, const Thing& thing);

}  // namespace trocar::modeller
