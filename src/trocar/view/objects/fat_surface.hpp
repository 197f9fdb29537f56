// The common surface of lobules: where the sum of their bells is a half, taken from a grid by surface nets [Gibson 98].
//
//   FatSurface surface(0.0008);
//   surface.draw(lobules, buffer);   // positions, normals, rest and paint of it
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

struct DrawnLobule {
  Vec3f place, rest;      ///< [m] now, and as drawn: patterns go with that
  float reach = 0;        ///< of its bell [m]
  std::uint8_t burn = 0;  ///< Paint::burn
};

class FatSurface {
 public:
  /// @param cell  of the grid [m]
  explicit FatSurface(float cell) : m_cell(cell) {}

  /// Appends it. Lobules that are far from all others are not drawn once the grid would be too large.
  void draw(std::span<const DrawnLobule> lobules, MeshBuffer& to);

 private:
  struct Node {
    float sum = 0;         ///< of bells
    Vec3f moved{0, 0, 0};  ///< sum of bells times how far lobules are from where they were drawn
    float burn = 0;        ///< sum of bells times burns
  };
  bool lay_grid(std::span<const DrawnLobule> lobules);
  void add(const DrawnLobule& lobule);
  std::size_t at(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(m_size[1]) + std::size_t(j)) * std::size_t(m_size[0]) + std::size_t(i);
  }
  void place_vertices(MeshBuffer& to);
  void place_vertex(int i, int j, int k, MeshBuffer& to);
  void join(MeshBuffer& to);
  void join_across(int i, int j, int k, int axis, MeshBuffer& to);

  float m_cell;
  Vec3f m_low{0, 0, 0};
  int m_size[3] = {0, 0, 0};
  std::vector<Node> m_nodes;
  std::vector<std::uint32_t> m_vertex;  ///< (nodes) of the cube whose lowest corner it is
};

}  // namespace trocar::view
