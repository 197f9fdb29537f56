// A material point of a body, of whatever kind, at its surface, in it or a little beside it: where it is, how fast it
// goes, and what a load on it does to the body. The one place that knows how a point rides on nodes.
//
//   MaterialPoint p = attach(bodies, BodyId::organ(2), place);    // the point of that body that is there now
//   ... place_of(bodies, p) ... velocity_of(bodies, p) ...
//   put_load(bodies, p, {.f0 = force}, tag);
//
// A point is a row of its body's W, x = sum w_i q_i, and an offset from there that turns with a frame of the tissue:
//
//   lattice, fat         up to eight nodes with weights that give it for every affine motion of them; no frame
//   tetrahedra           the corners of a cell: it stays with its cell when blades part them
//   membrane             the corners of a triangle, and the triangle's frame
//   organ, spread        a long row of many nodes (spread.hpp); no frame
//   rod                  the ends of an element, and the direction of that; where the element is cut through, the point
//                        rides on the stump that it lies on
//
// A load is the transpose of the velocity: f . v = sum f_i . v_i, whatever the nodes' velocities (virtual work), with
// the couple that a force beside the row is.                                                               [couplings]
#pragma once

#include <array>
#include <cstdint>

#include <trocar/core/body_id.hpp>
#include <trocar/interactions/bodies/affine_fit.hpp>
#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>

namespace trocar::interactions {

struct Bodies;
struct BodyModels;

/// No padding.
struct MaterialPoint {
  /// What its offset turns with.
  enum Frame : std::int32_t {
    space,     ///< nothing: the row gives it for every affine motion
    rod,       ///< the drawn direction of its element
    triangle,  ///< edge, across and normal of its first three nodes
    long_row,  ///< nothing; nodes and weights are in BodyModels::rows[element]
    skin_row   ///< nothing; nodes and weights are those of vertex `element` of the organ's skin
  };
  BodyId body;                ///< none: space, and `offset` is the place
  std::int32_t element = -1;  ///< of a rod; cell of tetrahedra; triangle of a membrane; long row; the vertex that it
                              ///< is of a lattice's skin; number of an object's place; -1: none of these
  std::int32_t count = 0;     ///< nodes of the row; of a rod and of tetrahedra its element says which
  std::int32_t frame = space;
  std::array<std::int32_t, kRowNodes> node{};
  std::array<float, kRowNodes> weight{};  ///< sum 1; of a rod the first: place in the element, 0 .. 1
  std::array<float, 3> offset{};          ///< [m] in the frame; of a rod in the drawn shape's axes

  bool in_space() const noexcept { return !body.exists(); }
  bool is_long() const noexcept { return frame == long_row || frame == skin_row; }

  static constexpr bool kAsBytes = true;
  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("body", s.body), v("element", s.element), v("count", s.count), v("frame", s.frame), v("node", s.node),
        v("weight", s.weight), v("offset", s.offset);
  }
};
static_assert(sizeof(MaterialPoint) == 4 * (4 + 2 * kRowNodes + 3), "no padding");

/// Does it name places of these bodies? For what comes from outside.
bool is_valid(const BodyModels& models, const MaterialPoint& point) noexcept;

/// A point of space.
MaterialPoint in_space(Vec3d place) noexcept;
/// A node of a lattice, a membrane or fat, and what is beside it by `offset` [m] (of a membrane it turns with the
/// sheet there; else it goes along in parallel).
MaterialPoint at_node(const Bodies& bodies, BodyId body, std::int32_t node, Vec3d offset = {}) noexcept;
/// A place on a rod's axis, and what is beside it by `offset` as it is now [m].
MaterialPoint at_element(const Bodies& bodies, std::size_t rod, std::int32_t element, double w, Vec3d offset) noexcept;
/// A place of an object that is no tissue, which the object knows by that number (objects/object_kinds.hpp).
MaterialPoint on_object(BodyId body, std::int32_t place) noexcept;
/// A vertex of an organ's skin itself. Of tetrahedra only in a tick.
MaterialPoint on_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex) noexcept;
/// At a vertex of an organ's skin, or beside it: carried by the nodes that carry that.
MaterialPoint at_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex, Vec3d place) noexcept;
/// Beside a vertex of an organ's skin, as bonds are: it goes with the vertex in parallel, and no weight of its row is
/// negative, so that what is stable for the nodes is so for any number of bonds.
MaterialPoint along_with_vertex(const Bodies& bodies, std::size_t organ, std::int32_t vertex, Vec3d place) noexcept;
/// The point of that body that is at `place` now. It looks at all of the body's nodes.
MaterialPoint attach(const Bodies& bodies, BodyId body, Vec3d place) noexcept;

Vec3d place_of(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// As far as a load may count on it (loads.hpp).
Vec3d velocity_of(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// Where it was when the scene was drawn.
Vec3d drawn_place(const Bodies& bodies, const MaterialPoint& point) noexcept;
/// Where its row is, without the offset: what it is rooted in.
Vec3d foot_of(const Bodies& bodies, const MaterialPoint& point) noexcept;

/// Which vertex of its body's skin it is, of fat which lobule; -1: none of them.
std::int32_t vertex_of(const Bodies& bodies, const MaterialPoint& point) noexcept;

/// How a plane of the tissue about it faces now that was drawn facing along the unit vector `drawn`.
Vec3d normal_at(const Bodies& bodies, const MaterialPoint& point, Vec3d drawn) noexcept;
/// Of a point of a rod: where on its axis, whether that is whole or not.
StrandPlace place_on_rod(const MaterialPoint& point) noexcept;
/// How far along the rod that is in the drawn shape [m].
double arc_of(const BodyModels& models, const MaterialPoint& point) noexcept;
/// As it is stored: in its frame, of a rod in the drawn shape's axes [m].
Vec3d offset_of(const MaterialPoint& point) noexcept;

/// f0 + k (target + t u - x) + d (u - v) with t since the tick began, of all directions or of one. k and d act on the
/// row's nodes, implicitly.
struct PointLoad {
  Vec3d f0{0, 0, 0};
  double k = 0;
  Vec3d target{0, 0, 0};
  double d = 0;
  Vec3d u{0, 0, 0};    ///< how fast the target goes [m/s]
  Vec3d dir{0, 0, 0};  ///< zero: of all; else of this, unit
};
/// Nothing to a point of space. Only in a tick.
void put_load(const Bodies& bodies, const MaterialPoint& point, const PointLoad& load, Tag tag) noexcept;

/// What a force on a point, whose row is no long one, is on the nodes of its body.
struct NodeForces {
  static constexpr int kMost = kRowNodes + 3;  ///< the row's, and those that bear the couple
  std::array<std::int32_t, kMost> node{};
  std::array<Vec3d, kMost> force{};
  int count = 0;

  void add(std::int32_t n, Vec3d f) noexcept {
    node[std::size_t(count)] = n;
    force[std::size_t(count++)] = f;
  }
};
NodeForces transposed(const Bodies& bodies, const MaterialPoint& point, Vec3d force) noexcept;

}  // namespace trocar::interactions
