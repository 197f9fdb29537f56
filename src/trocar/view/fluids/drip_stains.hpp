// Blood that has dripped from a cut onto what lies below it and does not move, as drawn: patches with specks around
// them, and a run down the ground's furrows (drawn only; in the simulation such blood is on its way to the pool).
#pragma once

#include <span>
#include <vector>

#include <trocar/geometry/surfaces/block_boxes.hpp>
#include <trocar/render/frame/liquid.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

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
  /// Onto the ground right below a place that lies about on it.
  bool let_down(Vec3f at, Vec3f down, Landing& here) const;
  static render::Splat film(const Landing& from, Vec3f to, float radius, float thick);
  static void lay(const Landing& from, Vec3f to, float radius, float thick, render::Liquid& liquid);
  void list_stain(Landing at, int own, float drops, render::Liquid& liquid) const;
  void list_run(Landing at, int own, float drops, render::Liquid& liquid) const;

  std::vector<Ground> m_grounds;
};

}  // namespace trocar::view
