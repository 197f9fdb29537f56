// Surfaces that touch in an edge or in a vertex come apart: each gets vertices of its own at the same places, so that
// every edge has two triangles or one, and every vertex one fan of them.
//
//   const TriMesh manifold = parted(mesh).mesh;
//
// At an edge of more than two triangles those belong together that enclose something: they face each other across the
// inside, so bodies that touch become two. Where directions do not tell, neighbours around the edge are paired, which
// never makes surfaces cross; of an odd number the one that fits worst is left with a border.
#pragma once

#include <array>
#include <vector>

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

Repaired parted(const TriMesh& mesh);

/// The same, and along these edges, too, each as (lower, higher) vertex, sorted.
Repaired parted_along(const TriMesh& mesh, const std::vector<std::array<int, 2>>& edges);

}  // namespace trocar::geometry
