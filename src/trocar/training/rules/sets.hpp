// Sets: what an exercise does several times over (two sides, ten targets, the bodies that bear little). A step or an
// error that is there `for_each` of a set is made once an element.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/scene/json/json.hpp>
#include <trocar/sim/model/model.hpp>

namespace trocar::training {

inline constexpr int kMaxElements = 64;            ///< of a set; more are a fault
inline constexpr std::size_t kLongestTitle = 200;  ///< of an element, and its name [bytes]

struct Element {
  std::string name, title;   ///< "left", "Left"; a title is the name where the file gives none
  scene::JsonValue self;     ///< the name as a value, where it stands in the file
  scene::JsonValue members;  ///< the element's object; null for elements that are only names
  const scene::JsonValue* member(std::string_view key) const;
};

struct Set {
  std::string name;  ///< also what "$name" stands for within `for_each`
  std::string file;
  scene::JsonValue at;  ///< its declaration
  std::vector<Element> elements;
  std::vector<std::string> held;  ///< members that name bodies: who holds one of them works on the element
  bool pending = false;           ///< elements come from a scene that is not there yet
};
using Sets = std::vector<Set>;

/// Null: there is none of that name.
const Set* find_set(const Sets& sets, std::string_view name);

/// "niche_*": `*` stands for any letters. Takes no longer than the product of both lengths.
bool matches(std::string_view pattern, std::string_view name);

/// Reads one set: a list of names or of elements, an object with `elements`, or a pattern over the scene's marks,
/// bodies or hands. An element with `if_body` is there only where the scene has that body. @param model  null: patterns
/// stay pending  @param seed  draws the order of "by_seed"
Set read_set(const std::string& name, const scene::JsonValue& value, const std::string& file, const sim::Model* model,
             std::uint64_t seed, std::vector<core::Fault>& faults);

}  // namespace trocar::training
