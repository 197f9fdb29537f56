// Pieces of an organ that has been cut apart touch each other: what falls off lands on what it was cut from. Without
// memory: a vertex is tested against the nearest vertex of another piece, wherever that is.
#pragma once

#include <cstdint>
#include <span>

#include <trocar/interactions/loads.hpp>
#include <trocar/interactions/surface.hpp>

namespace trocar::interactions {

/// Pushes apart what overlaps. The vertices of all pieces but the one with the most are tested.
/// @param part  (vertices) which piece each belongs to, 0 .. parts - 1
void piece_on_piece(const Surface& surface, std::span<const std::int32_t> part, int parts,
                    NetworkLoads& loads) noexcept;

}  // namespace trocar::interactions
