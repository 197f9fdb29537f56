// How the cloth of a bag moves in a tick: positions are predicted, then corrected until threads are no longer than they
// are and nothing is where it must not be; speeds follow from where that has led. [Müller et al. 2007, Position based
// dynamics; of what yields, Macklin et al. 2016, XPBD]
//
//   x* = x + h v + h^2 g
//   a few times, one after the other:   threads   |b - a| <= l, half of what is too much from either end
//                                       reins     the same from the hoop to every node, so that a load is borne at once
//                                                 [Kim, Chentanez & Mueller 2012, Long range attachments]
//                                       presses   (x - p) n >= 0, softly where p is tissue
//                                       touches   (q - sum w x) n >= r, by how light both sides are
//   v = (x - x before) / h, without most of what taut threads would swing with
//
// No energy comes of it: corrections only ever end what has come too near or too far.
#pragma once

#include <span>

#include <trocar/interactions/objects/bag.hpp>

namespace trocar::interactions {

/// What the hand at the sleeve wants.
struct BagHand {
  BagFrame frame;
  double depth = 0;   ///< of the sleeve's end from the port [m]
  double handle = 0;  ///< 0: the hoop is pushed out; 1: drawn back, the mouth is shut
  std::int32_t hand = -1;
};

/// The hoop goes with the sleeve, out of it and back, no faster than in a second and a half. It comes out for the first
/// time only where there is room for it, and does not close around what lies in the mouth.
void follow_hand(const BagHand& hand, double tick, const BagWork& work, BagState& state) noexcept;

/// Nodes that have sunk into a surface, for the cloth and for what the skin belongs to.
/// @param number  of the surface
/// @param loads   null: it is a wall
void rest_cloth(const BagModel& model, const Surface& surface, std::int32_t number, BagState& state,
                NetworkLoads* loads, BagWork& work) noexcept;
/// Looks in turn for the skin that is nearest to each node. @param tick  whose turn it is
void find_skins(const BagModel& model, std::span<const Surface> surfaces, std::uint64_t tick, BagState& state,
                const BagWork& work) noexcept;

/// One tick with what is noted of presses, rods and touches. @return false: a place is no number any more
bool advance_cloth(const BagModel& model, Vec3d gravity, double tick, BagState& state, BagWork& work) noexcept;

/// The speed of what the cloth has moved: it is stopped, and not thrown back.
Vec3d speed_after(const BagBody& body, double tick) noexcept;

/// Nodes of the hoop, and of all the cloth while it is rolled out.
void lay_hoop(const BagModel& model, BagState& state) noexcept;
tissue::Box bounds_of(const BagState& state) noexcept;
void find_normals(const BagModel& model, const BagState& state, BagWork& work) noexcept;

}  // namespace trocar::interactions
