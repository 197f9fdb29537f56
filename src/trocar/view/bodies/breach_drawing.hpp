// Where an organ has been torn in place of bonds that are tougher than it: its raw inside, patch beside patch, red
// while it bleeds and dark once it has been coagulated.
#pragma once

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

class BreachDrawing {
 public:
  /// @param set  number in Model::bonds
  BreachDrawing(const sim::Model& model, std::size_t set, render::Backend& backend);

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  bool any() const { return m_any; }                                        ///< is there anything to be seen?
  int organ() const { return int(m_set->bonds.front().far.body.index()); }  ///< that is torn; of several the first

 private:
  void place(const sim::State& state);
  void lay_patch(std::size_t bond, Vec3d middle, Vec3d out, double radius);

  const sim::Model* m_model;
  const interactions::BondSet* m_set;
  std::size_t m_index;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
  bool m_any = false;
};

}  // namespace trocar::view
