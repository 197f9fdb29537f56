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

#include <trocar/core/fields.hpp>
#include <trocar/tissue/network/guard.hpp>

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

/// Of a body. Const.
struct Bulk {
  double kappa = 0;          ///< [Pa]; 0: no volume force
  float most_answer = 0;     ///< of the nodes as built: 36 sum |dV/dx|^2 / (m V) [m/kg]; far stiffer ones are softened
  int impulses = 0;          ///< in a tick
  std::vector<float> built;  ///< (rows) volumes of nodes as built [m^3]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kappa", s.kappa), v("most_answer", s.most_answer), v("impulses", s.impulses), v("built", s.built);
  }
};

struct alignas(16) VolumeForce {
  float x = 0, y = 0, z = 0, zero = 0;  ///< [N]
};

struct VolumeWork {
  std::vector<float> drawn, volume;  ///< (rows) of a node, as drawn and now [m^3]
  std::vector<float> answer;         ///< (rows) as Bulk::most_answer
  std::vector<float> inverse_mass;   ///< (rows) [1/kg], 0: held
  std::vector<float> pressure;       ///< (rows) kappa (J - 1) [Pa]
  std::vector<VolumeForce> force;    ///< (rows)
  void resize(std::size_t rows);

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("drawn", s.drawn), v("volume", s.volume), v("answer", s.answer), v("inverse_mass", s.inverse_mass),
        v("pressure", s.pressure), v("force", s.force);
  }
};

/// Notes what the drawn body says. @param weight  of the sub-step `weight_dt` [s], as the kernel has it
void note_volumes(std::span<const TetRest> cells, std::span<const RowPack> weight, double weight_dt,
                  VolumeWork& work) noexcept;

/// One impulse of `dt` [s] to nodes that are free.
/// @param cells   drawn, upright  @param phase  (cells) kGone: left out; or empty
void push_volumes(std::span<const TetRest> cells, std::span<const std::uint8_t> phase, const Bulk& bulk, double dt,
                  std::span<const RowPack> weight, double weight_dt, std::span<NodeState> nodes,
                  VolumeWork& work) noexcept;

/// How many impulses a body wants: by the fastest of its oscillations, found by iteration.
/// @param mass  (rows) [kg], 0: no node; held nodes count as free, which is on the safe side
Bulk bulk_of(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
             double kappa, double tick);

}  // namespace trocar::tissue
