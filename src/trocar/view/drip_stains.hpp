// Blood that has dripped from a cut onto what lies below it and does not move, as drawn: patches that run down a
// little, with specks around them (drawn only; in the simulation such blood is on its way to the pool).
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/block_boxes.hpp>
#include <trocar/render/liquid.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {

class DripStains {
 public:
  /// Adds a mesh that drops fall on. @param ground  with normals; copied
  void add_ground(const MeshBuffer& ground);
  /// Adds films to liquid.splats where what falls from these places lands first, if anything of it is below.
  void list(std::span<const Vec3f> drips, render::Liquid& liquid) const;

 private:
  struct Ground {
    std::vector<Vec3f> positions;
    std::vector<std::array<int, 3>> triangles;
    geometry::TriangleBlocks blocks;
    std::vector<geometry::Box> boxes;
  };
  struct Landing {
    Vec3f position, normal;
  };
  bool land(Vec3f from, Vec3f down, Landing& at) const;
  void list_stain(Landing at, int own, render::Liquid& liquid) const;

  std::vector<Ground> m_grounds;
};

}  // namespace trocar::view
