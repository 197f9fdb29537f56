// The pieces of a surface that hang together by edges, and what each of them is.
//
//   const Shells shells = shells_of(mesh, edges, rims_of(mesh, edges));
//   for (const Shell& shell : shells.list) ...          // by the number of their first triangle
#pragma once

#include <vector>

#include <trocar/geometry/repair/rims.hpp>

namespace trocar::geometry {

struct Shell {
  int first = 0;  ///< triangle, the lowest number
  int triangles = 0;
  double area = 0;    ///< [m^2]
  double volume = 0;  ///< [m^3] enclosed, negative where it faces inwards; holes as if closed by fans
  double caps = 0;    ///< [m^2] the area of these fans
  int open_edges = 0;
  int crowded_edges = 0;  ///< with more than two triangles
  int turned_edges = 0;   ///< whose two triangles do not face the same way
  Bounds box;
  /// It faces inwards, inside of another shell: the wall of a cavity.
  bool is_cavity = false;

  /// It encloses less than a hundredth of what it could.
  bool is_sheet() const;
  bool closed() const { return open_edges == 0 && crowded_edges == 0 && turned_edges == 0; }
};

struct Shells {
  std::vector<Shell> list;
  std::vector<int> of;  ///< the shell of each triangle; -1 of one with a corner twice
};
/// @param rims  those of the mesh
Shells shells_of(const TriMesh& mesh, const EdgeTable& edges, const std::vector<Rim>& rims);

/// How often the surface goes around a place: 1 inside a closed one that faces outwards, in between where it has holes.
/// From solid angles [van Oosterom & Strackee 1983].
/// @param except  the shell whose triangles do not count, or -1
double turns_around(const TriMesh& mesh, const Shells& shells, Vec3d place, int except);
/// The same of all triangles but one.
double turns_without(const TriMesh& mesh, int triangle, Vec3d place);

}  // namespace trocar::geometry
