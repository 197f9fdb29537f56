// DICOM: series of slices, multi-frame images, packed or not. Used by the front door only.
#pragma once

#include <filesystem>

#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {

/// A series of a folder: the one that holds `file`, where that is not empty, else that of options.series.
Raster read_dicom_series(const std::filesystem::path& folder, const std::filesystem::path& file,
                         const ReadOptions& options, ReadReport& report);
/// One file, all of its frames.
Raster read_dicom_bytes(const Source& source);

std::vector<SeriesFacts> dicom_series(const std::filesystem::path& folder, const ReadOptions& options);

}  // namespace trocar::volumes
