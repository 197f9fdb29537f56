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

/// A body's cells as the kernels read them (network_layout.hpp): follows from the cells and the rows' weights alone.
struct VolumeCells {
  int slices = 0;                   ///< in use
  std::vector<CornerPack> corners;  ///< (cells in whole packs)
  std::vector<float> rest6;         ///< (the same) [m^3]
  std::vector<CellPack> around;     ///< capacity: columns
  std::vector<int> begin;           ///< (slices + 1) of `around`
  std::vector<int> last_pack;       ///< (slices) as in VolumeArgs
  std::vector<int> last_slice;      ///< (packs) the same
  std::vector<int> cell;            ///< (whole packs) which it is, -1: none: cells lie in the order of their rows
  std::vector<int> place;           ///< (cells) where it is
  std::vector<int> count;           ///< (rows) cells at a node
  std::vector<float> drawn;         ///< (rows) volume of a node in the drawn shape [m^3]
  std::vector<float> kappa;         ///< (rows) 0: it does not press [Pa]
  std::vector<Quad> weight;         ///< (rows) as RowPack; w: 1/m [1/kg]
  /// @param columns  how many packs of cells all slices together have at most: columns_of() of the body as built, and
  ///                 as many as the widest slice has for every spare one
  void resize(std::size_t of_cells, std::size_t rows, std::size_t columns);

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("slices", s.slices), v("corners", s.corners), v("rest6", s.rest6), v("around", s.around), v("begin", s.begin),
        v("last_pack", s.last_pack), v("last_slice", s.last_slice), v("cell", s.cell), v("place", s.place),
        v("count", s.count), v("drawn", s.drawn), v("kappa", s.kappa), v("weight", s.weight);
  }
};

struct ColumnCount {
  std::size_t all = 0, widest = 0;
};
ColumnCount columns_of(std::span<const TetRest> cells, std::size_t rows);

/// Scratch.
struct VolumeWork {
  std::vector<Quad> places;        ///< (rows)
  std::vector<ForcePack> answers;  ///< (1 + packs of cells)
  std::vector<ForcePack> forces;   ///< (1 + 4 packs)
  std::vector<CellBounds> bounds;  ///< (packs)
  std::vector<float> node_answer;  ///< (rows) as Bulk::most_answer, after an impulse
  void resize(std::size_t cells, std::size_t rows);

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("places", s.places), v("answers", s.answers), v("forces", s.forces), v("bounds", s.bounds),
        v("node_answer", s.node_answer);
  }
};

/// Makes the kernels' arrays. @param weight  of the slices in use, for the sub-step `weight_dt` [s]
void note_volumes(std::span<const TetRest> cells, const Bulk& bulk, std::span<const RowPack> weight, double weight_dt,
                  VolumeCells& noted) noexcept;

/// One impulse of `dt` [s] to nodes that are free.
/// @param noted  for cells that are upright in the drawn shape  @param phase  (cells) kGone: left out; or empty
void push_volumes(const VolumeCells& noted, std::span<const std::uint8_t> phase, const Bulk& bulk, double dt,
                  double weight_dt, std::span<NodeState> nodes, VolumeWork& work) noexcept;

/// How many impulses a body wants: by the fastest of its oscillations, found by iteration.
/// @param mass  (rows) [kg], 0: no node; held nodes count as free, which is on the safe side
Bulk bulk_of(std::span<const TetRest> cells, std::span<const NodeState> rest, std::span<const double> mass,
             double kappa, double tick);

}  // namespace trocar::tissue
