// Tissue that is changed at one place of an organ: a nub, a dark patch. It lies on the organ's drawn skin, goes along
// with that, and stands out from it; its border is uneven and sinks into it.
#pragma once

#include <trocar/view/base/listing.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

class FindingDrawing {
 public:
  /// @param mark  a disc with a look on an organ that is a lattice
  FindingDrawing(const sim::Model& model, const sim::MarkModel& mark, render::Backend& backend);
  static bool draws(const sim::Model& model, const sim::MarkModel& mark);

  void update(const sim::State& state);
  void list(std::size_t part, const Listing& to) const;

 private:
  /// Where a point of the disc lies on the skin.
  struct Foot {
    std::array<std::int32_t, 3> corner{};  ///< into m_vertex
    Vec3f weight;
    float high = 0;  ///< above the skin [m]
  };
  void lay(const sim::MarkModel& mark);
  Foot foot_of(Vec3d p, std::span<const std::int32_t> near, float high);
  std::int32_t number_of(std::int32_t vertex);

  const sim::Model* m_model;
  std::int32_t m_organ, m_solid;
  render::Backend* m_backend;
  const render::Material* m_material;
  std::vector<std::int32_t> m_vertex;  ///< of the drawn skin, those that count
  std::vector<Vec3f> m_place;          ///< (m_vertex) as they lie [m]
  std::vector<Foot> m_foot;            ///< (vertices of the mesh)
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
  bool m_there = false;
};

}  // namespace trocar::view
