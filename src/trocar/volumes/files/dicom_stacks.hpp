// Images of DICOM files as stacks of slices: those of one series, size and direction; copies left out, several images
// at one position told apart. Used by the readers only.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <trocar/volumes/files/dicom_header.hpp>
#include <trocar/volumes/files/image_groups.hpp>
#include <trocar/volumes/files/volume_file.hpp>

namespace trocar::volumes {

struct ImageAt {
  int file = 0, frame = 0;
};

struct DicomStack {
  std::vector<ImageAt> images;
  std::vector<ImageGroup> groups;           ///< time points: of each the indices of its images; one at least
  std::string told_by;                      ///< what tells the groups apart, where there are several
  std::string part;                         ///< of a series that was parted: "Acquisition Number 2"
  std::string origin;                       ///< whose it is, where a series has several: "Patient ID 7"
  bool between = false;                     ///< its slices lie between those of the other parts
  int series = 0;                           ///< stacks that were parted from each other have the same
  std::vector<std::pair<int, int>> copies;  ///< files left out, and those that they are copies of
  std::string fault;                        ///< why it is no volume, or empty

  std::size_t slices() const { return groups[0].images.size(); }
};

/// Something that two images have in common where they have the same pixels, and otherwise not. Empty: they are
/// damaged.
using PixelsDigest = std::function<std::string(ImageAt)>;

/// Most slices first, then by the series' names.
/// @throws core::BadInput  for too many stacks
std::vector<DicomStack> dicom_stacks(const std::vector<DicomHeader>& files, const PixelsDigest& pixels,
                                     const std::string& name);

/// Has the stack an image of this file, or a copy that was left out?
bool holds(const DicomStack& stack, int file);

SeriesFacts facts_of(const DicomStack& stack, const std::vector<DicomHeader>& files);

}  // namespace trocar::volumes
