// Scans and label maps as files that other programs read: NRRD and NIfTI, packed with gzip or not.
//
//   write_volume("out.nii.gz", volume);
//   write_labels("organs.seg.nrrd", labels);       // with names and colours, as 3D Slicer has them
//
// What is written reads back with the same grid (NIfTI keeps places in single precision) and the same values; labels
// always with the same numbers. NIfTI keeps slope and intercept; NRRD has none, so that values which are no whole
// numbers become float there.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/volumes/image/labels.hpp>
#include <trocar/volumes/image/volume.hpp>

namespace trocar::volumes {

std::string to_nrrd(const Volume& volume, bool packed = true);
/// @param packed  gzip within NRRD
std::string to_nrrd(const Labels& labels, bool packed = true);
/// The plain bytes; pack them for .nii.gz.
std::string to_nifti(const Volume& volume);
std::string to_nifti(const Labels& labels);

/// By the name's end: .nii, .nii.gz, .nrrd. Written beside, flushed and put in place as a whole: on a full disk the old
/// file stays.
/// @throws core::BadInput  for another end, and where the file cannot be written
void write_volume(const std::filesystem::path& path, const Volume& volume);
void write_labels(const std::filesystem::path& path, const Labels& labels);

}  // namespace trocar::volumes
