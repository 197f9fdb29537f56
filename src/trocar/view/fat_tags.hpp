// Epiploic appendages: lobed flaps of fat, few and unequal, that hang on the large bowel in rows and tell it from the
// small. They ride on the organ's drawn skin; mechanically they are nothing.
#pragma once

#include <vector>

#include <trocar/view/organ_drawing.hpp>

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

 private:
  struct Tag {
    std::uint32_t at = 0, beside = 0;  ///< skin vertices: where it hangs, and which way its x axis points
    double size = 1;
    MeshBuffer shape;  ///< in the frame (x, y, normal) of `at`
  };
  void place(const OrganDrawing& organ);

  std::vector<Tag> m_tags;
  std::uint64_t m_version = 0;  ///< of the organ
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
