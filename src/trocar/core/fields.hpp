// A struct's fields, named once: in a list that stands in the struct and serves all that has to treat every field. The
// hash of a State and a Model is made from it (field_hash.hpp), a step's scratch is spoilt by it (poison.hpp), what
// memory a State takes is added up by it (memory.hpp), and it says which field of two States differs first
// (field_difference.hpp).
//
//   struct DropState {
//     std::int32_t count = 0;
//     std::vector<float> x;            // (capacity)
//     std::vector<float> x_drawn;      // follows from the others
//
//     template <class S, class V>
//     static void fields(S& s, V&& v) {
//       v("count", s.count), v("x", s.x, core::first(s.count)), v("x_drawn", s.x_drawn, core::kNotHashed);
//     }
//   };
//
// The order of a list is that of the hash; it changes no bit to add a field that is not hashed. Lists make the same
// calls for every value: what a value decides goes into a field's note. tests/sim/fields_test.cpp refuses a struct of a
// State or a Model that has no list, and a list from which a field is missing. In scratch a struct of plain numbers is
// its bytes and needs none.
#pragma once

#include <cstddef>
#include <type_traits>

namespace trocar::core {

/// What a list says of a field beside its name.
struct FieldNote {
  bool hashed = true;         ///< in this value; others of the type may say otherwise
  std::ptrdiff_t first = -1;  ///< of an array with room: so many are in use, the others are not State; -1: all
  bool with_next = false;     ///< hashed in one piece with the next field
  bool each = false;          ///< hashed item by item though they have no padding
  bool sized = false;         ///< items that are hashed each: their number first
  bool loose = false;         ///< parts of it may differ that are not in use
  bool made_once = false;     ///< in scratch: made with it from the Model, and not by a tick
};

/// Never hashed: a name, a look, or what follows from others.
struct NotHashed {
  bool made_once = false;
};
/// A part of a field that the list names as well: only the hash has it from here.
struct PartOfField {
  bool hashed = true;
};

inline constexpr NotHashed kNotHashed{}, kMadeOnce{.made_once = true};
inline constexpr PartOfField kPartOfField{};
inline constexpr FieldNote kWithNext{.with_next = true}, kEach{.each = true}, kLoose{.loose = true};

constexpr FieldNote only_if(bool hashed) noexcept { return {.hashed = hashed}; }
constexpr FieldNote first(std::ptrdiff_t count) noexcept { return {.first = count}; }

/// Visits nothing.
struct NoVisitor {
  template <class F, class N = FieldNote>
  void operator()(const char* /*name*/, F& /*field*/, N /*note*/ = {}) const noexcept {}
};

/// Has a list of its fields.
template <class T>
concept Listed = requires(T& value, NoVisitor v) {
  T::fields(value, v);
};

/// Has a list, no padding, and is hashed and compared as its bytes: `static constexpr bool kAsBytes = true`.
template <class T>
concept ListedBytes = Listed<T> && requires {
  requires T::kAsBytes;
};

/// Its bytes are all there is of it.
template <class T>
concept Bytes = ListedBytes<T> ||(!Listed<T> && std::is_trivially_copyable_v<T>);

}  // namespace trocar::core
