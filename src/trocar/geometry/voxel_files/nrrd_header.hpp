// The header of an NRRD file, understood. Used by nrrd.cpp only.
#pragma once

#include <cstdint>
#include <string>

#include <trocar/geometry/voxel_files/header_fields.hpp>
#include <trocar/geometry/voxel_files/nrrd.hpp>

namespace trocar::geometry {

enum class NrrdEncoding : unsigned char { raw, gzip, text };

struct NrrdHeader {
  NrrdVolume volume;  ///< without its numbers
  NrrdEncoding encoding = NrrdEncoding::raw;
  std::size_t layers = 1;  ///< time points or layers
  std::size_t first = 0;   ///< numbers before the first of the chosen layer
  const HeaderField* data_file = nullptr;
  std::int64_t byte_skip = 0, line_skip = 0;  ///< byte_skip -1: the data are the last bytes of the file

  std::size_t all_numbers() const { return volume.count() * layers; }
};

/// @throws core::BadInput  with all faults
NrrdHeader nrrd_header(HeaderFields& fields, const NrrdOptions& options, const std::string& file);

}  // namespace trocar::geometry
