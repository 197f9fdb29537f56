#include <algorithm>

#include <trocar/attempt/kept_states.hpp>

namespace trocar::attempt {
namespace {

template <class T>
std::size_t size_of(const std::vector<T>& array) {
  return array.capacity() * sizeof(T);
}

}  // namespace

std::size_t bytes_of(const sim::State& s) {
  std::size_t bytes = sizeof s + size_of(s.nearest) + size_of(s.strand_side) + size_of(s.tool_side) + size_of(s.seen) +
                      size_of(s.touches);
  bytes += size_of(s.solids) + size_of(s.strands) + size_of(s.parted);
  for (const tissue::NetworkState& solid : s.solids)
    bytes += size_of(solid.nodes) + size_of(solid.scale) + size_of(solid.tet_phase);
  bytes += size_of(s.cuttables);
  for (const tissue::CuttableState& body : s.cuttables)
    bytes += size_of(body.nodes) + size_of(body.tets.rest) + size_of(body.tets.source) + size_of(body.tets.cells) +
             size_of(body.tets.across) + size_of(body.tet_phase);
  for (const tissue::StrandState& strand : s.strands)
    bytes += size_of(strand.x) + size_of(strand.v) + size_of(strand.scale) + size_of(strand.alive) +
             size_of(strand.foundation_scale);
  for (const std::vector<std::uint8_t>& parted : s.parted) bytes += size_of(parted);
  bytes += size_of(s.membranes) + size_of(s.sheet_side) + size_of(s.sheet_bond) + size_of(s.torn);
  for (const tissue::MembraneState& sheet : s.membranes)
    bytes += size_of(sheet.network.nodes) + size_of(sheet.network.scale) + size_of(sheet.network.tet_phase) +
             size_of(sheet.torn);
  for (const std::vector<std::uint8_t>& torn : s.torn) bytes += size_of(torn);
  for (const auto* bodies : {&s.overstretched_organs, &s.overstretched_membranes, &s.overstretched_strands}) {
    bytes += size_of(*bodies);
    for (const std::vector<std::uint8_t>& counters : *bodies) bytes += size_of(counters);
  }
  const tissue::HeatState& h = s.heat;
  bytes += size_of(h.key) + size_of(h.slot) + size_of(h.cells) + size_of(h.water) + size_of(h.damage) +
           size_of(h.peak) + size_of(h.empty) + size_of(h.index);
  for (const auto* awake : {&h.u, &h.next, &h.heat, &h.due, &h.conduction}) bytes += size_of(*awake);
  return bytes;
}

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
