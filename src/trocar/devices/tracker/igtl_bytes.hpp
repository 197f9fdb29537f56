// Numbers and texts of OpenIGTLink: big-endian, texts in fields of fixed size.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace trocar::devices {

using IgtlBytes = std::span<const std::uint8_t>;

/// Of at most eight bytes.
inline std::uint64_t big_endian(IgtlBytes bytes) noexcept {
  std::uint64_t value = 0;
  for (const std::uint8_t b : bytes) value = value << 8 | b;
  return value;
}

inline float float_at(IgtlBytes bytes, std::size_t at) noexcept {
  const std::uint32_t bits = std::uint32_t(big_endian(bytes.subspan(at, 4)));
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

inline double double_at(IgtlBytes bytes, std::size_t at) noexcept {
  const std::uint64_t bits = big_endian(bytes.subspan(at, 8));
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Up to the first zero; what cannot be printed becomes '?'.
inline std::string igtl_text(IgtlBytes bytes) {
  std::string text;
  for (const std::uint8_t b : bytes) {
    if (b == 0) break;
    text += b >= 32 && b < 127 ? char(b) : '?';
  }
  return text;
}

}  // namespace trocar::devices
