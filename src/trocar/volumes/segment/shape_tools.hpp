// Tools that look at a label's shape: margins, smoothing that keeps the volume, drawing between slices.
#pragma once

#include <span>

#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {

/// Grown by so many millimetres, or shrunk where below 0: voxels whose centres are that near. What the grid's border
/// cuts is not shrunk there.
LabelChange margin_moved(const Volume& volume, const Labels& labels, std::uint16_t label, double millimetres,
                         const EditRules& rules = {});
/// Only a shell of this thickness stays, within the label.
LabelChange hollowed(const Volume& volume, const Labels& labels, std::uint16_t label, double millimetres,
                     const EditRules& rules = {});

enum class Smoothing : unsigned char {
  median,        ///< more than half of the voxels around decide: thin parts go, and convex ones shrink
  keeps_volume,  ///< the share of the label around, cut where as many voxels remain as were there
};
struct SmoothLabel {
  LabelChange change;
  double ml_before = 0, ml = 0;
};
/// @param radius_mm  of what counts as around
SmoothLabel smoothed(const Volume& volume, const Labels& labels, std::uint16_t label, double radius_mm, Smoothing how,
                     const EditRules& rules = {});
/// Several labels at once, each voxel to the one with most around: no gaps come up between neighbours.
LabelChange smoothed_together(const Volume& volume, const Labels& labels, std::span<const std::uint16_t> together,
                              double radius_mm, const EditRules& rules = {});

/// Slices across `axis` in which the label was drawn, and the gaps between them filled by shapes in between.
/// [Raya & Udupa 1990, Shape-based interpolation of multidimensional objects]
LabelChange filled_between_slices(const Volume& volume, const Labels& labels, std::uint16_t label, int axis,
                                  const EditRules& rules = {});

enum class Logic : unsigned char { copy, add, subtract, intersect, invert, clear };
/// What the label becomes: `copy` the other set; `add` both together; `subtract` itself without the other; `intersect`
/// what is in both; `invert` all voxels that carry no label, and its own no more; `clear` nothing. The last two pass
/// over `other`.
LabelChange combined(const Volume& volume, const Labels& labels, std::uint16_t label, Logic how, const VoxelSet& other,
                     const EditRules& rules = {});

}  // namespace trocar::volumes
