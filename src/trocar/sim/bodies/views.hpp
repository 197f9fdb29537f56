// All bodies at once, as interactions want to see them in a tick.
#pragma once

#include <trocar/interactions/couplings/border.hpp>
#include <trocar/interactions/verbs/held.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// [m] folds and organs further from an instrument than this are not looked at
inline constexpr double kNearSheet = 0.03;

inline interactions::TissueView tissue_of(const StepContext& c) noexcept {
  return {c.model.strand_bodies,
          c.state.strands,
          {c.work.surfaces.data(), size_t(c.model.organs())},
          c.work.sheets,
          {&c.model.objects, &c.state.objects}};
}

inline interactions::BodyLoads loads_of(StepContext& c) noexcept {
  return {c.work.strand_loads, c.work.organ_loads, c.work.membrane_loads, &c.work.objects};
}

inline interactions::Holders holders_of(const StepContext& c) noexcept {
  return {c.model.strand_bodies, c.state.strands, c.work.nodes, c.work.skins};
}

}  // namespace trocar::sim
