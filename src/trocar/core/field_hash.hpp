// The hash of a struct by the list of its fields (fields.hpp).
//
//   void add_to_hash(core::Hasher& h, const DropState& s) noexcept { core::add_fields(h, s); }
//
// A type that is not hashed field by field says `static constexpr bool kOwnHash = true` and has an add_to_hash() of its
// own beside it; where others hold it, that one is called.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>

namespace trocar::core {

template <class T>
concept OwnHash = requires {
  requires T::kOwnHash;
};

template <class T>
void add_fields(Hasher& hasher, const T& value) noexcept;

/// Visits a list and adds what is hashed.
class FieldHasher {
 public:
  explicit FieldHasher(Hasher& hasher) noexcept : m_hasher(hasher) {}

  template <class F>
  void operator()(const char* /*name*/, const F& field, const FieldNote& note = {}) noexcept {
    if (!note.hashed) return;
    if (note.with_next || m_size > 0)
      collect(field, note.with_next);
    else
      add(field, note);
  }
  template <class F>
  void operator()(const char* /*name*/, const F& /*field*/, NotHashed /*note*/) noexcept {}
  template <class F>
  void operator()(const char* /*name*/, const F& field, PartOfField note) noexcept {
    if (note.hashed) add(field, {});
  }

 private:
  template <class F>
  void collect(const F& field, bool more) noexcept {
    if constexpr (std::is_arithmetic_v<F>) {
      static_assert(sizeof field <= 8);
      std::memcpy(m_bytes + m_size, &field, sizeof field);
      m_size += sizeof field;
      if (more) return;
      m_hasher.add_bytes(m_bytes, m_size);
      m_size = 0;
    }
  }

  template <class F>
  void add(const F& field, const FieldNote& /*note*/) noexcept {
    if constexpr (std::is_same_v<F, bool>)
      m_hasher.add(std::int32_t(field));
    else if constexpr (OwnHash<F>)
      add_to_hash(m_hasher, field);
    else if constexpr (Bytes<F>)
      m_hasher.add(field);
    else
      add_fields(m_hasher, field);
  }
  template <class E, std::size_t N>
  void add(const E (&field)[N], const FieldNote& note) noexcept {
    if constexpr (Bytes<E>)
      if (!note.each) return m_hasher.add(field);
    add_each(field, note.first < 0 ? N : std::size_t(note.first));
  }
  template <class E, std::size_t N>
  void add(const std::array<E, N>& field, const FieldNote& note) noexcept {
    if constexpr (Bytes<E>)
      if (!note.each) return m_hasher.add(field);
    add_each(field.data(), note.first < 0 ? N : std::size_t(note.first));
  }
  template <class E>
  void add(const std::vector<E>& field, const FieldNote& note) noexcept {
    const std::size_t count = note.first < 0 ? field.size() : std::size_t(note.first);
    if (note.sized) m_hasher.add(std::int32_t(count));
    if constexpr (Bytes<E>) {
      if (note.first >= 0) return m_hasher.add(hash_bytes(field.data(), count * sizeof(E)));
      if (!note.each) return m_hasher.add(field);
    }
    add_each(field.data(), count);
  }
  template <class E>
  void add_each(const E* items, std::size_t count) noexcept {
    for (std::size_t i = 0; i < count; ++i) add(items[i], {});
  }

  Hasher& m_hasher;
  unsigned char m_bytes[64] = {};
  std::size_t m_size = 0;
};

template <class T>
void add_fields(Hasher& hasher, const T& value) noexcept {
  T::fields(value, FieldHasher(hasher));
}

}  // namespace trocar::core
