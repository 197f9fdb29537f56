#include <trocar/training/observe/clip_pair.hpp>

namespace trocar::training {

bool ClipPair::well_set(const interactions::Clip& clip) const {
  return clip.tips_visible == 2 && m_limits.stretch.holds(clip.s) && clip.cover >= m_limits.cover &&
         clip.theta <= m_limits.angle && clip.closing_time >= m_limits.closing;
}

bool ClipPair::are_a_pair(double inner, double outer) const {
  return m_limits.first.holds(inner) && m_limits.second.holds(outer) && m_limits.apart.holds(outer - inner);
}

void ClipPair::update(const sim::State& state) {
  for (; m_seen < state.clip_count; ++m_seen) take(state.clips[size_t(m_seen)]);
}

void ClipPair::take(const interactions::Clip& clip) {
  if (clip.strand < 0 || clip.strand != m_strand) return;
  m_misplaced = false;
  if (!well_set(clip)) return;
  m_misplaced = !place(clip.s, fits(clip.s));
  if (fits(clip.s) && m_count < int(m_counting.size())) m_counting[size_t(m_count++)] = clip.s;
}

/// @return whether it belongs where it is
bool ClipPair::place(double s, bool counts) {
  if (paired()) return true;  // one more does no harm
  for (int k = 0; k < m_count; ++k) {
    const double other = m_counting[size_t(k)];
    const bool outer = are_a_pair(other, s);
    if (!outer && !are_a_pair(s, other)) continue;
    m_first = m_second = true;
    m_pair = outer ? std::array{other, s} : std::array{s, other};
    return true;
  }
  if (m_count > 0 || !counts) return false;
  const bool inner = m_limits.first.holds(s);
  (inner ? m_first : m_second) = true;
  m_pair[inner ? 0 : 1] = s;
  return true;
}

}  // namespace trocar::training
