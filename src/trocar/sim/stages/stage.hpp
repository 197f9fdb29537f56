// What the stages of a step share: events, views of what the tick has, bodies shared out over threads.
#pragma once

#include <span>

#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {

inline void tell(StepContext& c, Event::Kind kind, int tool, int index) noexcept {
  if (c.report.event_count < kMaxEvents - kRoomForTears) c.report.events[c.report.event_count++] = {kind, tool, index};
}
inline void tell(StepContext& c, Event::Kind kind, int tool, BodyId body) noexcept { tell(c, kind, tool, body.code()); }

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
