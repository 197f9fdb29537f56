// What is in a bag. A point is inside from when it has come down through the mouth, within the hoop, until it leaves
// through the mouth again: the cloth lets nothing through, so there is no other way. Inside it is kept on the cloth's
// inner side, elsewhere on its outer one, whichever that means where the cloth lies folded.
#pragma once

#include <trocar/interactions/objects/bag.hpp>

namespace trocar::interactions {

/// Who is elsewhere, over the mouth, inside; and how far what lies in the mouth keeps it open.
void note_places(const BagModel& model, BagState& state, BagWork& work) noexcept;

/// Points at the cloth and at the hoop. @param tick  whose turn it is to look for the nearest node of all
void find_touches(const BagModel& model, std::uint64_t tick, BagState& state, BagWork& work) noexcept;

/// How the cloth pushes a node of a pouch that has sunk into it: as organs push each other, as a load that its wall takes
/// with all others. Moved like a stone it would strain its springs, tick after tick.
void push_pouch(const BagState& state, const BagTouch& touch, const BagBody& body, int node,
                NetworkLoads& loads) noexcept;

/// How many points of the body are inside, of how many: a rigid body has one.
struct BagShare {
  int inside = 0, all = 0;
};
BagShare share_in(const BagModel& model, const BagState& state, BodyId body) noexcept;

}  // namespace trocar::interactions
