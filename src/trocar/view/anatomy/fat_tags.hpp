// Epiploic appendages: lobed cushions of fat, unequal, that hang on the large bowel in rows and tell it from the small.
// Each rises from the bowel's skin without a border and hangs over in tongues. They ride on the organ's drawn skin;
// mechanically they are nothing.
#pragma once

#include <array>
#include <vector>

#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {

class FatTags {
 public:
  /// @param count at most so many, on the organ's sides, none near another. @param gravity they hang along
  /// it
  FatTags(const OrganDrawing& organ, const sim::SolidModel& solid, int count, Vec3d gravity, render::Backend& backend,
          const Detail& detail = {});

  void update(const OrganDrawing& organ);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

  /// A place in a triangle of the skin.
  struct OnSkin {
    std::array<std::uint32_t, 3> corner{};
    Vec3f weight;
  };

 private:
  struct Tag {
    std::uint32_t at = 0, beside = 0;  ///< skin vertices: its middle, and which way its frame's x axis points
    std::vector<OnSkin> on;            ///< (its vertices)
    std::vector<Vec3f> off;            ///< from there, in its frame (x, y, normal) [m]
  };
  void place(const OrganDrawing& organ);

  std::vector<Tag> m_tags;
  std::uint64_t m_version = 0;  ///< of the organ
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
