// A surface with fewer triangles over the same vertices: for drawing it small. Vertices are taken away one after the
// other, each into a neighbour, the least noticed first, as long as the surface stays near to what it was.
//
//   const std::vector<double> errors{0.0001, 0.0003};
//   const auto lists = coarsened(positions, triangles, notes, errors);   // lists[1] has fewer triangles than lists[0]
//
// The cost of taking a vertex away is the distance, root mean square, from where it goes to the planes of all triangles
// that it stands for [Garland & Heckbert 1997]; what varies over the surface counts as a distance, too. Borders stay as
// they are, so that surfaces that touch there still do.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// @param triangles  (3 per triangle) indices of positions; vertices without a triangle are allowed
/// @param notes      (n) or empty: what else varies over the surface, as lengths [m]: taking a vertex away costs at
///                   least as much as the notes of it and of where it goes differ
/// @param errors     [m] rising: how far the surface may leave its place (here and there twice that), a list of
///                   triangles each
/// @param longest_edge  [m] none longer is made: what moves must be able to bend
/// @returns as many lists as errors; each is made of the one before
std::vector<std::vector<std::uint32_t>> coarsened(std::span<const Vec3f> positions,
                                                  std::span<const std::uint32_t> triangles,
                                                  std::span<const Vec3f> notes, std::span<const double> errors,
                                                  double longest_edge);

}  // namespace trocar::geometry
