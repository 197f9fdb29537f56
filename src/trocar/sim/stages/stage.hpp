// What the stages of a step share: events, views of what the tick has, bodies shared out over threads.
#pragma once

#include <span>

#include <trocar/interactions/couplings/strand_body.hpp>
#include <trocar/sim/model/step_context.hpp>

namespace trocar::sim {

/// [m] folds and organs further from an instrument than this are not looked at
inline constexpr double kNearSheet = 0.03;

inline interactions::TissueView tissue_of(const StepContext& c) noexcept {
  return {c.model.strand_bodies, c.state.strands, {c.work.surfaces.data(), size_t(c.model.organs())}, c.work.sheets};
}

inline interactions::Holders holders_of(const StepContext& c) noexcept {
  return {c.model.strand_bodies, c.state.strands, c.work.nodes, c.work.skins};
}

inline void tell(StepContext& c, Event::Kind kind, int tool, int index) noexcept {
  if (c.report.event_count < kMaxEvents - kRoomForTears) c.report.events[c.report.event_count++] = {kind, tool, index};
}

/// Bodies in the given order, shared out over threads; they write nothing in common.
template <class F>
void for_each(core::ThreadPool* pool, std::span<const int> order, F&& body) noexcept {
  auto one = [&](int k) noexcept { body(size_t(order[size_t(k)])); };
  if (pool) {
    core::run(*pool, int(order.size()), one);
    return;
  }
  for (int k = 0; k < int(order.size()); ++k) one(k);
}

}  // namespace trocar::sim
