// A closed NURBS body whose masses are its control points: the cage of cells that they, copies of them half-way to the
// middle line and that line make, and a spring network on it. The surface stays that NURBS whatever the nodes do, x = W
// q (geometry/nurbs/weights.hpp), because W knows the control points only; the nodes inside carry what is below it.
//
//   const ControlCage cage = control_cage(surface);
//   const TetNetwork body = cage_network(cage, material, volume, centre);
//
// The cage is larger than the body. Springs lie along its edges and across its inner faces and are fitted to the
// tissue as those of any tetrahedra (tet_springs.hpp), with E times the body's volume over the cage's, and then
// balanced, so that the whole of them resists uniform strains as the body's tissue does: as every affine motion of the
// control points is one of the surface, that is what the surface feels. Masses are the cells' shares for the most part;
// 0.2 of all goes to where springs are stiff and short, as at the poles, which would set the time step alone. They are
// tilted so that their sum is density times the body's volume and their centre is the body's: m (a + b.(x - c)), the
// change that is least in sum of squares over m. Cells that lie in each other, as where rings are concave, have springs
// as the others do, but nothing guards them against being turned over. (Our choice.)
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <trocar/geometry/nurbs/closure.hpp>
#include <trocar/tissue/tets/tet_springs.hpp>

namespace trocar::tissue {

struct ControlCage {
  std::vector<Vec3d> points;              ///< [m] first the surface's nodes, then those inside
  std::vector<std::array<int, 4>> cells;  ///< of positive volume, folded ones turned
  std::vector<std::uint8_t> folded;       ///< (cells) 1: it lies in others, as rings are concave there
  double folded_volume = 0;               ///< of these [m^3]
  geometry::nurbs::Nodes nodes;           ///< of the surface's control points
  double volume = 0;                      ///< of all cells [m^3]
};

/// @param surface  closed around in u (periodic), a pole at both ends of v, du x dv outwards, at least 4 rows
/// @param inner    how far out the copies are, 0 .. 1: 0 on the line, 1 at the control points
/// @throws std::invalid_argument, also where more than a fifth of the cage is folded: rings that cross, or do not go
/// around the middle of their points
ControlCage control_cage(const geometry::nurbs::Surface& surface, double inner = 0.5);

/// @param volume, centre  of the body itself [m^3], [m]
/// @throws std::invalid_argument, also where no masses above 0 have that centre
TetNetwork cage_network(const ControlCage& cage, const TetMaterial& material, double volume, Vec3d centre);

}  // namespace trocar::tissue
