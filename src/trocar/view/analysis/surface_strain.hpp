// How much a surface is stretched, from where its triangles were drawn and where they are.
//
//   stretches l1 >= l2 of a triangle: roots of the eigenvalues of C = F^T F, F the map of its plane
//   its strain is l1 - 1 or l2 - 1, whichever is further from 0: pulled > 0, squeezed < 0
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::view {

/// 0 for a triangle that was drawn without area.
double triangle_strain(const std::array<Vec3f, 3>& drawn, const std::array<Vec3f, 3>& now);

/// At vertices: the mean of their triangles, weighted by the areas as drawn; 0 where there are none.
/// @param out  (vertices)
void vertex_strains(std::span<const Vec3f> drawn, std::span<const Vec3f> now,
                    std::span<const std::array<int, 3>> triangles, std::vector<float>& out);

}  // namespace trocar::view
