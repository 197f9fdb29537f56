// The numbers of voxels as files have them: their types, and their values one after the other. Used by the readers
// only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace trocar::geometry {

enum class NumberType : unsigned char { int8, uint8, int16, uint16, int32, uint32, int64, uint64, real32, real64 };
std::size_t width_of(NumberType type);
const char* name_of(NumberType type);
inline bool is_whole(NumberType type) { return type < NumberType::real32; }

/// Does this machine put the highest byte of a number first?
constexpr bool machine_is_big() { return __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__; }

template <class T>
T number_at(const char* from, bool swapped) {
  char own[sizeof(T)];
  std::memcpy(own, from, sizeof(T));
  if (swapped) std::reverse(own, own + sizeof(T));
  T value;
  std::memcpy(&value, own, sizeof(T));
  return value;
}

/// The number at a place of a file that has this order of bytes.
template <class T>
T number_at_in(bool big_endian, const char* from) {
  return number_at<T>(from, big_endian != machine_is_big());
}

/// Calls f with a value of the C++ type, which is 0.
template <class F>
void with_type(NumberType type, F&& f) {
  switch (type) {
    case NumberType::int8:
      return f(std::int8_t());
    case NumberType::uint8:
      return f(std::uint8_t());
    case NumberType::int16:
      return f(std::int16_t());
    case NumberType::uint16:
      return f(std::uint16_t());
    case NumberType::int32:
      return f(std::int32_t());
    case NumberType::uint32:
      return f(std::uint32_t());
    case NumberType::int64:
      return f(std::int64_t());
    case NumberType::uint64:
      return f(std::uint64_t());
    case NumberType::real32:
      return f(float());
    case NumberType::real64:
      return f(double());
  }
}

}  // namespace trocar::geometry
