// Harmonic values on a mesh: each free vertex has the weighted mean of its neighbours' values.
//
//   EdgeWeights w = cotangent_weights(mesh);
//   std::vector<double> value = ...;                                // of the held vertices; the rest is found
//   relax(w, held, value);
//
// Weights are half the cotangents of the two angles that face an edge, at least kLeastWeight, so that no value lies
// beyond its neighbours'. [Pinkall & Polthier 1993, Computing discrete minimal surfaces and their conjugates]
#pragma once

#include <cstdint>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>

namespace trocar::geometry::nurbs {

inline constexpr double kLeastWeight = 0.05;

struct EdgeWeights {
  Csr neighbours;
  std::vector<double> weight;  ///< as neighbours.items
};
EdgeWeights cotangent_weights(const TriMesh& mesh);

/// Finds the values of all vertices that are not held. @param step added to what a vertex sees of a neighbour, as
/// neighbours.items; of the two that see each other, one sees it added and the other taken away. Empty: none.
/// @throws std::runtime_error if the equations cannot be solved
void relax(const EdgeWeights& weights, const std::vector<std::uint8_t>& held, std::vector<double>& value,
           const std::vector<double>& step = {});

}  // namespace trocar::geometry::nurbs
