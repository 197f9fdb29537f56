// The checksums of the box's frames. Both are the reflected forms, which take each byte's low bit first, as a serial
// line sends it: a burst of errors on the line is then a burst of the polynomial, so that the 16-bit one finds every
// burst of up to 16 bits and the 8-bit one every burst of up to 8.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace trocar::devices {

namespace crc_detail {
template <class T>
constexpr std::array<T, 256> table(T reflected_polynomial) noexcept {
  std::array<T, 256> entries{};
  for (unsigned i = 0; i < 256; ++i) {
    T value = T(i);
    for (int bit = 0; bit < 8; ++bit) value = T((value & 1) != 0 ? (value >> 1) ^ reflected_polynomial : value >> 1);
    entries[i] = value;
  }
  return entries;
}
inline constexpr auto kCrc16Table = table<std::uint16_t>(0x8408);
inline constexpr auto kCrc8Table = table<std::uint8_t>(0xe0);
}  // namespace crc_detail

/// CRC-16 of the CCITT's polynomial x^16 + x^12 + x^5 + 1, as HDLC has it: begins with ones, is inverted at the
/// end, and is sent low byte first. crc16("123456789") == 0x906e.
constexpr std::uint16_t box_crc16(std::span<const std::uint8_t> bytes) noexcept {
  std::uint16_t crc = 0xffff;
  for (const std::uint8_t byte : bytes) crc = std::uint16_t(crc >> 8 ^ crc_detail::kCrc16Table[(crc ^ byte) & 0xff]);
  return std::uint16_t(~crc);
}

/// CRC-8 of x^8 + x^2 + x + 1, begins with ones (ROHC). crc8("123456789") == 0xd0.
constexpr std::uint8_t box_crc8(std::span<const std::uint8_t> bytes) noexcept {
  std::uint8_t crc = 0xff;
  for (const std::uint8_t byte : bytes) crc = crc_detail::kCrc8Table[crc ^ byte];
  return crc;
}

}  // namespace trocar::devices
