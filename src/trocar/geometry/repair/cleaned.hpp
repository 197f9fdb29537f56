// The simple repairs: what can be left out or put together without a choice. Each gives another mesh; the order of what
// stays does not change.
//
//   TriMesh mesh = without_broken(file_mesh).mesh;
//   mesh = welded(mesh, 1e-6).mesh;                         // 1 um
//   mesh = without_duplicates(mesh).mesh;
#pragma once

#include <trocar/geometry/repair/repaired.hpp>

namespace trocar::geometry {

/// Without triangles that have a corner whose place is no number, and without such vertices.
Repaired without_broken(const TriMesh& mesh);

/// Vertices within `distance` [m] of an earlier one become that. What stays is further apart: a chain of near vertices
/// does not become one. Triangles that have lost an edge by that are left out.
Repaired welded(const TriMesh& mesh, double distance);
/// The same for vertices on borders only, and no further than a fifth of their shortest border edge: closes cracks.
Repaired with_borders_welded(const TriMesh& mesh, double distance);

/// Of triangles with the same three corners one that faces as most of them do; none where as many face either way, as
/// they enclose nothing. A sheet that has two faces everywhere keeps one of them.
Repaired without_duplicates(const TriMesh& mesh);

/// Without vertices that no triangle has.
Repaired without_unused(const TriMesh& mesh);

/// Without shells whose area is less than this share of the largest one's.
/// @param open_only  closed ones stay
Repaired without_small_shells(const TriMesh& mesh, double share, bool open_only = false);

}  // namespace trocar::geometry
