// Walls stop instruments: what would go into one stays at its surface and slides along it, while the hand presses. The
// instrument follows the hand from there in every tick, and while the hand draws it back no wall holds it: whatever way
// it came to be behind one, it comes out.
//
// The press is a spring from where the instrument is to where the hand wants it, along the wall's normal: 500 N/m, at
// most 15 N (our choice: walls of flesh over bone are stiffer than any hand). In a corner it stays in front of all
// walls there, and their forces add.
#pragma once

#include <span>

#include <trocar/interactions/bodies/surface.hpp>
#include <trocar/interactions/instrument/touch.hpp>

namespace trocar::interactions {

struct WallStop {
  bool stopped = false;
  std::int32_t part = kShaft;
  Vec3d at, normal;  ///< point of the instrument's axis; into the cavity, in a corner along the sum of forces
  double force = 0;  ///< of the walls on the instrument, along the normal [N]
};

/// Moves the instrument back to the walls' inner side. Walls within 40 mm of the trocar do not count: it goes through
/// them. Nor do those whose surface is further away than 5 mm: the instrument is behind them since it was put there.
/// @param wanted  where the hand wants the instrument
/// @param before  where it was in the last tick: no wall moves it faster than a hand would
/// @param joints  as they are; walls do not bend an instrument
/// @param shift   of the trocar's fulcrum from its place
/// @param walls   that never move; their normals point into the cavity
WallStop stop_at_walls(const ToolModel& model, const kinematics::FulcrumPose& wanted,
                       const kinematics::FulcrumPose& before, const kinematics::Joints& joints,
                       std::span<const Surface> walls, ToolState& tool, Vec3d shift = {0, 0, 0}) noexcept;

/// Remembers the wall among what the instrument touches.
void note_wall(const WallStop& stop, Touching& touching) noexcept;

}  // namespace trocar::interactions
