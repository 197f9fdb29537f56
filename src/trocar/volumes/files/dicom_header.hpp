// What a DICOM file says of its pixels: size, place, meaning. Used by the readers only.
#pragma once

#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_elements.hpp>
#include <trocar/volumes/files/dicom_marks.hpp>
#include <trocar/volumes/files/raster.hpp>

namespace trocar::volumes {

/// One image of a file.
struct DicomFrame {
  Vec3d position;                                ///< of the first pixel's centre [mm, L P S]
  Vec3d row, column;                             ///< directions along and across the rows of pixels
  double between_columns = 0, between_rows = 0;  ///< of pixels [mm]
  double thickness = 0;                          ///< [mm]; 0: not said
  Rescale rescale;
  bool rescaled = false;     ///< Rescale Slope and Rescale Intercept are both there
  std::string rescale_type;  ///< what values are after it, as the file says: "HU"
  Marks marks;
};

struct DicomHeader {
  std::string path;
  std::string uid, instance;                       ///< of the series and of this object; empty: taken out
  std::string patient, study, frame_of_reference;  ///< their identifiers
  std::string sop_class, description, modality, photometric;
  int columns = 0, rows = 0;
  int allocated = 0, stored = 0;  ///< bits
  bool is_signed = false;
  double tilt_deg = 0;                 ///< of the gantry
  std::vector<DicomFrame> frames;      ///< at least one where there is no fault
  std::string fault;                   ///< why its pixels cannot be used, or empty
  bool broken = false;                 ///< the fault is damage: whole, it may have been a slice
  std::vector<std::string> corrected;  ///< what was wrong and does no harm, or was guessed

  Element element() const;
};

/// Damage of the file and numbers that are none are its fault.
DicomHeader dicom_header(const DicomDocument& file, const std::string& path);
/// Do both frames belong to the same stack of slices?
bool same_stack(const DicomHeader& a, const DicomFrame& in_a, const DicomHeader& b, const DicomFrame& in_b);
/// Are they of the same patient, study and frame of reference?
bool same_origin(const DicomHeader& a, const DicomHeader& b);

}  // namespace trocar::volumes
