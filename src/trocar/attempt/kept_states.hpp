// Full States kept along a recording, so that any moment is a short way from one of them. When they fill their share of
// memory every second one goes and from then on they are kept half as often.
//
//   KeptStates kept(512 << 20, 500);                   // bytes, ticks
//   if (kept.wants(state.tick)) kept.keep(state);
//   if (const sim::State* near = kept.before(tick)) ...
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::attempt {

/// Memory that a State takes, its arrays included [bytes].
std::size_t bytes_of(const sim::State& state);

class KeptStates {
 public:
  KeptStates(std::size_t budget, std::uint64_t spacing) : m_budget(budget), m_spacing(spacing) {}

  bool wants(std::uint64_t tick) const {
    return tick % m_spacing == 0 && (m_states.empty() || tick > m_states.back().tick);
  }
  /// Ticks must come in rising order; others than wants() says are left out.
  void keep(const sim::State& state);
  /// The last one at or before `tick`; null where there is none. Valid until the next keep().
  const sim::State* before(std::uint64_t tick) const;

  std::uint64_t spacing() const { return m_spacing; }
  std::size_t size() const { return m_states.size(); }
  std::size_t bytes() const { return m_bytes; }

 private:
  void thin_out();
  std::size_t m_budget = 0, m_bytes = 0;
  std::uint64_t m_spacing = 1;
  std::vector<sim::State> m_states;
};

/// The last few States that were passed on the way to where one is: single steps back are then short.
class RecentStates {
 public:
  explicit RecentStates(std::size_t most) : m_most(most) {}
  void keep(const sim::State& state);
  const sim::State* before(std::uint64_t tick) const;  ///< the nearest at or before `tick`, or null

 private:
  std::size_t m_most = 0, m_oldest = 0;
  std::vector<sim::State> m_states;
};

}  // namespace trocar::attempt
