// A cubic lattice that fills a closed surface: the mechanical nodes of a VOLUME body. Cells that are mostly outside
// are left away; the surface is carried by the cells around it (embed.hpp).
//
// A long body that lies in loops comes near itself, nearer than a cell. Anyone who says how far along the body each
// vertex of the mesh is gets cells and nodes of their own for each loop, in the same place where two loops share it.
//
//   const Lattice lattice = make_lattice(mesh, 0.004);
//   for (std::size_t c = 0; c < lattice.cells.size(); ++c) mass += density * lattice.cell_fill[c] * cell_volume;
#pragma once

#include <array>
#include <limits>
#include <span>
#include <vector>

#include <trocar/geometry/surfaces/tri_mesh.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct Lattice {
  double cell = 0.0;                       ///< edge of a cell [m]
  Vec3d origin;                            ///< corner of the place (0, 0, 0)
  Mat3d frame = Mat3d::identity();         ///< columns: the lattice's axes, orthonormal
  std::array<int, 3> dims{};               ///< places for cells along the axes
  std::vector<Vec3d> nodes;                ///< those that a cell uses; along the first axis fastest, the third slowest
  std::vector<std::array<int, 8>> cells;   ///< nodes; corner k is at the offset (k & 1, k >> 1 & 1, k >> 2 & 1)
  std::vector<double> cell_fill;           ///< share of each cell that is inside the surface, 0 .. 1
  std::vector<std::array<int, 3>> places;  ///< of each cell; the cells follow the same order as the nodes
  std::vector<int> cell_at;                ///< for every place its cell or -1
  /// Of a body in loops that come near each other, where the mesh says how far along each vertex is; else empty.
  std::vector<double> cell_along;  ///< how far along the body each cell is [m]
  std::vector<int> other_at;       ///< the next cell at the same place, of another loop, or -1
  double apart = kNoMatterHowFar;  ///< what is further apart along the body does not hang together [m]
  static constexpr double kNoMatterHowFar = std::numeric_limits<double>::infinity();

  /// The cell at a place, the first of them where loops share it; -1 where there is none or the place is outside.
  int cell_of(int i, int j, int k) const noexcept {
    if (i < 0 || j < 0 || k < 0 || i >= dims[0] || j >= dims[1] || k >= dims[2]) return -1;
    return cell_at[i + dims[0] * (j + dims[1] * k)];
  }
  /// Of a cell the next one at its place, -1 after the last.
  int other_of(int c) const noexcept { return other_at.empty() ? -1 : other_at[c]; }
  /// A point in units of cells along the lattice's axes; the place of its cell is the floor of it.
  Vec3d in_cells(Vec3d p) const noexcept { return transposed(frame) * (p - origin) / cell; }
};

struct LatticeOptions {
  double least_fill = 0.05;                 ///< cells with no more than this inside are left away
  int samples = 4;                          ///< points along each axis of a cell at which inside or outside is asked
  Mat3d frame = Mat3d::identity();          ///< the lattice's axes
  std::span<const double> along;            ///< how far along the body each vertex of the mesh is [m], or empty
  double apart = Lattice::kNoMatterHowFar;  ///< parts whose ways along the body differ by more do not hang together [m]
};

/// The lattice, centred on the mesh's box along the axes. The mesh must be closed and face outwards; where it overlaps
/// itself, whatever is inside at least once counts as inside. Throws std::invalid_argument for an open mesh, a cell
/// that is not above 0, `along` of another number than vertices, or too many places (8 million) or rays (16 million,
/// samples^2 a column) for the mesh's box.
Lattice make_lattice(const TriMesh& closed, double cell, const LatticeOptions& options = {});

/// How many groups of cells hang together by faces whose nodes they share; above 1 the body falls apart (or hangs by an
/// edge): refine.
int pieces(const Lattice& lattice);

}  // namespace trocar::geometry
