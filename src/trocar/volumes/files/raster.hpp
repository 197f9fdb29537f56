// Voxels as a file has them: untyped bytes and what they mean. Every reader ends here, and one function makes a Volume
// or Labels of it. Used by the readers only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/voxel_files/grid_faults.hpp>
#include <trocar/geometry/voxel_files/header_fields.hpp>
#include <trocar/geometry/voxel_files/numbers.hpp>
#include <trocar/volumes/files/volume_file.hpp>

namespace trocar::volumes {

using Element = geometry::NumberType;
using geometry::name_of, geometry::place_fault, geometry::refuse, geometry::shown, geometry::size_fault,
    geometry::width_of;

/// value = intercept + slope * number
struct Rescale {
  double slope = 1, intercept = 0;
  double padding_from = 1, padding_to = 0;  ///< numbers that are no voxels of the patient; none where from > to

  bool has_padding() const { return padding_from <= padding_to; }
  bool operator==(const Rescale&) const = default;
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

/// Numbers that are none become the least value, which the notes tell.
Volume packed_volume(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress);
Labels packed_labels(const Raster& raster, const std::string& file, std::vector<std::string>& notes,
                     const Progress& progress);

}  // namespace trocar::volumes
