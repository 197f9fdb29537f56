// What keeps soft tissue's volume: a pressure that answers its change, on top of the springs.
//
// Springs alone have a Poisson's ratio of 1/4, and tissue, mostly water, nearly 1/2. Each node has the volume of a
// quarter of the cells around it; a change of it by the factor J gives it the pressure kappa (J - 1); a cell has its
// corners' mean pressure and pushes on them with -p dV/dx. Pressures belong to nodes because there are few of them:
// with one for every cell tetrahedra lock, and bend too stiffly [Bonet & Burton 1998]. The sum of the forces is zero,
// and so is their moment. Taken as impulses once or a few times a tick, as the pressure is a smooth field.
//
//   E and nu of the whole: the springs get E / 0.8 (1 + nu), which is all of the shear; kappa is the rest of the bulk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/tissue/guard.hpp>

namespace trocar::tissue {

inline constexpr double kMostPoisson = 0.45;  ///< beyond it impulses would have to be too many

/// How a material of E and nu is shared out between springs (nu = 1/4 by themselves) and pressure.
struct BulkShare {
  double spring_modulus = 0;  ///< E of the springs [Pa]
  double kappa = 0;           ///< [Pa]
};
/// @param poisson  1/4 to kMostPoisson
constexpr BulkShare bulk_share(double youngs_modulus, double poisson) noexcept {
  const double springs = youngs_modulus / (0.8 * (1 + poisson));
  return {springs, youngs_modulus / (3 * (1 - 2 * poisson)) - springs / 1.5};
}

struct VolumeWork {
  std::vector<float> drawn;     ///< (rows) volume of a node as drawn [m^3]
  std::vector<float> pressure;  ///< (rows) first the volume, then kappa (J - 1) [Pa]
  std::vector<Vec3f> force;     ///< (rows) [N]
  void resize(std::size_t rows);
};

/// Notes each node's volume as drawn.
void note_volumes(std::span<const TetRest> cells, VolumeWork& work) noexcept;

/// One impulse of `dt` [s] to nodes that are free.
/// @param cells   drawn, upright  @param phase  (cells) kGone: left out
/// @param weight  of the sub-step `weight_dt`, as the kernel has it
void push_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, double kappa, double dt,
                  std::span<const RowPack> weight, double weight_dt, std::span<NodeState> nodes,
                  VolumeWork& work) noexcept;

/// Number of impulses in a tick that a body bears: from the fastest of its oscillations, found by iteration.
/// @param mass  (rows) [kg], 0: no node; held nodes count as free, which is on the safe side
int impulses_for(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
                 double kappa, double tick);

}  // namespace trocar::tissue
