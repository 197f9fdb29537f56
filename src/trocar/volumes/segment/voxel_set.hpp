// Some voxels of a grid, as a byte for each one in the box around them, and how labels become such a set.
//
//   VoxelSet liver = voxels_of(labels, 5);
//   ... change liver.in ...
//   const LabelChange change = replaced(volume, labels, 5, liver, rules);
//
// Every tool works on sets; the rules, which say what may be changed at all, are kept in one place.
#pragma once

#include <optional>

#include <trocar/volumes/image/volume.hpp>
#include <trocar/volumes/segment/label_change.hpp>

namespace trocar::volumes {

struct VoxelSet {
  Box box;                       ///< of the grid
  std::vector<std::uint8_t> in;  ///< 0 or 1 for the voxels of the box, the first axis fastest

  explicit VoxelSet(const Box& of) : box(of), in(of.count()) {}
  Index3 size() const { return box.size(); }
  /// Of a voxel of the grid that is in the box.
  std::size_t number(const Index3& v) const {
    const Index3 s = box.size();
    return std::size_t(v[0] - box.low[0]) +
           std::size_t(s[0]) * (std::size_t(v[1] - box.low[1]) + std::size_t(s[1]) * std::size_t(v[2] - box.low[2]));
  }
  bool inside_box(const Index3& v) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (v[k] < box.low[k] || v[k] >= box.high[k]) return false;
    return true;
  }
  bool has(const Index3& v) const { return inside_box(v) && in[number(v)] != 0; }
  std::size_t count() const;

  /// Calls f(number in the set, index in the grid) for all voxels of the box, ascending.
  template <class F>
  void each(const Grid& grid, F&& f) const {
    std::size_t number_in_box = 0;
    for (int k = box.low[2]; k < box.high[2]; ++k)
      for (int j = box.low[1]; j < box.high[1]; ++j) {
        std::size_t at = grid.index(box.low[0], j, k);
        for (int i = box.low[0]; i < box.high[0]; ++i) f(number_in_box++, at++);
      }
  }
};

/// What of a label map a tool may change.
struct EditRules {
  std::optional<std::array<double, 2>> values = {};  ///< only voxels of the scan from .. to
  std::optional<std::uint16_t> inside = {};          ///< only voxels that carry this label now (0: none yet)
  bool overwrite = true;                             ///< voxels of other labels, too
};

/// The voxels of a label; the box is larger by `margin` voxels on each side, as far as the grid reaches.
VoxelSet voxels_of(const Labels& labels, int label, const Index3& margin = {0, 0, 0});
/// Of a whole box.
VoxelSet voxels_of(const Labels& labels, int label, const Box& box);

/// The voxels of the set get the label.
LabelChange labelled(const Volume& volume, const Labels& labels, const VoxelSet& set, std::uint16_t label,
                     const EditRules& rules = {});
/// The label becomes the set: what else carries it is without a label afterwards.
LabelChange replaced(const Volume& volume, const Labels& labels, std::uint16_t label, const VoxelSet& set,
                     const EditRules& rules = {});

/// Throws std::invalid_argument unless labels and volume have the same number of voxels along each axis.
void require_same_size(const Volume& volume, const Labels& labels);

}  // namespace trocar::volumes
