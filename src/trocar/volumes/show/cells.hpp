// A volume in cells of 8 x 8 x 8 voxels: what values are in each, and how far it is from the next in which there is
// something to see. What the caster skips by.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <trocar/volumes/image/volume.hpp>

namespace trocar::core {
class ThreadPool;
}

namespace trocar::volumes {

struct CellRanges {
  Index3 cells{};
  std::vector<std::pair<std::int16_t, std::int16_t>> range;  ///< least and greatest, the next voxels beyond included

  std::size_t count() const { return range.size(); }
};
/// Built once for a volume.
CellRanges cell_ranges(const Volume& volume, core::ThreadPool& pool);

/// Of each cell 0 where one of its numbers is `visible`, else how many cells on all sides are empty, itself included,
/// up to 255. Three bytes more than cells.
/// @param visible_up_to  of 65537 counts: how many numbers below -32768 + i are visible
std::vector<std::uint8_t> empty_around(const CellRanges& ranges, const std::vector<std::uint32_t>& visible_up_to);

}  // namespace trocar::volumes
