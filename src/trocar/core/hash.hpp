// 64-bit content hashes (XXH3, Debian's libxxhash): of a State at a tick, of a Model, of a block of a recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace trocar::core {

std::uint64_t hash_bytes(const void* data, std::size_t size, std::uint64_t seed = 0) noexcept;

/// 16 hex digits.
std::string hex(std::uint64_t hash);

/// Accumulates a hash over values and arrays, in call order. Types must have no padding bytes.
class Hasher {
 public:
  template <class T>
  void add(const T& value) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    m_hash = hash_bytes(&value, sizeof value, m_hash);
  }
  template <class T>
  void add(const std::vector<T>& values) noexcept {
    static_assert(std::is_trivially_copyable_v<T>);
    add(static_cast<std::uint64_t>(values.size()));
    m_hash = hash_bytes(values.data(), values.size() * sizeof(T), m_hash);
  }
  void add_bytes(const void* data, std::size_t size) noexcept { m_hash = hash_bytes(data, size, m_hash); }
  std::uint64_t value() const noexcept { return m_hash; }

 private:
  std::uint64_t m_hash = 0;
};

}  // namespace trocar::core
