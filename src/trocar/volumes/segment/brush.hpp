// Painting and erasing: a ball, or a disc in a slice, along a stroke.
#pragma once

#include <optional>
#include <span>

#include <trocar/volumes/segment/voxel_set.hpp>

namespace trocar::volumes {

struct Brush {
  double radius_mm = 5;
  /// Of a disc: the slice's normal, of unit length; the disc is a voxel thick. None: a ball.
  std::optional<Vec3d> normal = {};
};
/// @param stroke  places that the brush's middle passes in straight lines [mm, L P S]; one for a dab
/// @param label   0 erases every label, or that of rules.inside
LabelChange painted(const Volume& volume, const Labels& labels, std::span<const Vec3d> stroke, const Brush& brush,
                    std::uint16_t label, const EditRules& rules = {});

}  // namespace trocar::volumes
