// What a scan of a patient holds, where it lies, and which series there are: for `trocar check`.
#pragma once

#include <filesystem>

#include <trocar/core/json.hpp>
#include <trocar/volumes/files/volume_file.hpp>

namespace trocar::app {

/// A folder, a DICOM file of any name, or a file whose ending is that of NIfTI, NRRD, MetaImage or Analyze.
bool is_scan_file(const std::filesystem::path& path);

/// @throws core::BadInput with all faults of the file, or where somebody must choose a series
Json describe_scan(const std::filesystem::path& path, volumes::ReadOptions options);

/// describe_scan()'s facts in words, a paragraph of lines that are set in.
void print_scan(const Json& scan);

}  // namespace trocar::app
