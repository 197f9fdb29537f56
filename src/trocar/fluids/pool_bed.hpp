// The pool's bed under surfaces that look up: how high they are over the middles of its cells.
//
//   raise_bed(pool, {in_cells(pool, a), in_cells(pool, b), in_cells(pool, c)}, 0, pool.ny, bed);
#pragma once

#include <array>
#include <span>

#include <trocar/fluids/pool.hpp>

namespace trocar::fluids {

/// A point in the pool's frame: along u and v in cells, height above the origin in metres.
Vec3d in_cells(const PoolModel& model, Vec3d p) noexcept;

/// Raises the bed to a triangle (in_cells) where its height above a cell's middle is greater. What looks down, stands
/// upright or is not finite raises nothing.
/// @param first,last  rows, the last one not included
/// @param bed         (ny x nx) [m]
void raise_bed(const PoolModel& model, const std::array<Vec3d, 3>& corners, int first, int last,
               std::span<float> bed) noexcept;

}  // namespace trocar::fluids
