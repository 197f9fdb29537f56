// What a DICOM file says of its pixels: size, place, meaning. Used by the readers only.
#pragma once

#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_elements.hpp>
#include <trocar/volumes/files/raster.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

namespace trocar::volumes {

struct DicomHeader {
  std::string path;
  std::string uid, description, modality, photometric;
  int columns = 0, rows = 0, frames = 1;
  int allocated = 0, stored = 0;  ///< bits
  bool is_signed = false;
  Vec3d row{1, 0, 0}, column{0, 1, 0};
  double between_columns = 0, between_rows = 0;  ///< of pixels [mm]; 0: not said
  double tilt_deg = 0;                           ///< of the gantry
  std::vector<SlicePlace> places;                ///< of the frames; empty: not said
  std::vector<Rescale> rescale;                  ///< of the frames
  std::string fault;                             ///< why its pixels cannot be used, or empty

  Element element() const;
};

/// @throws core::BadInput  for numbers that are none
DicomHeader dicom_header(const DicomDocument& file, const std::string& path);
/// Do both belong to the same stack of slices?
bool same_stack(const DicomHeader& a, const DicomHeader& b);

}  // namespace trocar::volumes
