// Areolar tissue between a wall and what it lies on, as one sees it in the gap: sheer, glistening films from bond to
// neighbouring bond, with denser cords where the bonds are. A film hangs only between bonds that hold: beside one that
// has parted it ends in a hollow, frayed border, and where both have parted a ragged hem is left on either side.
#pragma once

#include <utility>
#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/moved.hpp>

namespace trocar::view {

/// Those of these places that are neighbours: no third one lies in the ball that has both on its surface
/// [Gabriel & Sokal 1969], and they are no further apart than `reach` [m].
std::vector<std::pair<int, int>> neighbours(const std::vector<Vec3d>& places, double reach);

/// A bond: where it is rooted, where it holds the wall, how much of it is left.
struct VeilTie {
  Vec3d foot, node;
  double whole = 1;  ///< 1: unharmed, 0: parted
};

class BondVeils {
 public:
  /// @param set  number in Model::bonds
  BondVeils(const sim::Model& model, std::size_t set, render::Backend& backend);

  void update(const sim::State& state);
  bool any() const { return !m_pairs.empty(); }  ///< false: no bond has a neighbour
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  std::size_t membrane() const { return m_set->membrane(); }  ///< the wall that they tie

  /// For tests: bonds that a film hangs between, how many vertices each has, and all of them as last made.
  const std::vector<std::pair<int, int>>& pairs() const { return m_pairs; }
  static std::size_t vertices();
  const MeshBuffer& buffer() const { return m_buffer; }

 private:
  bool gather(const sim::State& state);
  void lay(std::size_t pair);
  void lay_film(std::size_t pair, const VeilTie& a, const VeilTie& b, bool spans);
  void lay_hems(std::size_t pair, const VeilTie& a, const VeilTie& b);
  void put(std::size_t pair, int column, int row, Vec3d place, double dense, double cord);

  const sim::Model* m_model;
  const interactions::BondSet* m_set;
  std::size_t m_index;
  std::vector<std::pair<int, int>> m_pairs;
  std::vector<VeilTie> m_ties;  ///< (bonds)
  std::vector<Vec3d> m_ends;
  Moved m_moved;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
