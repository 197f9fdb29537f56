// The last word on instruments and tissue: nothing passes through an instrument's axis. Contacts push tissue off an
// instrument before the tick is made; how tissue then moves in the tick, thrown about by its own springs, nobody has
// asked yet. Here it is asked, once the tick is made: every edge of a skin or fold is followed in its straight line
// past the instrument's axis in its own; where it has gone through, or the axis' end through a triangle, the nodes
// there go with the instrument, free only to slide along it, and so on until nothing has gone through: a rigid impact
// zone [Provot 1997; Bridson et al. 2002]. In the next tick contact pushes them off. That is for bodies whose skins'
// vertices are nodes: folds and bodies of tetrahedra. Edges at nodes that are held elsewhere cannot give way.
//
// Why that ends: seen along the instrument, a node that goes with it does not move, so an edge between two such nodes
// does not go through, and nodes are only ever added. Those before its end stick to it altogether.
//
// What is impaled all the same, as where the edges of a fold are held, must not stay so for ever: an instrument that
// reaches more than kImpaled through something may leave it any way it likes.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/interactions/instrument/tool.hpp>

namespace trocar::interactions {

inline constexpr double kImpaled = 0.003;  ///< [m]

/// Between the tips of the jaws [m]; beyond kWide they are wide open. 0 of a hook with a foot, which has none.
inline constexpr double kWide = 0.004;
double gap_of(const ToolShape& shape) noexcept;

/// The axis of a part of an instrument, without thickness, before and after a tick.
struct Needle {
  Vec3d end0, dir0, end1, dir1;  ///< dir: unit, towards the end
  double length = 0;             ///< back from the end [m]

  /// Where a point that sticks to the needle has gone to.
  Vec3d carried(Vec3d p) const noexcept { return p + (end1 - end0) - dot(end0 - p, dir0) * (dir1 - dir0); }
};

/// An instrument's axes: of the shaft and what bends before it, and of closed jaws in one line or of each jaw that is
/// hardly open, or of a hook's wire. Jaws that are wide open have none, nor has a hook's foot: what they hook could
/// never slide off.
struct Needles {
  static constexpr int kMost = 3 + kinematics::kMaxLinks;
  Needle needle[kMost];
  int count = 0;
  int links = 0;  ///< of these, after the shaft's; like it they count for what jaws hold, too
};
/// @param blunt  the jaws count, not the shaft alone. Legs of clip appliers and blades of scissors do not
///               (Abilities::blunt): they come astride of a tube whose fold lies across their way, and would push both
///               out from between them as they close.
/// @param thin   jaws that are nearer to each other than this count as closed [m]
Needles needles_of(const ToolShape& before, const ToolShape& now, bool blunt, double thin) noexcept;

/// Do the ends of a tick lie on different sides of it?
/// @param p0,q0  the edge's ends before the tick; p1,q1 after it
bool goes_through(const Needle& needle, Vec3d p0, Vec3d q0, Vec3d p1, Vec3d q1) noexcept;

/// A body whose skin's vertices are its nodes, after a tick.
struct Carried {
  const tissue::Skin& skin;
  const tissue::SkinPose& before;         ///< as the tick began
  std::span<const std::uint8_t> open;     ///< (triangles) 1 = it is not there; may be empty
  std::span<const std::uint8_t> fixed;    ///< (nodes) tissue::Held bits; may be empty
  std::span<const std::int32_t> between;  ///< nodes that the jaws hold: only the shaft counts for these
  Vec3d origin;
  std::span<tissue::NodeState> rows;
};

/// What all instruments ask of a body in a tick, once one has asked; negative: not known yet.
struct CarriedExtent {
  double way = -1;   ///< the longest of a node at the surface [m]
  double side = -1;  ///< the longest of a triangle, from its first corner, as the tick began [m]
};

/// Nodes that the instrument's axis would have passed through go with it.
/// @param gap  the instrument's axes, where they are now, and the body, where it was before the tick, were at least
/// this
///             far apart [m]: where nothing has moved so far, nothing is looked at
/// @return how many were carried along
int carry_along(const Needles& needles, const Carried& body, double gap, double tick, CarriedExtent& extent) noexcept;

}  // namespace trocar::interactions
