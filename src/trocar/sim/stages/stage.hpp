// What the stages of a step share: views of what the tick has, bodies shared out over threads.
#pragma once

#include <span>

#include <trocar/sim/bodies/views.hpp>

namespace trocar::sim {

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
