// Several images at the same positions, told apart by what DICOM says of them: each group has one image at most at a
// position. Used by the readers only.
//
//   const ImageGroups phases = grouped(levels, marks);
//   if (phases.groups.empty()) ...                     // nothing tells them apart
//   else if (phases.alike) ...                         // time points: every group has all positions
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_marks.hpp>

namespace trocar::volumes {

struct ImageGroup {
  std::string name;         ///< "Acquisition Number 2"
  std::vector<int> images;  ///< indices
};
struct ImageGroups {
  std::vector<ImageGroup> groups;  ///< the earliest first; none: nothing tells the images apart
  bool alike = true;               ///< every group has an image at every position
  std::string told_by;             ///< "Acquisition Number"
};

/// @param levels  the images at each position (slice_stack.hpp), at one of them two or more
/// @param marks   of each image
ImageGroups grouped(const std::vector<std::vector<int>>& levels, std::span<const Marks> marks);

/// Images of several acquisitions or kinds, each evenly spaced and of about the same extent, that lie between each
/// other. None: they are slices of one, or acquisitions that follow each other along the normal.
/// @param along  the position of each image along the normal, no two the same [mm]
ImageGroups interleaved(std::span<const double> along, std::span<const Marks> marks);

}  // namespace trocar::volumes
