// Voxels whose surface is one sheet everywhere: sets in which two voxels touch by an edge or a corner alone have a
// surface with edges of four triangles, which no body may have. [Latecki, Eckhardt & Rosenfeld 1995, Well-composed
// sets]
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace trocar::volumes {

/// Voxels in a block with a border of zeros one voxel wide.
struct PaddedVoxels {
  std::array<int, 3> size{};     ///< with the border
  std::vector<std::uint8_t> in;  ///< 0 or 1, the first axis fastest

  std::size_t index(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(size[0]) * (std::size_t(j) + std::size_t(size[1]) * std::size_t(k));
  }
};

/// Adds voxels until no two touch by an edge or corner alone, inside or outside; how many. The border stays free.
std::size_t make_well_composed(PaddedVoxels& voxels);

}  // namespace trocar::volumes
