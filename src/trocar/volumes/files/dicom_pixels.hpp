// The pixels of a DICOM file, unpacked. Used by the readers only.
#pragma once

#include <vector>

#include <trocar/volumes/files/dicom_header.hpp>

namespace trocar::volumes {

/// Frame after frame, in the machine's order of bytes, bits that are not stored cleared or filled with the sign.
/// @param notes  what was corrected is added
/// @throws core::BadInput  for a file that ends early, is damaged, or packed in a way that is not unpacked here
/// @throws core::EnvironmentLacks  for JPEG in a build without GDCM
std::vector<char> dicom_pixels(const DicomDocument& file, const DicomHeader& header, std::size_t most_voxels,
                               std::vector<std::string>& notes);

struct UnpackedFrames {
  std::vector<char> bytes;
  int stored = 0;  ///< bits that the frames hold: in JPEG 2000 they may be fewer than the header says
};
/// Frames of JPEG, JPEG-LS or JPEG 2000, one after the other.
UnpackedFrames unpacked_jpeg(const std::vector<std::string>& frames, DicomPacking packing, const std::string& syntax,
                             const DicomHeader& header);

inline std::size_t frame_pixels(const DicomHeader& header) {
  return std::size_t(header.rows) * std::size_t(header.columns);
}
inline std::size_t frame_bytes(const DicomHeader& header) {
  return frame_pixels(header) * std::size_t(header.allocated / 8);
}

}  // namespace trocar::volumes
