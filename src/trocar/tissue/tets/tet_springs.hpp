// From tetrahedra to a spring network of given stiffness, isotropic or with fibres.
//
// Springs lie along the edges of the cells and, unless one does without, across their inner faces: from corner to
// opposite corner of the two cells that share a face. What is asked of them is the patch test: under any uniform strain
// every node must feel from its springs what it would feel from the continuous medium that they stand for
// (spring_medium), which is nothing inside the body and the stress's force on its surface. On a general mesh edges
// alone cannot do that [Van Gelder 98]: cut into six tetrahedra a cube, a block of them has a Poisson's ratio of 0.03.
// With the springs across faces there are nearly as many stiffnesses as conditions, and a least-squares fit from k = E
// sum V / l^2 [Van Gelder 98] leaves a small misfit, which is reported. (The springs across faces and the fit are our
// choice; tests measure E and nu of blocks.)
//
//   const TetNetwork t = tet_network(mesh.points, mesh.cells, {.youngs_modulus = 5.4e3, .density = 1060});
#pragma once

#include <array>
#include <span>
#include <vector>

#include <trocar/tissue/network/network.hpp>

namespace trocar::tissue {

struct TetMaterial {
  double youngs_modulus = 0;  ///< E, across the fibres where there are any [Pa]
  double poisson = 0.25;      ///< nu; above 1/4 the springs leave the rest to a volume force (volume_force.hpp)
  double density = 0;         ///< rho [kg/m^3]
  double p1 = 0, p2 = 0;      ///< shape factors of [KCM99 eq.5]
  double cap = 1;             ///< strain beyond which the law is linear
  double damping_time = 0;    ///< spring damping d = damping_time * k [s]
  double fibre_ratio = 1;     ///< E along the fibres over E across
  Vec3d fibre{0, 0, 0};       ///< their direction, unless each cell has its own; zero: none
  bool across_faces = true;   ///< false: edges only, cheaper and cruder
  int sweeps = 100;           ///< of the fit; 0: the start as it is
};

struct TetNetwork {
  NetworkDescription network;  ///< nodes and cells in the order given; springs along edges first
  int edge_springs = 0;
  std::vector<std::array<int, 2>> cells_of_cross_spring;  ///< the two cells whose shared face it goes through
  double misfit_start = 0;  ///< rms force that nodes feel wrongly over the rms force on them from the medium: as
  double misfit = 0;        ///< started, and as fitted
};

/// @param points  [m], each used by a cell
/// @param cells   four points each, positive volume
/// @param fibres  per cell, any length (zero: none there); empty: material.fibre everywhere
/// Masses are rho V / 4 to each corner. @throws std::invalid_argument
TetNetwork tet_network(std::span<const Vec3d> points, std::span<const std::array<int, 4>> cells,
                       const TetMaterial& material, std::span<const Vec3d> fibres = {});

}  // namespace trocar::tissue
