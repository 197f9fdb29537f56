// What a DICOM object is, where it is no stack of slices. Used by the readers only.
#pragma once

#include <string>
#include <string_view>

namespace trocar::volumes {

/// What a file says that it is.
struct DicomObject {
  std::string sop_class, modality, image_type;
  bool has_places = false;  ///< its frames say where they are in the patient
};

/// "an RT dose grid (RTDOSE): open the CT or MR series instead"; empty: slices, as far as this says.
/// Source: the classes of DICOM PS3.4, annex B (2023b).
std::string other_than_slices(const DicomObject& object);

/// The list of a disc's files (DICOMDIR).
bool is_dicom_directory(std::string_view sop_class);

}  // namespace trocar::volumes
