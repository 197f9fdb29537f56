// What is in a bag. A point is inside from when it has come down through the mouth, within the hoop, until it leaves
// through the mouth again: the cloth lets nothing through, so there is no other way. Inside it is kept on the cloth's
// inner side, elsewhere on its outer one, whichever that means where the cloth lies folded.
#pragma once

#include <trocar/interactions/objects/bag.hpp>

namespace trocar::interactions {

/// Who is elsewhere, over the mouth, inside; and how far what lies in the mouth keeps it open.
/// @param down  unit
void note_places(const BagModel& model, Vec3d down, BagState& state, BagWork& work) noexcept;

/// Points at the cloth and at the hoop. @param tick  whose turn it is to look for the nearest node of all
void find_touches(const BagModel& model, std::uint64_t tick, BagState& state, BagWork& work) noexcept;

/// A pouch in the bag lies in a smooth sack of the cloth's girth and depth that hangs from the hoop; the cloth yields
/// to it and is drawn about it. Pushed by the cloth's triangles, which give way and fold from tick to tick, a node that
/// weighs 2 mN is kept shaking, and with all of them the gallbladder climbs out again.
/// @param down   unit
/// @param drift  the cloth's velocity, of all of it: a single node's is mostly noise [m/s]
void keep_in_bag(const BagModel& model, const BagState& state, Vec3d down, const BagBody& body, int node, Vec3d drift,
                 NetworkLoads& loads) noexcept;
/// The same node at the hoop.
void push_off_hoop(const BagTouch& touch, const BagBody& body, int node, NetworkLoads& loads) noexcept;
Vec3d drift_of(const BagModel& model, const BagState& state) noexcept;

/// How many points of the body are inside, of how many: a rigid body has one.
struct BagShare {
  int inside = 0, all = 0;
};
BagShare share_in(const BagModel& model, const BagState& state, BodyId body) noexcept;

}  // namespace trocar::interactions
