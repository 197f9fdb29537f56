// Spoils a struct by the list of its fields (fields.hpp): every number becomes NaN, -1 or the largest there is, every
// view empty. What was made once from the Model stays. For tests of the law that scratch may be lost between ticks.
#pragma once

#include <array>
#include <cstring>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar::core {

template <class T>
void poison_fields(T& value) noexcept;

struct Poisoner {
  template <class F, class N = FieldNote>
  void operator()(const char* /*name*/, F& field, N note = {}) noexcept {
    if constexpr (!std::is_same_v<N, PartOfField>)
      if (!note.made_once) spoil(field);
  }

  static void spoil(bool& flag) noexcept { flag = true; }
  template <class E>
  static void spoil(E*& pointer) noexcept {
    pointer = nullptr;
  }
  template <class E>
  static void spoil(std::span<E>& view) noexcept {
    view = {};
  }
  template <class E, std::size_t N>
  static void spoil(E (&items)[N]) noexcept {
    spoil_all(items, N);
  }
  template <class E, std::size_t N>
  static void spoil(std::array<E, N>& items) noexcept {
    spoil_all(items.data(), N);
  }
  template <class E>
  static void spoil(std::vector<E>& items) noexcept {
    spoil_all(items.data(), items.size());
  }
  template <class F>
  static void spoil(F& field) noexcept {
    if constexpr (Bytes<F>)
      spoil_all(&field, 1);
    else
      poison_fields(field);
  }

 private:
  template <class E>
  static void spoil_all(E* items, std::size_t count) noexcept {
    if constexpr (Bytes<E> && !std::is_pointer_v<E>) {
      if (count > 0) std::memset(static_cast<void*>(items), 0xff, count * sizeof(E));
    } else {
      for (std::size_t i = 0; i < count; ++i) spoil(items[i]);
    }
  }
};

template <class T>
void poison_fields(T& value) noexcept {
  T::fields(value, Poisoner{});
}

}  // namespace trocar::core
