// An organ's drawn skin, x = W q, with normals of its present shape.
#pragma once

#include <trocar/sim/state.hpp>
#include <trocar/view/mesh_buffer.hpp>
#include <trocar/view/relief.hpp>

namespace trocar::view {

class OrganDrawing {
 public:
  /// @param paint one per vertex of solid.fine (baked openness)
  OrganDrawing(const sim::SolidModel& solid, const Relief& relief, std::vector<Paint> paint, render::Backend& backend);

  /// Moves the mesh; costs nothing where no node has moved since the last time.
  void update(const tissue::NetworkState& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }

 private:
  void lift();
  bool moved(const tissue::NetworkState& state);

  const sim::SolidModel* m_solid;
  tissue::SkinPose m_pose;
  std::vector<std::uint32_t> m_indices;
  std::vector<Vec3f> m_normals;
  std::vector<float> m_height;             ///< relief; empty: none
  std::vector<tissue::NodeState> m_drawn;  ///< the nodes that the mesh shows
  OwnedMesh m_mesh;
};

/// Triangles of a skin as the backend wants them.
std::vector<std::uint32_t> flat_indices(const tissue::Skin& skin);

}  // namespace trocar::view
