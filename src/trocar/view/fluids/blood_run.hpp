// The way that blood takes from a wound over walls and organs down to where it gathers: a thin film along the steepest
// fall, which grows while the wound bleeds. Drawn only; the simulation's drops run by themselves.
#pragma once

#include <span>

#include <trocar/fluids/pool.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/render/frame/liquid.hpp>

namespace trocar::view {

struct BloodRun {
  Vec3d wound;       ///< [m]
  double since = 0;  ///< it has bled so long [s]
  float dark = 0;    ///< as Splat::dark
};

/// Adds films to liquid.splats, until the pool or level ground.
/// @param floor  heights of walls and organs, as fluids::PoolInput
void list_run(const BloodRun& run, const fluids::PoolModel& model, const fluids::PoolState& pool,
              std::span<const float> floor, render::Liquid& liquid);

}  // namespace trocar::view
