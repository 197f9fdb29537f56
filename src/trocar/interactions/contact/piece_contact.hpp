// An organ that has been cut touches itself: what falls off lands on what it was cut from, and the lips of a slit close
// on each other. Without memory: a vertex is tested against the nearest vertex of another piece, wherever that is, and
// against the one that it was doubled from.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/interactions/bodies/loads.hpp>
#include <trocar/interactions/bodies/surface.hpp>

namespace trocar::interactions {

/// Pushes apart what overlaps. The vertices of all pieces but the largest are tested.
/// @param part  (vertices) which piece each belongs to
void piece_on_piece(const Surface& surface, std::span<const std::int32_t> part, int largest,
                    NetworkLoads& loads) noexcept;

/// The lips of a cut within one piece do not pass through each other: nodes that a cut has doubled stay on their sides
/// of each other, as long as they are near.
/// @param source  (vertices) the one that a vertex was doubled from; itself where no cut has made it
/// @param from,to  of the vertices, those that cuts have made
void lip_on_lip(const Surface& surface, std::span<const std::int32_t> part, std::span<const std::int32_t> source,
                int from, int to, NetworkLoads& loads) noexcept;

}  // namespace trocar::interactions
