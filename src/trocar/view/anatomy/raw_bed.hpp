// The bed that a gallbladder leaves on the liver: where bonds have parted the capsule is gone. What is below is raw and
// granular with rags of fascia; where current went along, eschar lies on it in patches, brown to black, a little
// raised, blanched around, and between them small vessels ooze. Drawing only: it lies on the organ as drawn and shows
// what state each bond is in.
//
//   RawBed bed(model, solid, organ, backend);
//   bed.update(state, organ);                         // after the organ
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/bodies/organ_drawing.hpp>

namespace trocar::view {

class RawBed {
 public:
  /// @param solid  in Model::solids  @param organ  its drawing, at rest
  RawBed(const sim::Model& model, std::size_t solid, const OrganDrawing& organ, render::Backend& backend);
  /// Is any wall tied to this organ?
  static bool lies_on(const sim::Model& model, std::size_t solid);

  void update(const sim::State& state, const OrganDrawing& organ);
  bool any() const { return m_any; }  ///< has a bond parted?
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  std::size_t solid() const { return m_solid; }

 private:
  /// A small vessel that oozes.
  struct Spot {
    Vec3f at;          ///< at rest
    float radius = 0;  ///< [m]
    float strength = 0;
  };
  struct Foot {
    std::size_t set = 0, bond = 0;
    Vec3f at;            ///< at rest
    float strength = 0;  ///< 0..1: of the current that it got
    std::vector<Spot> oozing;
  };
  enum class Seen : std::uint8_t { holds, raw, burnt };

  /// A vertex of the mesh: on a triangle of the organ's skin.
  struct Place {
    std::array<std::uint32_t, 3> corner{};
    Vec3f share;
    std::vector<std::uint16_t> near;  ///< feet
    float high = 0;                   ///< above the skin [m]
  };
  void find_feet(const sim::Model& model);
  void divide(const sim::Model& model, const OrganDrawing& organ);
  bool look_at(const sim::State& state, const OrganDrawing& organ);
  void paint(std::size_t vertex, const OrganDrawing& organ);
  void leave_out_hidden();
  void place(const OrganDrawing& organ);

  std::size_t m_solid;
  std::vector<Foot> m_feet;
  std::vector<Seen> m_seen;   ///< (feet) as painted
  std::uint64_t m_burns = 0;  ///< sum of what heat has left on the organ below, as painted
  std::vector<Place> m_places;
  std::vector<std::uint32_t> m_all;  ///< triangles, those below the skin too
  std::uint64_t m_version = 0;       ///< of the organ
  bool m_any = false;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
