// Parts of a label that hang together by faces: kept, removed, told apart; and the holes within it.
#pragma once

#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {

struct Islands {
  std::vector<std::int32_t> of;     ///< of the set's voxels the island, 0 the largest; -1 where none
  std::vector<std::size_t> voxels;  ///< of each island, falling; equal ones in the order of their first voxel
};
Islands islands_of(const VoxelSet& set);

/// The largest one stays.
LabelChange largest_kept(const Volume& volume, const Labels& labels, std::uint16_t label, const EditRules& rules = {});
/// Those of fewer voxels go.
LabelChange small_removed(const Volume& volume, const Labels& labels, std::uint16_t label, std::size_t least_voxels,
                          const EditRules& rules = {});
/// Only the one with this voxel stays; nothing changes where the voxel has another label.
LabelChange chosen_kept(const Volume& volume, const Labels& labels, std::uint16_t label, const Index3& voxel,
                        const EditRules& rules = {});
/// All but the largest get labels of their own, first_new, first_new + 1, ..., as many as there are up to 65535.
LabelChange split(const Volume& volume, const Labels& labels, std::uint16_t label, std::uint16_t first_new,
                  std::size_t least_voxels = 1);

/// What the label encloses gets it. `axis` 0 .. 2: in slices across that axis; -1: in space.
LabelChange holes_filled(const Volume& volume, const Labels& labels, std::uint16_t label, int axis = -1,
                         const EditRules& rules = {});

}  // namespace trocar::volumes
