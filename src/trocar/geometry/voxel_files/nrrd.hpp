// Volumes of voxels from NRRD files, as 3D Slicer saves scans (.nrrd, .nhdr) and segmentations (.seg.nrrd).
//
//   const NrrdVolume file = read_nrrd(bytes, "liver.seg.nrrd");
//   const Voxels volume = voxels_of(file, "liver.seg.nrrd");
//   const TetMesh liver = stuffed(volume, 5, 0.006);   // stuffing.hpp
//
// A text header, an empty line, the data: raw, gzip or ascii, in the file or in one beside it. Source: Definition of
// the NRRD file format, teem 1.9.
//
// Files are taken as hostile: what they announce is believed as far as the bytes reach, never further.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/geometry/volumes/voxels.hpp>
#include <trocar/geometry/voxel_files/numbers.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::geometry {

inline constexpr std::size_t kMostVoxels = std::size_t(1) << 27;  ///< 512^3

struct NrrdOptions {
  std::size_t most_voxels = kMostVoxels;
  /// Which of several time points or layers (`what`) is read; throws where there is no such one. Default: 0, with a
  /// note.
  std::function<int(std::int64_t count, const char* what)> choose = {};
  /// The bytes of a file in the same folder; throws core::BadInput. Default: data in another file are a fault.
  std::function<std::string(const std::string& name)> beside = {};
  std::function<void(double)> progress = {};  ///< called with the share that is done; may throw
};

/// What 3D Slicer says of a label.
struct NrrdSegment {
  std::string name;
  int label = 0;
  std::optional<std::array<double, 3>> colour;  ///< red, green, blue from 0 to 1
};

struct NrrdVolume {
  std::array<int, 3> size{};
  Vec3d origin;                            ///< centre of the first voxel [mm, L P S]
  Mat3d step = Mat3d::identity();          ///< columns: from a voxel to the next along each axis [mm, L P S]
  NumberType type = NumberType::int16;     ///< of the numbers below
  NumberType written = NumberType::int16;  ///< as the header says; text is kept as real64
  bool big_endian = false;
  std::size_t stride = 1;  ///< numbers from a voxel to the next: layers may be side by side
  std::vector<NrrdSegment> segments;
  std::vector<std::string> notes;  ///< what was guessed, chosen or left out
  std::vector<char> owned;         ///< the numbers, unpacked or from another file
  std::string_view bytes;          ///< where nothing is owned: in the file

  std::size_t count() const { return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]); }
  /// From the first number of the first voxel to the last voxel's.
  std::size_t wanted_numbers() const { return (count() - 1) * stride + 1; }
  std::size_t wanted() const { return wanted_numbers() * width_of(type); }
  const char* data() const { return owned.empty() ? bytes.data() : owned.data(); }
};

/// Spaces of the patient (LPS, RAS, LAS) are turned into L P S; without `space` the axes are taken as L P S, with a
/// note. Lengths are millimetres where `space units` does not say otherwise.
/// @throws core::BadInput with all faults of the header, or those of the data, named `file`
NrrdVolume read_nrrd(std::string_view bytes, const std::string& file, const NrrdOptions& options = {});

/// The voxels in the frame of scenes: x to the patient's left, y cranial, z anterior, in metres from the file's own
/// origin. int8 and int16 become int16; types of 32 bits and more become float.
/// @throws core::BadInput  for numbers that float does not hold: not finite, or whole ones beyond 2^24
Voxels voxels_of(const NrrdVolume& volume, const std::string& file);

/// The name of a file in the same folder without "./" before it; none: it lies elsewhere, or stands for several.
std::optional<std::string> name_beside(std::string_view name);

/// What to do about a name for which name_beside() has none, as the end of a message.
std::string remedy_for_name(std::string_view name);

bool looks_like_nrrd(std::string_view bytes);

}  // namespace trocar::geometry
