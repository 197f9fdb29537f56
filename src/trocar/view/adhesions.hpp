// Strings and veils of whitish tissue between an organ and the wall beside it, as most abdomens have a few. Drawing
// only: they follow the organ, and instruments pass through them.
//
//   Adhesions adhesions(organs, model, walls, backend);
//   adhesions.update(organs);                            // after the organs
#pragma once

#include <trocar/view/organ_drawing.hpp>
#include <trocar/view/wall_surface.hpp>

namespace trocar::view {

class Adhesions {
 public:
  /// @param organs  one per solid of the model, as drawn at rest
  Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
            render::Backend& backend);

  void update(const std::vector<OrganDrawing>& organs);
  /// 0: there are none.
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

 private:
  /// From a vertex of an organ's skin to a place on the wall.
  struct Veil {
    std::size_t organ = 0, vertex = 0;
    Vec3f to, to_normal, side;     ///< side: unit, across the veil
    float wide = 0, waist = 0.3f;  ///< half the width at its ends [m], and the share of it in the middle
    int seed = 0;
  };
  void choose(std::size_t organ, int count, const tissue::Skin& skin, const WallSurface& walls);
  void place(const std::vector<OrganDrawing>& organs);

  std::vector<Veil> m_veils;
  Vec3f m_down;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
