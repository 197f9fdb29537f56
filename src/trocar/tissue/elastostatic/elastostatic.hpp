// An organ without inertia: its surface goes where the forces on it and the compliance of its surface say, at once and
// whatever the forces. The paper's second method.
//
//   u = K^-1 f                                                                             [KCM99 eq.6]
//   forces at the points that something holds, pushes or rubs: load_case.hpp               [KCM99 eq.7]
//   only surface nodes have columns and rows                                               [KCM99 eq.8]
//
// Two things are our choice. *Time*: a step from rest to the answer is a jump, which neither tissue nor what hangs on
// it makes, so a tick brings a share s of the way, u' = (1 - s) u + s C f, as if the tissue had a viscosity in
// proportion to its stiffness. s is 1/6 (five milliseconds), and less where the surface would go back faster than 0.2
// mm a tick; at rest nothing of it is left, and what is prescribed is met exactly in every tick. *Turning*: (6) holds
// for small angles. An organ that only springs hold in space turns and shifts as a frame, in which u is small; springs
// to space and gravity, as seen from the frame, are twelve and three fields of displacement that are computed
// beforehand.
//
//   advance(model, loads, point_of_load, reactions, frame_carried_by, state, rows, work);      // 1 ms
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/numerics/mat3.hpp>
#include <trocar/tissue/base/report.hpp>
#include <trocar/tissue/elastostatic/load_case.hpp>
#include <trocar/tissue/network/network.hpp>
#include <trocar/tissue/network/prestress.hpp>

namespace trocar::tissue {

inline constexpr int kFrameFields = 15;            ///< springs to space seen from a turned frame: 9 + 3; gravity: 3
inline constexpr double kShare = 1.0 / 6;          ///< s: of the way in a tick                             Our choice
inline constexpr double kQuickestReturn = 0.0002;  ///< [m] a tick without a hand                           Our choice
inline constexpr double kAsDrawn = 1e-9;           ///< [m] nothing is left of a displacement smaller than this
inline constexpr int kInnerTurns = 16;             ///< ticks in which all nodes that are not kept are placed

/// A node that is not kept: displaced as the kept ones around it are. Only for what looks inside, and as a start for
/// the next mover of the organ; the solution needs none of it.
struct InnerNode {
  std::int32_t node = -1, row = -1;
  std::array<std::int32_t, 8> slot{};
  std::array<float, 8> weight{};  ///< all zero: held
  Vec3d rest;                     ///< drawn [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("node", s.node), v("row", s.row), v("slot", s.slot), v("weight", s.weight), v("rest", s.rest);
  }
};

/// Const. Nodes are those of the organ's description; `n` of them are kept.
struct ElastostaticModel {
  std::vector<std::int32_t> kept;   ///< (n) ascending
  std::vector<std::int32_t> slot;   ///< (nodes) place among the kept; -1: an inner node
  std::vector<std::int32_t> row;    ///< (n) where its NodeState is
  std::vector<Vec3d> rest;          ///< (n) drawn [m]
  std::vector<InnerNode> inner;     ///< (nodes - n)
  std::vector<float> compliance;    ///< (3 n columns x stride) [m/N]
  std::vector<float> frame_fields;  ///< (kFrameFields x stride), or empty: something is held rigidly
  int stride = 0;                   ///< 3 n in whole packs
  Vec3d origin;                     ///< of NodeState positions [m]
  Vec3d centre;                     ///< mean of rest [m]
  double spread = 0;                ///< root of the mean square distance from there [m]
  Mat3d inverse_inertia;            ///< of unit masses at rest, about the centre [1/m^2]
  Vec3d gravity;                    ///< [m/s^2]
  double tick = 0;                  ///< [s]

  bool floats() const noexcept { return !frame_fields.empty(); }
  int nodes() const noexcept { return int(kept.size()); }
  ComplianceView view() const noexcept { return {compliance.data(), stride}; }

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("kept", s.kept), v("slot", s.slot), v("row", s.row), v("rest", s.rest), v("inner", s.inner),
        v("compliance", s.compliance), v("frame_fields", s.frame_fields), v("stride", s.stride), v("origin", s.origin),
        v("centre", s.centre), v("spread", s.spread), v("inverse_inertia", s.inverse_inertia), v("gravity", s.gravity),
        v("tick", s.tick);
  }
};

/// Where the organ's frame is: x = centre + shift + R (rest - centre + u).
struct OrganFrame {
  double w = 1, x = 0, y = 0, z = 0;  ///< R
  Vec3d shift;                        ///< [m]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("w", s.w), v("x", s.x), v("y", s.y), v("z", s.z), v("shift", s.shift);
  }
};

struct ElastostaticState {
  std::vector<float> u;  ///< (stride) displacements in the frame [m]
  OrganFrame frame;
  /// How far the answer is from a small one: turn of the organ as a whole beside its frame's, or the largest
  /// displacement beside that over ElastostaticModel::spread, whichever is more. Updated every kInnerTurns ticks [rad].
  double turn = 0;
  std::uint32_t turns = 0;  ///< whose turn it is of the inner nodes
  std::int32_t still = 0;   ///< 1: it lies as it was drawn, and its rows say so

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("u", s.u), v("frame", s.frame), v("turn", s.turn), v("turns", s.turns), v("still", s.still);
  }
};

struct ElastostaticWork {
  std::vector<float> start, next;       ///< (stride)
  std::vector<float> force;             ///< (3 n) [N]
  std::vector<std::int32_t> loaded;     ///< kept nodes on which there is any, in the order in which they were met
  std::vector<std::uint8_t> is_loaded;  ///< (n)
  std::vector<const float*> column;     ///< (3 n + fields) to be added ...
  std::vector<float> factor;            ///< ... times this
  std::vector<PointTerm> terms;
  std::vector<LoadPoint> points;
  std::vector<Vec3d> now;                ///< (points)
  std::vector<std::int32_t> first_load;  ///< (points) its loads begin here
  LoadCaseWork load_case;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("start", s.start), v("next", s.next), v("force", s.force), v("loaded", s.loaded), v("is_loaded", s.is_loaded),
        v("column", s.column), v("factor", s.factor), v("terms", s.terms), v("points", s.points), v("now", s.now),
        v("first_load", s.first_load), v("load_case", s.load_case);
  }
};

/// What the frame's fields are made of: forces on all nodes for the 15 of them. @return (15 x 3 nodes) [N]
std::vector<double> frame_loads(std::span<const Vec3d> points, std::span<const double> mass,
                                std::span<const Anchor> anchors, Vec3d centre);

/// What make_elastostatic() needs of an organ as it is drawn.
struct DrawnOrgan {
  std::span<const Vec3d> points;       ///< (nodes) [m]
  std::span<const std::uint8_t> held;  ///< (nodes) Held bits, or empty
  std::span<const int> row_of_node;    ///< (nodes)
  Vec3d origin;                        ///< of NodeState positions [m]
  Vec3d gravity;                       ///< [m/s^2]
};
/// @param compliance  (3 kept x 3 kept) by columns, @param fields (15 x 3 kept) or empty: as condense() gives them
ElastostaticModel make_elastostatic(const DrawnOrgan& organ, std::span<const int> kept,
                                    std::span<const float> compliance, std::span<const float> fields, double tick);
ElastostaticState rest_state(const ElastostaticModel& model);
/// @param most_loads  of a tick
ElastostaticWork make_work(const ElastostaticModel& model, int most_loads);

/// Where holders of the organ are carried at the end of the tick, by breathing [m].
struct CarriedBy {
  Vec3d shift{0, 0, 0};
};

/// One tick. Loads as for a network but in any order; those that are shares of one point of the skin follow each other
/// with the same number in `point`. Loads on inner nodes are left out (kBadLoad). Writes the rows of kept nodes, and of
/// a part of the others. An organ that is held rigidly, lies in the drawn shape and has no loads costs nothing.
/// @param point       (loads) of which point a load is a share
/// @param reactions   (loads) force that each exerted on its node [N]
/// @return kBadLoad in flags also where points were left without force
StepReport advance(const ElastostaticModel& model, std::span<const NodeLoad> loads, std::span<const std::int32_t> point,
                   std::span<Vec3f> reactions, CarriedBy carried, ElastostaticState& state, std::span<NodeState> rows,
                   ElastostaticWork& work) noexcept;

/// All rows of nodes that are not kept.
void place_inner_nodes(const ElastostaticModel& model, const ElastostaticState& state,
                       std::span<NodeState> rows) noexcept;

/// Place of a kept node in the world [m].
Vec3d place_of(const ElastostaticModel& model, const ElastostaticState& state, int slot) noexcept;

}  // namespace trocar::tissue
