// Bonds as one sees them once they are drawn out: threads of loose tissue between a wall and what it lies on. Of one
// that has parted, shreds are left on either side.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

class BondDrawing {
 public:
  /// @param set  number in Model::bonds
  BondDrawing(const sim::Model& model, std::size_t set, render::Backend& backend);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  std::size_t membrane() const { return m_set->membrane(); }  ///< the wall that they tie

 private:
  void place(const sim::State& state);
  void lay_thread(std::uint32_t first, Vec3d from, Vec3d to, Vec3d aside, bool rooted_at_both_ends);

  const sim::Model* m_model;
  const interactions::BondSet* m_set;
  std::size_t m_index;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
