// The porta of a liver: where ducts and vessels of a ligament's front go into the organ above it, fat below peritoneum
// fills the cleft between both and covers them, as what is simulated of them ends there. A cushion of lobules that are
// lost in the ligament, in the organ and on every strand. Drawing only: instruments pass through it; it goes along
// where the organ moves.
//
//   const std::vector<PortaEntry> entries = porta_entries(model, wall, solid);
//   Porta porta(model, wall, solid, entries, backend);
//   porta.settle(organ, baker);                       // once, at rest
//   porta.update(organ);                              // after the organ
#pragma once

#include <span>
#include <vector>

#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::render {
class OpennessBaker;
}

namespace trocar::view {

/// Where a strand that is fixed in space goes into an organ, as drawn.
struct PortaEntry {
  std::size_t strand = 0;
  Vec3d at, out;      ///< [m]; unit, along the strand away from the organ
  double s = 0;       ///< arc length there [m]
  bool start = true;  ///< it is the strand's start that lies within
  double radius = 0;  ///< of the strand there [m]
};

/// Of all strands that have an end fixed within (or behind) an organ beside this wall.
std::vector<PortaEntry> porta_entries(const sim::Model& model, std::size_t wall, std::size_t solid);

class Porta {
 public:
  /// @param wall   number in Model::walls  @param solid  in Model::solids  @param entries  some
  Porta(const sim::Model& model, std::size_t wall, std::size_t solid, std::span<const PortaEntry> entries,
        render::Backend& backend);

  /// @param organ  as drawn at rest
  void settle(const OrganDrawing& organ, const render::OpennessBaker& baker);
  void update(const OrganDrawing& organ);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  std::size_t wall() const { return m_wall; }
  std::size_t solid() const { return m_solid; }
  Detail& detail() { return m_detail; }

 private:
  /// A vertex that goes along with one of the organ's skin.
  struct Follow {
    std::uint32_t vertex = 0, on = 0;
    float share = 0;
  };

  std::size_t m_wall, m_solid;
  std::vector<Vec3f> m_rest, m_organ;  ///< (vertices, the organ's) at rest
  std::vector<Follow> m_follow;
  std::uint64_t m_version = 0;  ///< of the organ
  Detail m_detail;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
