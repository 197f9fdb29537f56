// Numbers and texts as bytes, the same on every machine: lowest byte first. A varint carries 7 bits a byte, lowest
// first, and a set top bit means that more follow.
//
//   ByteString bytes;
//   put(bytes, std::uint32_t(7)), put_varint(bytes, 300), put_text(bytes, "tube");
//   ByteReader from(bytes);                        // reading beyond the end gives 0 and clears sound()
//   from.get<std::uint32_t>(), from.varint(), from.text();
//   if (!from.sound() || !from.at_end()) ...
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace trocar::core {

using ByteString = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

template <class Unsigned>
void put(ByteString& to, Unsigned value) {
  for (std::size_t i = 0; i < sizeof value; ++i) to.push_back(std::uint8_t(value >> (8 * i)));
}

inline void put_varint(ByteString& to, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) to.push_back(std::uint8_t(value | 0x80));
  to.push_back(std::uint8_t(value));
}

inline void put_text(ByteString& to, const std::string& text) {
  put(to, std::uint32_t(text.size()));
  to.insert(to.end(), text.begin(), text.end());
}

class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : m_bytes(bytes) {}
  bool sound() const { return m_sound; }
  bool at_end() const { return m_at == m_bytes.size(); }
  ByteView rest() const { return m_bytes.subspan(m_at); }  ///< not read yet

  template <class Unsigned>
  Unsigned get() {
    if (m_bytes.size() - m_at < sizeof(Unsigned)) return fault();
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof value; ++i) value = Unsigned(value | Unsigned(m_bytes[m_at++]) << (8 * i));
    return value;
  }

  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 64; shift += 7) {
      if (at_end()) return fault();
      const std::uint8_t byte = m_bytes[m_at++];
      value |= std::uint64_t(byte & 0x7f) << shift;
      if (byte < 0x80) return value;
    }
    return fault();
  }

  std::string text() {
    const std::size_t size = get<std::uint32_t>();
    if (m_bytes.size() - m_at < size) return fault(), std::string();
    const auto first = m_bytes.begin() + std::ptrdiff_t(m_at);
    m_at += size;
    return {first, first + std::ptrdiff_t(size)};
  }

 private:
  std::uint8_t fault() {
    m_sound = false;
    m_at = m_bytes.size();
    return 0;
  }

  ByteView m_bytes;
  std::size_t m_at = 0;
  bool m_sound = true;
};

}  // namespace trocar::core
