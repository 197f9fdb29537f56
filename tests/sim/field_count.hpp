// How many fields an aggregate has, by the number of values that it can be initialised with: what a list of fields
// (core/fields.hpp) is measured by. An array of C counts as its elements, as in a list; a base as one.
#pragma once

#include <cstddef>
#include <utility>

namespace trocar::field_count {

/// Becomes whatever is asked for. Never made.
struct Anything {
  template <class T>
  constexpr operator T() const;
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...> /*count*/) {
  return requires { T{(void(I), Anything{})...}; };
}

template <class T, std::size_t N = 0>
constexpr std::size_t of() {
  if constexpr (takes<T>(std::make_index_sequence<N + 1>{}))
    return of<T, N + 1>();
  else
    return N;
}

}  // namespace trocar::field_count
