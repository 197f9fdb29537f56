// Peritoneum that covers an organ and runs out on what lies around it: an emptied bladder is no body of its own in the
// picture, but a low mound under a sheet between the anterior wall and the uterus. Drawing only; it follows the organ
// and whatever organ its border lies on.
//
//   Drape drape(model, solid, organs, backend);
//   drape.update(organs);                        // after the organs
#pragma once

#include <array>

#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {

inline constexpr int kDrapeSupports = 6;

class Drape {
 public:
  /// @param organs one per solid of the model, as drawn at rest
  Drape(const sim::Model& model, int solid, const std::vector<OrganDrawing>& organs, render::Backend& backend,
        const Detail& detail = {});

  void update(const std::vector<OrganDrawing>& organs);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }

 private:
  /// Where the sheet ends at one angle: on another organ's skin or, in space, on a wall.
  struct Hem {
    int solid = -1, vertex = -1;
    Vec3f at, normal;  ///< of a wall
  };
  /// What the sheet follows at one angle.
  struct Spoke {
    Vec3f out;                             ///< unit, from the organ's middle
    std::array<int, kDrapeSupports> on{};  ///< skin vertices from the organ's top to its shoulder: there it lies on it
    Hem hem;
  };
  void place(const std::vector<OrganDrawing>& organs);
  void round_top();
  void fold();  ///< from the positions at rest

  std::vector<float> m_fold;  ///< [m] how high each vertex stands: the sheet is slack
  int m_solid;
  std::vector<int> m_follows;   ///< organs
  std::uint64_t m_version = 0;  ///< of these, together
  Vec3f m_up;                   ///< away from what the organ rests on
  std::vector<Spoke> m_spokes;
  std::vector<Vec3f> m_hem, m_even;  ///< (spokes) scratch
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
