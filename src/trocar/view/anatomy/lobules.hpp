// The shape of fat: lobules that lie against each other.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::view {

/// Round lobules of unequal size, about `size` [m] wide, that lie against each other: 1 on top .. 0 in a groove. Where
/// they meet they are fused: grooves are soft.   [after Worley 96, with a smooth nearest]
double lobules(Vec3d p, double size);

}  // namespace trocar::view
