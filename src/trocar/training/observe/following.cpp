#include <algorithm>

#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/observe/following.hpp>

namespace trocar::training {

Following::Following(const FollowingLimits& limits, const sim::Model& model, int strand, const std::string& from)
    : m_limits(limits), m_strand(strand) {
  const std::string& name = model.strands[size_t(strand)].name;
  m_target = model.target_index(name + ".trace");
  m_from = model.target_index(name + "." + from);
  if (m_target < 0) return;
  const sim::VisibilityTarget& t = model.targets[size_t(m_target)];
  for (int i = t.first; i < t.first + t.count; ++i) {
    const sim::VisibilitySample& s = model.samples[size_t(i)];
    m_arc.push_back(interactions::arc_at(model.strand_bodies[size_t(strand)], {s.where, s.w}));
  }
  m_first = int(m_arc.size()) - 1;
  for (const sim::LandmarkModel& l : model.strands[size_t(strand)].landmarks)
    if (l.name == from)
      while (m_first > 0 && m_arc[size_t(m_first) - 1] >= l.from) --m_first;
}

double Following::reached() const {
  if (m_arc.empty()) return 0;
  return m_arc[size_t(m_front < 0 ? m_first : m_front)];
}

bool Following::followed(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips,
                         int sample) const {
  const size_t i = size_t(model.targets[size_t(m_target)].first + sample);
  if (state.seen[i]) return true;
  const interactions::StrandPlace place{model.samples[i].where, model.samples[i].w};
  const Vec3d at =
      interactions::point_at(model.strand_bodies[size_t(m_strand)], state.strands[size_t(m_strand)], place);
  return std::any_of(tips.begin(), tips.end(), [&](Vec3d tip) { return length(tip - at) < m_limits.touch; });
}

void Following::update(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt) {
  if (m_done || m_arc.empty()) return;
  if (m_front < 0) {
    if (!sim::visible(model, state, m_from)) return;
    m_front = m_first;
    m_credit = m_lost_for = 0;
  }
  m_credit = std::min(m_credit + m_limits.speed * dt, m_limits.gap);
  bool held = false;
  for (int next = m_front; next >= 0 && m_arc[size_t(m_front)] - m_arc[size_t(next)] <= m_limits.gap; --next) {
    if (!followed(model, state, tips, next)) continue;
    held = true;
    const double way = m_arc[size_t(m_front)] - m_arc[size_t(next)];
    if (way > m_credit) break;
    m_credit -= way;
    m_front = next;
  }
  m_lost_for = held ? 0 : m_lost_for + dt;
  if (m_lost_for > m_limits.pause) m_front = -1;
  m_done = m_front >= 0 && m_arc[size_t(m_front)] <= m_limits.to;
}

}  // namespace trocar::training
