// The rays of a tile, eight at a time: one compilation for each instruction set (caster_kernel.inl). Used by the caster
// only.
#pragma once

#include <cstdint>

namespace trocar::volumes {

inline constexpr int kCellEdge = 8;      ///< voxels along a cell
inline constexpr int kTableSize = 4096;  ///< colours between the least and the greatest value that has one
inline constexpr int kMostPlanes = 8;

/// Everything in voxels, but lengths along rays in millimetres.
struct CastJob {
  const std::int16_t* voxels = nullptr;
  int size[3]{};
  const std::uint8_t* skip = nullptr;  ///< of cells: 0 something to see, else so many cells on each side are empty
  int cells[3]{};
  const float* table = nullptr;  ///< red, green, blue, opacity of a step
  float table_from = 0, table_scale = 0;
  const std::uint8_t* tints = nullptr;  ///< of voxels the row of `tint_table`, or null
  const float* tint_table = nullptr;    ///< 256 rows: red, green, blue, how much of it
  const float* tint_opacity = nullptr;  ///< 256: times the opacity
  float inverse_spacing[3]{};
  float shade_full = 0;  ///< steepness from which on a place is shaded as a surface [numbers / mm]
  bool fine_gradient = false;
  float step = 1;             ///< [mm]
  float low[3]{}, high[3]{};  ///< the box in which there is something
  int planes = 0;
  float plane[kMostPlanes][4]{};  ///< shown is where a x + b y + c z >= d
  bool perspective = true;
  float origin[3]{}, forward[3]{}, right[3]{}, down[3]{};  ///< of the middle ray; per pixel; lengths in mm as units
  float metric_forward[3]{}, metric_right[3]{}, metric_down[3]{};  ///< the same before they became voxels [mm]
  int width = 0, height = 0;
  std::uint32_t* pixels = nullptr;
  float* depth = nullptr;
};

struct CasterKernel {
  const char* name;  ///< of the instruction set
  /// Pixels x0 .. x1, y0 .. y1 (excluded).
  void (*cast)(const CastJob& job, int x0, int y0, int x1, int y1) noexcept;
};
const CasterKernel* caster_avx2() noexcept;  ///< null where it was not compiled
const CasterKernel* caster_plain() noexcept;
const CasterKernel& caster_kernel() noexcept;  ///< the one that this machine runs; TROCAR_SIMD asks for less

}  // namespace trocar::volumes
