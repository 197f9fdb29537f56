// The memory that a struct's arrays take, by the list of its fields (fields.hpp), beside sizeof the struct.
#pragma once

#include <array>
#include <vector>

#include <trocar/core/fields.hpp>

namespace trocar::core {

class MemoryCounter {
 public:
  template <class F, class N = FieldNote>
  void operator()(const char* /*name*/, const F& field, N /*note*/ = {}) {
    if constexpr (!std::is_same_v<N, PartOfField>) count(field);
  }
  std::size_t bytes() const { return m_bytes; }

 private:
  template <class E>
  void count(const std::vector<E>& items) {
    m_bytes += items.capacity() * sizeof(E);
    if constexpr (!Bytes<E>)
      for (const E& item : items) count(item);
  }
  template <class E, std::size_t N>
  void count(const std::array<E, N>& items) {
    if constexpr (!Bytes<E>)
      for (const E& item : items) count(item);
  }
  template <class F>
  void count(const F& field) {
    if constexpr (Listed<F> && !Bytes<F>) F::fields(field, *this);
  }

  std::size_t m_bytes = 0;
};

/// [bytes]
template <class T>
std::size_t memory_of(const T& value) {
  MemoryCounter counter;
  T::fields(value, counter);
  return sizeof value + counter.bytes();
}

}  // namespace trocar::core
