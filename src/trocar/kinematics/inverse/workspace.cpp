#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/inverse/workspace.hpp>

namespace trocar::kinematics {
namespace {

class Surveying {
  static constexpr int kMostTries = 30;  ///< for a pose within limits

 public:
  Surveying(const Mechanism& mechanism, const BodyFrame& frame, const WorkspaceOptions& options)
      : m(mechanism), m_frame(frame), m_options(options), m_loops(mechanism), m_start(mechanism.start_u()) {}

  Workspace survey() {
    if (!m.drives.empty()) hold_drives(m, m_loops);
    const LoopReport first = close(m, m_start, m_loops);
    if (!first.closed())
      throw std::invalid_argument(m.name + ": expected a start that closes, got one " + words(m, first));
    m_led = !m.drives.empty() && first.idle() == 0;  // drives that leave nothing else to choose
    if (!m_led) hold(m_loops, {});
    if (m_led && m.drives.size() == 1)
      along_the_drive();
    else
      at_random();
    count_cells();
    return m_out;
  }

 private:
  void take(const LoopReport& report) {
    ++m_out.samples;
    m_out.closed += report.closed();
    if (!report.closed() || report.limit >= 0) return;
    ++m_out.within;
    m_points.push_back(place(m_frame, m_loops.pose).p);
  }

  void along_the_drive() {
    const Drive& d = m.drives[0];
    const Branch branch = branch_at(m, m_start, m_loops);
    const int steps = std::clamp(m_options.samples, 2, 2000);
    std::vector<double> u = m_start;
    bool arrived = move(m, u, {{d.independent, d.value(0)}}, branch, m_loops).arrived();
    for (int k = 0; k <= steps; ++k) {
      const std::vector<double> before = u;
      arrived = move(m, u, {{d.independent, d.value(double(k) / steps)}}, branch, m_loops).arrived();
      LoopReport report = close(m, u, m_loops);
      if (!arrived) report.status = LoopStatus::out_of_reach;
      take(report);
      if (arrived && m_points.size() > 1 && report.limit < 0)
        m_out.path += length(m_points.back() - m_points[m_points.size() - 2]);
    }
  }

  void at_random() {
    core::Random random(m_options.seed);
    std::vector<double> u = m_start;
    for (std::int64_t k = 0; k < kMostTries * std::int64_t(m_options.samples) && m_out.within < m_options.samples;
         ++k) {
      std::copy(m_start.begin(), m_start.end(), u.begin());
      if (!m_led)
        for (std::size_t i = 0; i < u.size(); ++i) {
          const auto q = std::size_t(m.independent[i]);
          const bool limited = std::isfinite(m.low[q]) && std::isfinite(m.high[q]);
          const double reach = m.measures[q] == Measure::angle ? portable::pi : m.length;
          u[i] = limited ? random.uniform(m.low[q], m.high[q]) : m_start[i] + random.uniform(-reach, reach);
        }
      if (m_led)
        for (const Drive& d : m.drives) u[std::size_t(d.independent)] = d.value(random.uniform());
      take(close(m, u, m_loops));
    }
  }

  double cells(std::size_t count) const {
    std::vector<std::uint64_t> met;
    for (std::size_t i = 0; i < count; ++i) {
      std::uint64_t key = 0;
      for (int k = 0; k < 3; ++k)
        key = (key << 21) | (std::uint64_t((m_points[i][k] - m_out.low[k]) / m_out.cell) & 0x1fffff);
      met.push_back(key);
    }
    std::sort(met.begin(), met.end());
    const auto different = std::unique(met.begin(), met.end()) - met.begin();
    return double(different) * m_out.cell * m_out.cell * m_out.cell;
  }

  void count_cells() {
    if (m_points.empty()) return;
    m_out.low = m_out.high = m_points[0];
    for (const Vec3d& p : m_points)
      for (int k = 0; k < 3; ++k) {
        m_out.low[k] = std::min(m_out.low[k], p[k]);
        m_out.high[k] = std::max(m_out.high[k], p[k]);
      }
    const Vec3d size = m_out.high - m_out.low;
    const double longest = std::max({size.x, size.y, size.z});
    m_out.cell = m_options.cell > 0 ? std::max(m_options.cell, longest / 1e6) : longest / 40;
    if (!(m_out.cell > 0)) return;
    m_out.volume = cells(m_points.size());
    m_out.volume_of_half = cells(m_points.size() / 2);
  }

  const Mechanism& m;
  const BodyFrame& m_frame;
  const WorkspaceOptions& m_options;
  LoopWork m_loops;
  std::vector<double> m_start;
  std::vector<Vec3d> m_points;
  bool m_led = false;
  Workspace m_out;
};

}  // namespace

Workspace workspace(const Mechanism& m, const BodyFrame& frame, const WorkspaceOptions& options) {
  return Surveying(m, frame, options).survey();
}

}  // namespace trocar::kinematics
