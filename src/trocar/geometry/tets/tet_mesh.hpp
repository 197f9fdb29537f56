// Tetrahedral meshes as plain arrays: what is wrong with one, what can be mended, and its surface.
//
//   TetMesh mesh = read_tets(bytes, "liver.msh", 0.01).mesh;   // geometry/formats/tet_files.hpp
//   const TetRepair good = repair(mesh);
//   for (const Mended& m : good.mended) say(in_words(m));      // "2 inverted cells turned"
//   const TetSurface skin = surface_of(good.mesh);
//
// Meshes come from other programs, with their habits: cells numbered left-handed, nodes repeated along seams, nodes of
// triangles that no cell uses. repair() mends what has one answer only; what has several (parts that do not hang
// together, cells that meet in an edge or a corner only) is counted in TetFacts and left as it is.
//
// Corners name nodes that are there and coordinates are finite: the readers see to that. A cell (a, b, c, d) is upright
// where d lies on the side of (a, b, c) from which these run counter-clockwise. Lengths in metres.
// The same bits from every compiler: order follows the numbers of nodes and cells.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct TetMesh {
  std::vector<Vec3d> points;
  std::vector<std::array<int, 4>> cells;
  std::vector<int> region;  ///< one number a cell, as the file gave it; or none
};

/// Cells' nodes nearer to each other than this share of their box's diagonal are one node. Single precision keeps 1e-7
/// of the coordinates; our choice leaves room for the rounding of a few operations.
inline constexpr double kMergeTolerance = 1e-6;
/// A cell is flat where its volume is below this share of the cubed diagonal of the mesh's box ...
inline constexpr double kFlatOfBox = 1e-12;
/// ... or below this share of its own longest edge cubed (regular: 0.118).
inline constexpr double kFlatOfEdge = 1e-7;

struct TetFacts {
  int nodes = 0, cells = 0;
  Bounds box;                    ///< of the nodes that cells have; low > high where there are none
  double volume = 0;             ///< sum over cells, none counted negative
  double smallest_volume = 0;    ///< of a cell that is not flat; 0 where there is none
  double largest_volume = 0;     ///< of a cell
  double smallest_dihedral = 0;  ///< degrees, of cells that are not flat; 0 where there is none
  int inverted = 0;              ///< cells with a negative volume that are not flat
  int flat = 0;                  ///< cells without volume (kFlatOfBox, kFlatOfEdge), or with a corner twice
  int duplicate_cells = 0;       ///< cells with the corners of an earlier one
  int duplicate_nodes = 0;       ///< of the nodes that cells have, those at the place of an earlier one
  int unused_nodes = 0;          ///< nodes that no cell has
  int parts = 0;                 ///< groups of cells that hang together by faces
  int crowded_faces = 0;         ///< faces of more than two cells
  int overlapping_faces = 0;     ///< faces with two cells on the same side: these overlap
  int surface_triangles = 0;     ///< faces of one cell
  int odd_edges = 0;             ///< edges of these triangles that not exactly two of them share

  /// Nothing is left that repair() would mend.
  bool sound() const {
    return inverted + flat + duplicate_cells + duplicate_nodes + unused_nodes + overlapping_faces == 0;
  }
};
/// @param tolerance  share of the box's diagonal within which nodes are the same
TetFacts inspect(const TetMesh& mesh, double tolerance = kMergeTolerance);

/// What repair() can do, in the order in which it does it.
enum class Mending : unsigned char {
  merged_nodes,
  dropped_flat,
  dropped_duplicates,
  turned,
  dropped_overlapping,
  dropped_nodes,
};
struct Mended {
  Mending what;
  int count;
};
/// "14 duplicate nodes merged"
std::string in_words(const Mended& mended);

struct TetRepair {
  TetMesh mesh;
  std::vector<Mended> mended;  ///< only what was needed
};
/// Duplicate nodes become the first of them; flat cells, duplicate cells, and cells that overlap an earlier neighbour
/// are left out; inverted cells are turned; nodes without a cell are left out. The order of what stays does not change.
/// Where a flat cell was, its neighbours no longer share a face: the surface has a crack of no width there.
/// What comes out is sound(), with the same tolerance.
TetRepair repair(const TetMesh& mesh, double tolerance = kMergeTolerance);

/// What repair() left as it is, because there is more than one way to mend it, in words. Also looks for cells that lie
/// in each other (tet_overlap.hpp).
std::vector<std::string> left_as_is(const TetMesh& mended);

struct TetSurface {
  TriMesh mesh;           ///< facing outwards, also where cells are inverted
  std::vector<int> node;  ///< of each vertex of the mesh, ascending
};
/// The faces of exactly one cell, in the order of cells.
TetSurface surface_of(const TetMesh& mesh);

/// Volume of a cell, negative where it is inverted.
double volume(const TetMesh& mesh, int cell);
double volume(const TetMesh& mesh);  ///< of all cells, inverted ones taken off [m^3]

}  // namespace trocar::geometry
