#include <trocar/geometry/voxel_files/numbers.hpp>

namespace trocar::geometry {

std::size_t width_of(NumberType type) {
  constexpr std::size_t kWidths[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
  return kWidths[std::size_t(type)];
}
const char* name_of(NumberType type) {
  constexpr const char* kNames[] = {"int8",   "uint8", "int16",  "uint16", "int32",
                                    "uint32", "int64", "uint64", "float",  "double"};
  return kNames[std::size_t(type)];
}

}  // namespace trocar::geometry
