#include <algorithm>
#include <cmath>
#include <iterator>

#include <trocar/render/frame/governor.hpp>

namespace trocar::render {

namespace {

constexpr Quality kLevels[] = {{1.0f, 2, 1, 4}, {1.0f, 2, 1}, {1.0f, 2, 1.6f}, {0.85f, 2, 1.6f}, {0.7f, 2, 1.6f},
                               {0.7f, 1, 1.6f}, {0.5f, 1, 2}, {0.5f, 0, 2.5f}, {0.4f, 0, 4}};
constexpr int kLongestPatience = 1800;
constexpr std::size_t kFarthestStep = 3;  ///< levels down at a time: the prediction is not that good

/// Cost of a frame against the best quality's without smooth outlines: what is paid for a picture, for triangles, for
/// fragments and for their samples (fitted to
/// `trocar bench EXERCISE --picture` of the one with blood, on llvmpipe).
double relative_cost(const Quality& q) {
  const double effects = q.detail == 2 ? 1.0 : (q.detail == 1 ? 0.85 : 0.6);
  const double scale = double(q.render_scale);
  const double sampling = q.samples > 1 ? 1.3 : 0.0;
  return 0.15 + 0.1 / double(q.coarser) + (0.75 * effects + sampling) * scale * scale;
}

int count_bits(unsigned x) {
  int n = 0;
  for (; x; x &= x - 1) ++n;
  return n;
}

}  // namespace

std::span<const Quality> quality_levels() { return kLevels; }

std::size_t first_level(bool on_processors) { return on_processors ? std::size(kLevels) - 3 : 0; }

Governor::Governor(Limits limits, std::size_t start_level)
    : m_limits(limits), m_level(std::min(start_level, std::size(kLevels) - 1)), m_patience(limits.calm_frames) {}

void Governor::step_to(std::size_t level) {
  m_came_up = level < m_level;
  m_level = level;
  m_mean = 0;
  m_history = 0;
  m_since_step = 0;
}

/// The next level below that is predicted not to be late.
std::size_t Governor::level_that_fits() const {
  const std::size_t last = std::min(m_level + kFarthestStep, std::size(kLevels) - 1);
  std::size_t level = m_level + 1;
  while (level < last && predicted(level) > m_limits.late) ++level;
  return level;
}

double Governor::predicted(std::size_t level) const {
  return m_mean * relative_cost(kLevels[level]) / relative_cost(kLevels[m_level]);
}

void Governor::load_becomes(double load) {
  if (!(load > 0) || !std::isfinite(load) || load == m_load) return;
  m_mean *= load / m_load;
  m_load = load;
  m_patience = m_limits.calm_frames;
  std::size_t level = m_level;
  while (level + 1 < std::size(kLevels) && predicted(level) > m_limits.late) ++level;
  step_to(level);
  m_came_up = false;
}

void Governor::frame_took(double seconds, bool crowds) {
  if (!std::isfinite(seconds) || seconds <= 0) return;
  ++m_since_step;
  m_mean = m_mean == 0 ? seconds : m_mean + 0.1 * (seconds - m_mean);
  m_history = ((m_history << 1) | (crowds || seconds > m_limits.late ? 1u : 0u)) & 0xffu;

  const bool worst = m_level + 1 == std::size(kLevels);
  if (!worst && count_bits(m_history) >= m_limits.late_frames) {
    // Late soon after a step up: that step was a mistake, wait twice as long before the next.
    if (m_came_up && m_since_step <= m_patience) m_patience = std::min(2 * m_patience, kLongestPatience);
    step_to(level_that_fits());
    return;
  }
  if (m_level == 0 || m_since_step < m_patience || m_history != 0) return;
  if (predicted(m_level - 1) < m_limits.roomy) step_to(m_level - 1);
}

}  // namespace trocar::render
