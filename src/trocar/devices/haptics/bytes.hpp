// Numbers in datagrams: little-endian, whatever the machine has.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace trocar::devices {

inline void put_u32(std::uint8_t* to, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) to[i] = std::uint8_t(value >> (8 * i));
}
inline std::uint32_t get_u32(const std::uint8_t* from) {
  std::uint32_t value = 0;
  for (int i = 0; i < 4; ++i) value |= std::uint32_t(from[i]) << (8 * i);
  return value;
}
inline void put_f64(std::uint8_t* to, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int i = 0; i < 8; ++i) to[i] = std::uint8_t(bits >> (8 * i));
}
inline double get_f64(const std::uint8_t* from) {
  std::uint64_t bits = 0;
  for (int i = 0; i < 8; ++i) bits |= std::uint64_t(from[i]) << (8 * i);
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace trocar::devices
