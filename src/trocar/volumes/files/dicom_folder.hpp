// The DICOM files of a folder and of the folders below it. Used by the readers only.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/volumes/files/dicom_header.hpp>
#include <trocar/volumes/image/progress.hpp>

namespace trocar::volumes {

/// A file that gives no slices, or a folder that was not searched.
struct LeftOut {
  std::string path, why, series_uid, instance;  ///< why: as a message
  bool broken = false;                          ///< whole, it may have been a slice of its series
  bool dicom = true;
  bool is_directory = false;  ///< the list of a disc's files
};
struct DicomFolder {
  std::vector<DicomHeader> files;  ///< with slices, by their paths
  std::vector<LeftOut> left_out;
};

/// @throws core::BadInput  for a folder that cannot be read, or has too many files
DicomFolder read_dicom_folder(const std::filesystem::path& folder, const Progress& progress);

/// All of a file.
struct OpenedDicom {
  std::string bytes;
  DicomDocument file;  ///< its elements lie in `bytes`
};
/// @throws core::BadInput
void open_dicom(const std::filesystem::path& path, OpenedDicom& out);

/// Which files were left out and why, files of one reason together.
std::vector<std::string> notes_on(const std::vector<LeftOut>& left_out);

/// "a.dcm, b.dcm and 3 more"
std::string few_of(const std::vector<std::string>& names);

}  // namespace trocar::volumes
