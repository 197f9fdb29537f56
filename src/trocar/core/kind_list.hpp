// A list of kinds, known when the program is compiled: each kind is a class with types and static functions, and what
// belongs to all of them is a tuple with a member a kind.
//
//   using Kinds = core::KindList<Ring, Needle>;
//   Kinds::for_each([&](auto kind) { using K = decltype(kind); K::advance(std::get<typename K::States>(states)); });
#pragma once

namespace trocar::core {

template <class... Kinds>
struct KindList {
  template <class F>
  static void for_each(F&& f) {
    (f(Kinds{}), ...);
  }
  /// List<Of<Kind>...>
  template <template <class...> class List, template <class> class Of>
  using Map = List<Of<Kinds>...>;
};

}  // namespace trocar::core
