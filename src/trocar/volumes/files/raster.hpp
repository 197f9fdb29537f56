// Voxels as a file has them: untyped bytes and what they mean. Every reader ends here, and one function makes a Volume
// or Labels of it. Used by the readers only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/volumes/files/volume_file.hpp>

namespace trocar::volumes {

enum class Element : unsigned char { int8, uint8, int16, uint16, int32, uint32, int64, uint64, real32, real64 };
std::size_t width_of(Element element);
const char* name_of(Element element);

/// value = intercept + slope * number
struct Rescale {
  double slope = 1, intercept = 0;
};

struct Raster {
  Grid grid;
  Element element = Element::int16;
  bool big_endian = false;
  std::size_t stride = 1;        ///< elements from a voxel to the next: the layers of a file that has them side by side
  std::vector<Rescale> rescale;  ///< none, one for all, or one a slice
  std::string unit;
  std::vector<Segment> segments;
  std::vector<char> owned;  ///< unpacked, or from another file
  std::string_view bytes;   ///< where nothing is owned: in the file

  const char* data() const { return owned.empty() ? bytes.data() : owned.data(); }
  std::size_t size() const { return owned.empty() ? bytes.size() : owned.size(); }
  /// Bytes from the first element of the first voxel to the last one's end.
  std::size_t wanted() const { return ((grid.count() - 1) * stride + 1) * width_of(element); }
};

/// Throws core::BadInput for a file as a whole: `file:0:0: message`.
[[noreturn]] void refuse(const std::string& file, std::string message);

/// What is wrong with a grid, or nothing: sizes, places up to 1e6 mm, steps from 1e-4 to 1e4 mm that span a voxel.
/// @param announced  sizes as the file has them, which may be beyond int
std::optional<std::string> size_fault(const std::array<std::int64_t, 3>& announced, std::size_t most_voxels);
std::optional<std::string> place_fault(Vec3d origin, const Mat3d& step);

/// Numbers that are none become the least value, which the notes tell.
Volume packed_volume(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress);
Labels packed_labels(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress);

}  // namespace trocar::volumes
