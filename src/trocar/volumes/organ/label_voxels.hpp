// An organ's label as voxels in the frame of scenes, for what makes cells of it: geometry/tets/stuffing.hpp.
//
//   const geometry::TetMesh liver = geometry::stuffed(label_voxels(labels, 5), 1, 0.006);
#pragma once

#include <trocar/geometry/volumes/voxels.hpp>
#include <trocar/volumes/image/labels.hpp>

namespace trocar::volumes {

/// 1 where the label is, else 0, in the box around it with a border of zeros; metres.
/// @throws std::invalid_argument  where no voxel has the label
geometry::Voxels label_voxels(const Labels& labels, int label);

}  // namespace trocar::volumes
