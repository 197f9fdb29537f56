// A skin carried by a lattice: every point follows the eight nodes of its cell, x = W q. Points outside all cells
// follow the nearest one, continued trilinearly, so that every affine motion of the nodes is reproduced exactly.
//
//   const Embedding skin = embed(lattice, mesh.positions);
//   interpolate<float>(skin, node_positions, skin_positions);     // each tick
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/geometry/volumes/lattice.hpp>

namespace trocar::geometry {

struct Embedding {
  std::vector<std::array<int, 8>> nodes;       ///< per point
  std::vector<std::array<double, 8>> weights;  ///< sum 1; below 0 or above 1 only where extrapolated
  std::vector<int> cells;                      ///< the cell of each point
  double farthest = 0.0;                       ///< largest distance of a point from its cell [m]
};

/// @param along  how far along the body each point is [m], where the lattice tells loops apart by that: a point follows
///               a cell of its own loop, however near another one is. Empty: the nearest of all
/// Throws std::invalid_argument for a lattice without cells, and where no cell is near enough along the body.
Embedding embed(const Lattice& lattice, std::span<const Vec3d> points, std::span<const double> along = {});

/// The points for the nodes' present positions (or velocities, displacements ...), summed in the nodes' order.
template <class T>
void interpolate(const Embedding& embedding, std::span<const Vec3<T>> nodes, std::span<Vec3<T>> points) noexcept {
  for (std::size_t i = 0; i < embedding.nodes.size(); ++i) {
    Vec3<T> sum{};
    for (int k = 0; k < 8; ++k) sum += T(embedding.weights[i][k]) * nodes[embedding.nodes[i][k]];
    points[i] = sum;
  }
}

}  // namespace trocar::geometry
