#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/chains/excluded_range.hpp>

namespace trocar::kinematics {
namespace {

constexpr double kRounding = 1e-3;  // of a range: files round angles

struct Interval {
  double low = 0, high = 0;
  bool bounded() const { return low > -kNoLimit && high < kNoLimit; }
};

/// How far an independent coordinate goes.
Interval range_of(const Mechanism& m, int independent) {
  for (const Drive& d : m.drives)
    if (d.independent == independent) return {std::min(d.at_0, d.at_1), std::max(d.at_0, d.at_1)};
  const auto q = std::size_t(m.independent[std::size_t(independent)]);
  if (m.rows > 0) return {-kNoLimit, kNoLimit};
  return {m.low[q], m.high[q]};
}

}  // namespace

std::vector<ExcludedRange> excluded_ranges(const Mechanism& m) {
  std::vector<ExcludedRange> out;
  for (const int i : m.dependents) {
    const auto q = std::size_t(i);
    ExcludedRange led{i, m.offset[q], m.offset[q], -1};
    bool known = true;
    int leaders = 0;
    for (int k = m.expand_start[q]; k < m.expand_start[q + 1]; ++k) {
      const Mechanism::Entry& e = m.expand[std::size_t(k)];
      const Interval leader = range_of(m, e.u);
      if (e.ratio == 0) continue;
      known = known && leader.bounded();
      led.leader = m.independent[std::size_t(e.u)];
      ++leaders;
      led.low += e.ratio * (e.ratio > 0 ? leader.low : leader.high);
      led.high += e.ratio * (e.ratio > 0 ? leader.high : leader.low);
    }
    const double slack = kRounding * (led.high - led.low) + 1e-9;
    if (leaders == 1 && known && std::isfinite(led.high - led.low) &&
        (led.low < m.low[q] - slack || led.high > m.high[q] + slack))
      out.push_back(led);
  }
  return out;
}

std::string words(const Mechanism& m, const ExcludedRange& range) {
  const auto q = std::size_t(range.coordinate);
  const bool angle = m.measures[q] == Measure::angle;
  const double unit = angle ? 180 / portable::pi : 1e3;
  return tr(
      "{} follows {}, which leads it from {:.4g} to {:.4g} {}; its own limits are {:.4g} to {:.4g}. It cannot go "
      "beyond them: correct its limits, or its ratio (\"multiplier\").",
      m.coordinates[q], m.coordinates[std::size_t(range.leader)], unit * range.low, unit * range.high,
      angle ? tr("degrees") : tr("mm"), unit * m.low[q], unit * m.high[q]);
}

}  // namespace trocar::kinematics
