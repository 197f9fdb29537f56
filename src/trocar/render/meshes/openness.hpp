// Bakes how open each vertex is to its surroundings (ambient occlusion) for Paint::openness: rays through a grid of the
// scene's occupied cells. Once per scene, at rest; deformation does not change it.
//
//   const OpennessBaker baker(occluders);
//   baker.bake(x, normals, paint);        // sets paint[i].openness
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/numerics/vec3.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>

namespace trocar::render {

struct Occluder {
  std::span<const Vec3f> positions;          ///< [m]
  std::span<const std::uint32_t> triangles;  ///< (3 per triangle)
};

class OpennessBaker {
 public:
  /// @param cell [m] grid cell; what is smaller does not shade. @param reach [m] what is further does not shade
  explicit OpennessBaker(std::span<const Occluder> occluders, float cell = 0.0015f, float reach = 0.02f);
  /// @param normals (n) unit; paint (n): openness is set, the rest kept
  void bake(std::span<const Vec3f> positions, std::span<const Vec3f> normals, std::span<Paint> paint) const;

 private:
  bool occupied(Vec3f p) const;
  float openness_at(Vec3f p, Vec3f normal) const;

  float m_cell, m_reach;
  Vec3f m_low;
  int m_size[3] = {0, 0, 0};
  std::vector<bool> m_cells;
};

/// Takes each vertex' openness halfway to the mean of those that it shares triangles with, `passes` times: where a mesh
/// runs into another at a small angle, rays meet that at one vertex and miss it at the next.
void even_openness(std::span<const std::uint32_t> triangles, std::span<Paint> paint, int passes);

}  // namespace trocar::render
