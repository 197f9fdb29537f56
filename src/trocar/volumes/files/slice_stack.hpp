// Slices that were taken one by one, as a volume: their order along their normal, and whether they are evenly spaced.
//
//   const auto levels = levels_of(places, cross(row, column));   // which of them are at the same position
//   const SliceStack stack = stack_slices(places, row, column, file, notes);
//   for (int k = 0; k < stack.slices; ++k) use(places[stack.order[k]]);
//
// What counts is where each slice says that it is, never its number or its thickness. Used by the readers only.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::volumes {

struct SlicePlace {
  Vec3d position;        ///< of the first pixel's centre [mm, L P S]
  double thickness = 0;  ///< [mm], of a single slice the only thing known
};

/// The slices at each position along the normal, lowest first: indices.
std::vector<std::vector<int>> levels_of(std::span<const SlicePlace> places, Vec3d normal);

struct SliceStack {
  int slices = 0;
  std::vector<int> order;  ///< indices, lowest first
  Vec3d origin, step;      ///< of the first pixel; from slice to slice, not along the normal where sheared [mm]
};

/// @param row, column  directions along and across the rows of pixels
/// @throws core::BadInput  for missing slices, which it names; for uneven ones; for two at one position
SliceStack stack_slices(std::span<const SlicePlace> places, Vec3d row, Vec3d column, const std::string& file,
                        std::vector<std::string>& notes);

}  // namespace trocar::volumes
