// The pixels of a DICOM file, decoded; what GDCM only warns of is a fault. Used by the readers only.
#pragma once

#include <istream>
#include <memory>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_header.hpp>

namespace trocar::volumes {

/// GDCM writes warnings to streams that the whole program shares: one at a time holds them, and reads what was written.
class GdcmWarnings {
 public:
  GdcmWarnings();
  ~GdcmWarnings();
  GdcmWarnings(const GdcmWarnings&) = delete;
  GdcmWarnings& operator=(const GdcmWarnings&) = delete;
  std::string taken();  ///< what was written since, in one short line; empty where nothing was

 private:
  struct Held;
  std::unique_ptr<Held> m_held;
};

/// Only the header. A header whose `fault` is not empty is that of a DICOM file without usable pixels.
/// @return false where this is no DICOM file
bool read_dicom_header(std::istream& in, const std::string& path, GdcmWarnings& warnings, DicomHeader& out);

struct DicomPixels {
  Element element = Element::int16;
  std::vector<char> bytes;  ///< frame after frame, in the machine's order of bytes
};
/// @throws core::BadInput  for a file that ends early, is damaged, or of a syntax that GDCM cannot decode
DicomPixels read_dicom_pixels(std::istream& in, const DicomHeader& header, GdcmWarnings& warnings,
                              std::size_t most_voxels);

}  // namespace trocar::volumes
