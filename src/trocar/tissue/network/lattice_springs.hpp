// From a cubic lattice of partly filled cells to a spring network of given stiffness.
//
// Edges and face diagonals of the cells, all k = 0.4 E l, make a block of Young's modulus E and Poisson's ratio 1/4
// exactly. Each cell brings its share: a quarter of k for an axial edge (four cells meet there), half of k for a face
// diagonal (two cells meet), both times the cell's fill; so surfaces are weighted right without being looked for.
// Mass is rho V fill, an eighth to each corner.
//
// Along fibres f all of a cell's springs are S(r)/S(1) (1 + a (n f)^2) times as stiff (spring_medium.hpp), n their
// direction. The nine directions of a lattice have no isotropic sixth moments, so that the ratio r of moduli along and
// across is met about: within 14 % for r = 1.5, within 25 % for r = 2, most above it where f is a face's diagonal, most
// below along an axis; E across is within 22 % of what is asked (tests pull blocks).
//
// Source: the mapping k = E sum V / l^2 of [Van Gelder 98] specialised to this lattice (our derivation; tests measure
// E and nu). Central springs force nu = 1/4: incompressibility is not there.
//
//   LatticeNetwork tissue = lattice_network(corner_positions, cells, fill, {.youngs_modulus = 30e3, .density = 1050});
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

struct LatticeMaterial {
  double youngs_modulus = 0;  ///< E, across the fibres where there are any [Pa]
  double density = 0;         ///< rho [kg/m^3]
  double p1 = 0, p2 = 0;      ///< shape factors of [KCM99 eq.5]
  double cap = 1;             ///< strain beyond which the law is linear
  double damping_time = 0;    ///< spring damping d = damping_time * k [s]; for a mode of angular frequency w this gives
                              ///< the damping ratio damping_time * w / 2
  double min_fill = 0.05;     ///< smaller fills are lifted to this, so that no node is nearly massless
  double fibre_ratio = 1;     ///< E along the fibres over E across, about: see above
  Vec3d fibre{0, 0, 0};       ///< their direction, unless each cell has its own; zero: none
};

struct LatticeNetwork {
  NetworkDescription network;    ///< nodes in the order given
  std::vector<int> cell_of_tet;  ///< (tets)
};

/// @param corners  corner positions [m], all used by at least one cell
/// @param cells    eight corners each, corner number = x + 2 y + 4 z of the cell's unit cube
/// @param fill     share of each cell that is tissue, (0, 1]; empty = all full
/// @param fibres   per cell, any length (zero: none there); empty: material.fibre everywhere
/// The lattice may be deformed (rest lengths are taken from the positions), E then holds approximately.
LatticeNetwork lattice_network(std::span<const Vec3d> corners, std::span<const std::array<int, 8>> cells,
                               std::span<const double> fill, const LatticeMaterial& material,
                               std::span<const Vec3d> fibres = {});

/// The corners and cells of a full box of nx x ny x nz cells, x fastest.
struct BoxLattice {
  std::vector<Vec3d> corners;
  std::vector<std::array<int, 8>> cells;
  int nx = 0, ny = 0, nz = 0;
  int corner(int i, int j, int k) const { return i + (nx + 1) * (j + (ny + 1) * k); }
};
BoxLattice box_lattice(int nx, int ny, int nz, double spacing, Vec3d lowest = {0, 0, 0});

}  // namespace trocar::tissue
