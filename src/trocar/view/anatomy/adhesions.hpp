// Strings and veils of whitish tissue between an organ or bowel and the wall beside it, as most abdomens have a few:
// slack, thin, with concave borders, folded over, and finer strands in them, between two feet like fans that lie in
// what they hang on. Curtains are the broadest: they span level from large or small bowel to a wall. None comes near a
// tube. Drawing only: they follow the organ, and instruments pass through them.
//
//   Adhesions adhesions(organs, model, walls, {bowel_loops}, backend);
//   adhesions.update(organs);                            // after the organs
#pragma once

#include <array>

#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/wall_surface.hpp>

namespace trocar::view {

class Adhesions {
 public:
  /// A surface that does not move, on which some begin.
  struct Still {
    const MeshBuffer* shape = nullptr;  ///< with normals
    int to_wall = 0;                    ///< so many from there to the wall, at most
  };

  /// @param organs  one per solid of the model, as drawn at rest
  Adhesions(const std::vector<OrganDrawing>& organs, const sim::Model& model, const WallSurface& walls,
            std::span<const Still> still, render::Backend& backend, const Detail& detail = {});

  void update(const std::vector<OrganDrawing>& organs);
  /// 0: there are none.
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

  static constexpr int kAlong = 23, kAcross = 15;  ///< vertices of a veil
  static constexpr float kFromTubes = 0.009f;      ///< [m] from a uterine tube's middle at least, at rest

 private:
  /// What some begin on.
  struct Source {
    int organ = -1;  ///< -1: it does not move
    std::span<const Vec3f> points, normals;
    int seed = 0;
    double veils = 0.65;    ///< share of them; the others are strings
    bool curtains = false;  ///< all are veils, broader and longer than others
  };
  /// A vertex of a foot in a surface: beside one of the surface's.
  struct OnSkin {
    std::size_t vertex = 0;
    Vec3f beside;
  };
  /// From a line on one surface to one on another that does not move.
  struct Veil {
    Source on;
    std::array<OnSkin, kAcross> from;
    std::array<Vec3f, kAcross> to;
    float waist = 0.3f;  ///< width in the middle, as a share of the feet's
    float sag = 0.08f;   ///< of the length
    int seed = 0;
  };
  struct Width {
    double half = 0;   ///< of a foot [m]
    double waist = 0;  ///< see Veil
  };
  static Width width_of(const Source& source, int seed);
  void choose(const Source& source, int count, const WallSurface& walls);
  bool clear(const Veil& veil) const;
  void place(const std::vector<OrganDrawing>& organs);
  void place_veil(const Veil& veil, std::span<const Vec3f> points, std::span<const Vec3f> normals,
                  std::span<Vec3f> out) const;

  std::vector<Veil> m_veils;
  std::vector<Vec3f> m_tubes;   ///< middles of what they stay away from
  std::uint64_t m_version = 0;  ///< of their organs, together
  Vec3f m_down;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
