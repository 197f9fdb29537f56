// Tools that look at the scan's values: all voxels between two values, those that hang together with a click, and seeds
// of several labels that grow until they meet.
#pragma once

#include <span>

#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {

/// Voxels with values from .. to get the label.
LabelChange thresholded(const Volume& volume, const Labels& labels, std::array<double, 2> values, std::uint16_t label,
                        const EditRules& rules = {});

/// Of these voxels those that hang together by faces with a seed [voxels of the grid; others are passed over].
LabelChange grown(const Volume& volume, const Labels& labels, std::span<const Index3> seeds,
                  std::array<double, 2> values, std::uint16_t label, const EditRules& rules = {});

struct CompeteOptions {
  double margin_mm = 50;  ///< how far around the seeds anything may grow
  double contrast = 20;   ///< a step over such a difference of values is as dear as two steps of no difference
  Progress progress = {};
};
/// All labels are seeds; voxels without one get that of the seed that reaches them most cheaply, where a step costs
/// more the more the values on both sides differ: labels meet at edges of the scan. Give what is neither a label of its
/// own, and clear that afterwards. [geodesic form of GrowCut: Zhu et al. 2014, An effective interactive medical image
/// segmentation method using fast GrowCut]
/// @throws Cancelled
LabelChange grown_from_labels(const Volume& volume, const Labels& labels, const CompeteOptions& options = {},
                              const EditRules& rules = {});

}  // namespace trocar::volumes
