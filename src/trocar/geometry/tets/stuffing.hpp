// Tetrahedra that fill a shape: isosurface stuffing [Labelle & Shewchuk 2007]. A body-centred cubic lattice covers the
// shape; its points near the surface move onto it, and the cells that the surface still crosses are cut by one of a few
// patterns. Cells inside are all alike, and those at a smooth surface well shaped (on organs, dihedral angles of 12
// to 156 degrees): so a body of these keeps a long time step.
//
//   const TetMesh body = stuffed(closed_mesh, 0.003);                  // cubes of 3 mm
//   const TetMesh liver = stuffed(volume, 5, 0.006);                   // voxels with the label 5
//   const StuffingReport report = compare(body, field_of(closed_mesh));
//
// Cells are upright; nodes follow a Morton curve, and cells the lowest of their nodes. A cube of the lattice holds 12
// cells. The surface is closed, with two triangles at every edge: cells that would meet others in an edge or a node
// only are left out. Features thinner than about one and a half cubes are lost or fall apart, sharp edges are cut off
// by up to about half a cube: compare() tells. The same bits from every compiler.
#pragma once

#include <trocar/geometry/tets/tet_mesh.hpp>
#include <trocar/geometry/volumes/field.hpp>

namespace trocar::geometry {

struct StuffingOptions {
  int most_cells = 200'000;
  /// Points closer to the surface than this share of an edge move onto it: of edges within either grid of the lattice
  /// and of those between them. The defaults are the paper's for the largest least angle.
  double snap_long = 0.24999, snap_short = 0.41189;
  /// Only the largest group of cells that hang together by faces; otherwise all.
  bool largest_part = false;
};
/// The paper's bounds for the default snaps [degrees]. In our form they do not hold where the shape is as fine as the
/// lattice: neighbouring points may then snap towards each other, which leaves 9.3 degrees at worst of what we found.
inline constexpr double kStuffedLeastDihedral = 10.78, kStuffedMostDihedral = 164.75;

/// @param cell  edge of the lattice's cubes [m]
/// Throws std::invalid_argument for a cell that is not above 0, a lattice of more than 4 most_cells cubes, more than
/// most_cells cells, or no cell at all (the shape is finer than the lattice).
TetMesh stuffed(const Field& field, double cell, const StuffingOptions& options = {});
/// field_of(closed), stuffed; its faults as well.
TetMesh stuffed(const TriMesh& closed, double cell, const StuffingOptions& options = {});
/// field_of_label(voxels, label), stuffed; its faults as well.
TetMesh stuffed(const Voxels& voxels, int label, double cell, const StuffingOptions& options = {});

struct StuffingReport {
  int nodes = 0, cells = 0, parts = 0;
  int odd_edges = 0;                             ///< of the surface, where not exactly two triangles meet: none
  double least_dihedral = 0, most_dihedral = 0;  ///< [degrees]
  double volume = 0;
  double nodes_off = 0;    ///< farthest of the surface's nodes from the field's surface [m]
  double surface_off = 0;  ///< the same of its edges' and triangles' middles
};
/// Distances are the field's values: exact for meshes; the fields of labels are level further than about a voxel from
/// their surface, and those of thresholds have the voxels' unit.
StuffingReport compare(const TetMesh& body, const Field& field);
/// The same for the volumes, and how far the shape's vertices are from the body's surface.
struct ShapeReport : StuffingReport {
  double shape_volume = 0;
  double shape_off = 0;  ///< farthest vertex of the shape from the body's surface [m]
};
ShapeReport compare(const TetMesh& body, const TriMesh& closed);

}  // namespace trocar::geometry
