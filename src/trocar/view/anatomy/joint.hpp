// Where a strand grows out of an organ: a collar from the strand's side to the organ's surface, tangent to both, in the
// organ's stuff and going over into the strand's colour, so that one peritoneum seems to run over both. Drawing only.
//
//   Joint joint(tube, true, organ, skin, backend);
//   joint.update(tube, organ);                       // after both
#pragma once

#include <trocar/view/bodies/organ_drawing.hpp>
#include <trocar/view/bodies/tube_drawing.hpp>

namespace trocar::view {

class Joint {
 public:
  /// @param tube    as drawn at rest; its end at_start is hosted by the organ
  /// @param organ   as drawn at rest  @param skin  the one it draws
  Joint(const TubeDrawing& tube, bool at_start, const OrganDrawing& organ, const tissue::Skin& skin,
        render::Backend& backend, const Detail& detail = {});
  /// Into a wall.
  Joint(const TubeDrawing& tube, bool at_start, const WallSurface& walls, render::Backend& backend,
        const Detail& detail = {});

  /// @param organ  null: of a wall
  void update(const TubeDrawing& tube, const OrganDrawing* organ);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  int sides() const { return m_sides; }

 private:
  /// A place on the organ's skin, or on a wall.
  struct Foot {
    std::array<std::uint32_t, 3> vertex{};
    Vec3f share;
    Vec3f at, normal;  ///< of a wall
  };
  /// A plane that the strand meets: a point of it, its normal, which way the strand goes there.
  struct Meeting {
    Vec3d entry, normal, way;
  };
  static Meeting meeting(const TubeNeck& neck, Vec3d at, Vec3d normal);
  static Vec3d aside(const Meeting& m, const TubeNeck& neck, std::size_t k, double skirt);
  void make(const TubeDrawing& tube, const OrganDrawing* organ, render::Backend& backend, const Detail& detail);
  Foot foot_at(Vec3d p, const OrganDrawing& organ, const tissue::Skin& skin) const;
  void place(const TubeDrawing& tube, const OrganDrawing* organ);

  bool m_at_start;
  int m_sides;
  std::uint64_t m_version = 0;  ///< of strand and organ, together
  std::vector<Foot> m_feet;     ///< (sides)
  std::vector<std::uint32_t>
      m_below;  ///< (vertices) the organ's skin vertex below: what heat has left there shows here
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
