// The point of a posed skin, or of a wall, that is nearest to a point near it.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

struct SkinPoint {
  std::array<int, 3> vertex{};
  Vec3d weights, point, normal;  ///< of the corners; [m]; unit, outward
};

/// The nearest vertex within `reach`, -1 if there is none.
int nearest_vertex_near(const Surface& surface, Vec3d p, double reach) noexcept;
/// The same among these blocks of kSkinBlock vertices. @param blocks  ascending
int nearest_vertex_near(const Surface& surface, Vec3d p, double reach, std::span<const std::int32_t> blocks) noexcept;

/// The nearest point of the triangles at that vertex, without its normal.
SkinPoint nearest_on_faces(const Surface& surface, int vertex, Vec3d p) noexcept;
/// The same with it.
SkinPoint nearest_skin_point(const Surface& surface, int vertex, Vec3d p) noexcept;

/// Is p inside? By a ray through all of the skin: for what the side of the nearest triangle cannot tell, as where a lip
/// is turned over. Where the ray goes through skin that is torn, it says yes.
bool encloses(const Surface& surface, Vec3d p) noexcept;

}  // namespace trocar::interactions
