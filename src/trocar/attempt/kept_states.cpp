#include <algorithm>

#include <trocar/attempt/kept_states.hpp>
#include <trocar/core/memory.hpp>

namespace trocar::attempt {

std::size_t bytes_of(const sim::State& state) { return core::memory_of(state); }

void KeptStates::keep(const sim::State& state) {
  if (!wants(state.tick)) return;
  m_states.push_back(state);
  m_bytes += bytes_of(m_states.back());
  while (m_bytes > m_budget && m_states.size() > 1) thin_out();
}

void KeptStates::thin_out() {
  m_spacing *= 2;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < m_states.size(); ++i) {
    if (m_states[i].tick % m_spacing != 0) continue;
    if (i != kept) m_states[kept] = std::move(m_states[i]);
    ++kept;
  }
  m_states.resize(kept);
  m_bytes = 0;
  for (const sim::State& s : m_states) m_bytes += bytes_of(s);
}

const sim::State* KeptStates::before(std::uint64_t tick) const {
  const auto after = std::upper_bound(m_states.begin(), m_states.end(), tick,
                                      [](std::uint64_t t, const sim::State& s) { return t < s.tick; });
  return after == m_states.begin() ? nullptr : &*std::prev(after);
}

void RecentStates::keep(const sim::State& state) {
  for (const sim::State& s : m_states)
    if (s.tick == state.tick) return;
  if (m_states.size() < m_most) return m_states.push_back(state);
  if (m_most == 0) return;
  m_states[m_oldest] = state;
  m_oldest = (m_oldest + 1) % m_most;
}

const sim::State* RecentStates::before(std::uint64_t tick) const {
  const sim::State* best = nullptr;
  for (const sim::State& s : m_states)
    if (s.tick <= tick && (!best || s.tick > best->tick)) best = &s;
  return best;
}

}  // namespace trocar::attempt
