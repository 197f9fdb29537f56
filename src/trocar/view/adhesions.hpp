// Strings and veils of whitish tissue between an organ and the wall beside it, as most abdomens have a few. Each is
// drawn thin between two triangular feet that lie in what it hangs on. Drawing only: they follow the organ, and
// instruments pass through them.
//
//   Adhesions adhesions(organs, model, walls, backend);
//   adhesions.update(organs);                            // after the organs
#pragma once

#include <array>

#include <trocar/view/organ_drawing.hpp>
#include <trocar/view/wall_surface.hpp>

namespace trocar::view {

class Adhesions {
 public:
  /// @param organs  one per solid of the model, as drawn at rest
  Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
            render::Backend& backend, const Detail& detail = {});

  void update(const std::vector<OrganDrawing>& organs);
  /// 0: there are none.
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

  static constexpr int kAlong = 23, kAcross = 9;  ///< vertices of a veil

 private:
  /// A vertex of a foot in an organ's skin: beside one of the skin's.
  struct OnSkin {
    std::size_t vertex = 0;
    Vec3f beside;
  };
  /// From a line on an organ's skin to one on the wall.
  struct Veil {
    std::size_t organ = 0;
    std::array<OnSkin, kAcross> from;
    std::array<Vec3f, kAcross> to;  ///< in the wall
    float waist = 0.3f;             ///< width in the middle, as a share of the feet's
    int seed = 0;
    bool near(Vec3f p, const tissue::Skin& skin) const;
  };
  void choose(std::size_t organ, int count, const tissue::Skin& skin, const WallSurface& walls);
  void place(const std::vector<OrganDrawing>& organs);
  void place_veil(const Veil& veil, const OrganDrawing& organ, std::size_t first);

  std::vector<Veil> m_veils;
  std::uint64_t m_version = 0;  ///< of their organs, together
  Vec3f m_down;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
