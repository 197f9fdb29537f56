// Volume of a tetrahedron, in the one order of arithmetic that all of Trocar uses.
#pragma once

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

/// Six volumes of the cell (o, a, b, c): above 0 where it is upright (tet_mesh.hpp).  [m^3]
constexpr double volume6(Vec3d o, Vec3d a, Vec3d b, Vec3d c) noexcept { return dot(a - o, cross(b - o, c - o)); }

}  // namespace trocar::geometry
