// Volumes of voxels from NRRD files, as 3D Slicer saves scans (.nrrd) and segmentations (.seg.nrrd).
//
//   const Voxels volume = read_nrrd(bytes, "liver.seg.nrrd");
//   const TetMesh liver = stuffed(volume, 5, 0.006);   // stuffing.hpp
//
// A text header, an empty line, the data: raw, gzip or ascii. Read are three-dimensional files with the data attached,
// of the types int8 to int32, uint8 to uint32, float and double. Source: Definition of the NRRD file format, teem 1.9.
//
// Files are taken as hostile: what they announce is believed as far as the bytes reach, never further.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <trocar/geometry/volumes/voxels.hpp>

namespace trocar::geometry {

inline constexpr std::size_t kMostVoxels = std::size_t(1) << 27;  ///< 512^3
/// Origins beyond this are a fault [units of the file].
inline constexpr double kMostNrrdOrigin = 1e6;

/// The voxels in our frame: x to the patient's left, y cranial, z anterior, in metres from the file's own origin.
/// `space` must be one of the patient's (LPS, RAS, LAS); lengths are millimetres where `space units` does not say
/// otherwise. int8 and int16 become int16; the types of 32 bits and more become float, which whole numbers beyond 2^24
/// do not fit: a fault.
/// @throws core::BadInput with all faults of the header, or those of the data, named `file`
Voxels read_nrrd(std::string_view bytes, const std::string& file, std::size_t most_voxels = kMostVoxels);

}  // namespace trocar::geometry
