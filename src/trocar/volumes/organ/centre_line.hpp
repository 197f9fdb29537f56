// The middle of a tube: a line between two places in a label, or the tree of a vessel, with its radius.
//
//   const std::vector<CentrePoint> duct = centre_line(labels, duct_label, click_a, click_b);
//   const CentreTree artery = centre_tree(labels, artery_label);
//   for (std::size_t p = 0; p < artery.points.size(); ++p) segment(artery.points[p], artery.parent[p]);
//
// Paths are the cheapest ones through the label's voxels, where a millimetre is the dearer the nearer the wall is.
// Branches are found from their far ends: what is farthest from the root and not yet near a branch is the next end. Ends
// lie on the middle line, also where a vessel was cut off flat; from there the line goes straight to the wall of its end.
// [Sato et al. 2000, TEASAR: tree-structure extraction algorithm for accurate and robust skeletons]
#pragma once

#include <optional>
#include <vector>

#include <trocar/volumes/image/labels.hpp>

namespace trocar::volumes {

struct CentrePoint {
  Vec3d at;           ///< [m], in the frame of scenes
  double radius = 0;  ///< to the nearest wall [m]
};

/// @param from_mm,to_mm  in the patient [mm, L P S]; the label's nearest voxels count
/// @throws std::invalid_argument  where no voxel has the label, or both places are not in one part of it
std::vector<CentrePoint> centre_line(const Labels& labels, int label, Vec3d from_mm, Vec3d to_mm);

struct CentreTree {
  std::vector<CentrePoint> points;
  std::vector<int> parent;  ///< of each point, before it; -1 of the root
  std::vector<int> ends;    ///< points without children, in the order in which they were found: the longest way first
};
struct TreeOptions {
  std::optional<Vec3d> root_mm = {};  ///< in the patient; none: the thicker one of the two ends that are farthest apart
  double least_branch_mm = 8;         ///< shorter ones are bumps of the wall
  int most_branches = 500;
  Progress progress = {};
};
/// Of the part of the label that the root is in.
CentreTree centre_tree(const Labels& labels, int label, const TreeOptions& options = {});

}  // namespace trocar::volumes
