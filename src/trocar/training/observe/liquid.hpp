// Whether liquid stands over a place.
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// Does the pool stand over it, so that one does not see through?
inline bool drowned(const sim::Model& model, const sim::State& state, Vec3d where) {
  constexpr float kShallow = 0.001f;  // [m] wet, but one sees through it
  const fluids::PoolModel& pool = model.wet.model.pool;
  const fluids::PoolPoint p = locate(pool, where);
  if (!p.inside) return false;
  const float deep = depth_at(pool, state.fluids.pool, p.i, p.j);
  return deep > kShallow && floor_at(pool, state.pool_floor, p.i, p.j) + deep > p.height + kShallow;
}

}  // namespace trocar::training
