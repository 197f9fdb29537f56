// Cutting a body of tetrahedra along a blade's swept face. Nodes next to the blade snap to it where the cells around
// them stay well shaped, then the body parts along the faces of its cells: nodes are doubled, cells are neither made
// nor divided. So nothing gets smaller with every cut, the time step hardly suffers, and volume and mass stay what they
// were but for what a snap moves at the surface, which is booked.
//
//   CuttableTets body = cuttable(points, cells, spare_nodes);
//   CutWork work = make_work(body);
//   CutResult book = cut(body, blade, now, work);     // now: where the nodes are, at the moment of the cut
//
// cut() takes no memory and throws nothing; the same body, blade and positions give the same bits.
// Source: snapping and splitting as in [Nienhuys & van der Stappen 2001]; which cells part and how fans of cells keep
// or share a node is our choice.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/geometry/tets/blade.hpp>
#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

using Tet = std::array<std::int32_t, 4>;

/// The part of a body that a cut changes. Faces are numbered by the corner that they lie opposite to.
struct CuttableTets {
  std::vector<Vec3d> rest;           ///< (capacity) drawn positions [m]
  std::vector<std::int32_t> source;  ///< (capacity) the node that a doubled node was made from; itself at first
  std::int32_t nodes = 0;            ///< how many of the capacity are there
  std::vector<Tet> cells;            ///< corners, positive volume
  std::vector<Tet> across;           ///< cell beyond each face, or -1

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("rest", s.rest), v("source", s.source), v("nodes", s.nodes), v("cells", s.cells), v("across", s.across);
  }
};

/// Throws std::invalid_argument for corners that do not exist, cells without positive volume, or a face of more than
/// two cells.
CuttableTets cuttable(std::span<const Vec3d> points, std::span<const Tet> cells, int spare_nodes);

inline constexpr double kLeastDihedral = 10;  ///< no snap makes a smaller angle [degrees]

struct CutResult {
  int snapped = 0, refused = 0;  ///< nodes that moved to the blade; that should have and stayed
  int parted = 0;                ///< faces
  int doubled = 0;               ///< nodes that were made
  bool full = false;             ///< the spare nodes were used up: some faces stay joined at nodes
  double volume = 0;             ///< change of the body's drawn volume, from snaps along its surface [m^3]
  std::int32_t first_new = 0;    ///< nodes from here on are new; each is a double of source[]
};

/// Scratch.
struct CutWork {
  std::vector<double> height;                  ///< (capacity) over the blade's plane [m]
  std::vector<std::uint8_t> at_blade;          ///< (capacity)
  std::vector<double> nearest;                 ///< (capacity) shortest way to the blade along an edge [m]
  std::vector<std::int32_t> towards;           ///< (capacity) the other end of that edge
  std::vector<Vec3d> target_rest, target_now;  ///< (capacity) where on that edge, drawn and now [m]
  std::vector<std::int8_t> side;               ///< (cells) -1, 0 neither, 1
  std::vector<std::int32_t> begin;             ///< (capacity + 1) of the cells at each node
  std::vector<std::int32_t> around;            ///< (4 cells)
  std::vector<std::int32_t> fan;               ///< (cells)
  std::vector<std::uint8_t> seen;              ///< (cells)
  std::vector<std::int32_t> touched;           ///< after a cut: (cells) those whose nodes moved or changed ...
  std::int32_t touched_count = 0;              ///< ... so many

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("height", s.height), v("at_blade", s.at_blade), v("nearest", s.nearest), v("towards", s.towards),
        v("target_rest", s.target_rest), v("target_now", s.target_now), v("side", s.side), v("begin", s.begin),
        v("around", s.around), v("fan", s.fan), v("seen", s.seen), v("touched", s.touched),
        v("touched_count", s.touched_count);
  }
};
CutWork make_work(const CuttableTets& body);

/// @param now  (nodes) current positions [m]: nodes that snap move along with their drawn positions; (capacity) must be
///             given, doubles are put where their source is
CutResult cut(CuttableTets& body, const Blade& blade, std::span<Vec3d> now, CutWork& work) noexcept;

/// The cells at each node, ascending: those of node i are around[begin[i]] to around[begin[i + 1] - 1].
/// @param begin  (nodes + 1)  @param around  (4 cells)
void gather_cells(std::span<const Tet> cells, std::span<std::int32_t> begin, std::span<std::int32_t> around) noexcept;

/// Smallest dihedral angle of a cell [degrees]; 0 where it has no volume.
double least_dihedral(const std::array<Vec3d, 4>& x) noexcept;

}  // namespace trocar::geometry
