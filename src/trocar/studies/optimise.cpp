#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <trocar/kinematics/inverse/workspace.hpp>
#include <trocar/studies/end_of_way.hpp>
#include <trocar/studies/halton.hpp>
#include <trocar/studies/link_pairs.hpp>
#include <trocar/studies/optimise.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr double kNever = 1e9;          // penalty of what does not close
constexpr double kBeside = 0.01;        // of the wish for little change beside what is missing
constexpr double kMargin = 0.02;        // of the wished clearance more, as poses between those looked at may be nearer
constexpr double kFinest = 1.0 / 2048;  // of a parameter's bounds
constexpr double kEndKept = 0.005;      // of the frame's way: further off, the end of the drive's way is another
constexpr double kRoundLength = 1e-6, kRoundAngle = 1e-3 * portable::pi / 180, kRoundRatio = 1e-6;

class PatternSearch {
 public:
  PatternSearch(const Mechanism& mechanism, const OptimiseOptions& options, const ClearanceOptions& judge)
      : m(mechanism), m_options(options), m_judge(judge), m_changed(mechanism) {
    for (int i = 0; i < m.named_parameters; ++i)
      if (m.parameters[std::size_t(i)].low < m.parameters[std::size_t(i)].high) m_out.parameters.push_back(i);
    if (m_out.parameters.empty())
      throw std::invalid_argument("expected parameters with \"between\", got none that may change");
  }

  OptimiseResult run() {
    m_out.before = clearance_over_motion(m, m_judge, m_options.follow);
    for (const PairClearance& p : m_out.before.joined) m_judge.ignored.emplace_back(p.first, p.second);
    m_judge.strict = m_options.sweep.strict = true;
    m_options.sweep.ignored = m_judge.ignored;
    m_judge.drawn = m_options.sweep.drawn = drawn_gaps();
    m_sweep_before = clearance_over_motion(m, m_options.sweep, m_options.follow);
    m_end = end_of_way(m, m_options.follow);
    m_tied = m_end ? end_parameter(m) : -1;
    m_out.range_before = range(m, m_out.before);
    m_sweep_range = range(m, m_sweep_before);
    m_first = unit_of(m.parameter_values);
    m_least = penalty(m_first);
    for (int start = 0; start < m_options.starts && m_out.evaluations < m_options.evaluations; ++start) {
      ++m_out.starts;
      std::vector<double> x = m_first;
      if (start > 0)
        for (std::size_t d = 0; d < x.size(); ++d) x[d] = halton(start, int(d));
      descend(x);
      if (m_least < 1) break;  // nothing is missing: only the change is left
    }
    m_out.values = rounded(m_best);
    const Mechanism best = m.with(m_out.values);
    m_out.end_off = end_off(best);
    m_out.after = clearance_over_motion(best, m_judge, m_options.follow);
    m_out.range_after = range(best, m_out.after);
    m_out.free = m_out.after.least >= m_options.clearance && m_out.end_off <= end_slack() &&
                 m_out.after.reached_share() >= m_out.before.reached_share() &&
                 m_out.range_after >= m_options.keep * m_out.range_before &&
                 m_out.range_after <= m_options.most * m_out.range_before;
    return std::move(m_out);
  }

 private:
  const Parameter& bounded(std::size_t d) const { return m.parameters[std::size_t(m_out.parameters[d])]; }
  std::vector<double> unit_of(const std::vector<double>& values) const {
    std::vector<double> x;
    for (std::size_t d = 0; d < m_out.parameters.size(); ++d) {
      const Parameter& p = bounded(d);
      x.push_back(std::clamp((values[std::size_t(m_out.parameters[d])] - p.low) / (p.high - p.low), 0.0, 1.0));
    }
    return x;
  }
  std::vector<double> values_of(const std::vector<double>& x) const {
    std::vector<double> values = m.parameter_values;
    for (std::size_t d = 0; d < x.size(); ++d) {
      const Parameter& p = bounded(d);
      if (x[d] != m_first[d]) values[std::size_t(m_out.parameters[d])] = p.low + x[d] * (p.high - p.low);
    }
    return values;
  }

  /// Gaps of neighbours as they were drawn: whatever changes, they are not to be deeper in each other.
  std::vector<double> drawn_gaps() const {
    LoopWork work(m);
    std::vector<double> u = m.start_u();
    hold_drives(m, work);
    close(m, u, work);
    return LinkPairs(m, m_judge.ignored).drawn(m, work.pose);
  }

  double end_slack() const { return kEndKept * (m_out.range_before > 0 ? m_out.range_before : m.length); }
  double end_off(const Mechanism& of) const {
    if (!m_end) return 0;
    const std::optional<EndOfWay> end = end_of_way(of, m_options.follow);
    return end ? end->off(*m_end, m.length) : kNever;
  }
  /// Takes these values; where the drive's way ends follows from the others, if it may.
  void take(std::vector<double>& values) {
    m_changed.assign(values);
    if (m_tied < 0) return;
    values[std::size_t(m_tied)] = fitted_end(m_changed, m_tied, m_options.follow, *m_end);
    m_changed.assign(values);
  }

  /// As drawings have them. What has not changed stays as it is.
  std::vector<double> rounded(std::vector<double> values) {
    const auto round_one = [&](int i) {
      const Parameter& p = m.parameters[std::size_t(i)];
      double& value = values[std::size_t(i)];
      const double to = p.measure == Measure::length  ? kRoundLength
                        : p.measure == Measure::angle ? kRoundAngle
                                                      : kRoundRatio;
      if (value != m.parameter_values[std::size_t(i)])
        value = std::clamp(to * std::floor(value / to + 0.5), p.low, p.high);
    };
    for (const int i : m_out.parameters) round_one(i);
    take(values);
    if (m_tied >= 0) round_one(m_tied);
    return values;
  }

  double range(const Mechanism& of, const ClearanceReport& swept) const {
    if (m_options.follow < 0) return 0;
    if (of.drives.size() == 1) return swept.path;
    WorkspaceOptions w;
    w.samples = 4000;
    w.cell = of.length / 20;
    return workspace(of, of.frames[std::size_t(m_options.follow)], w).volume;
  }

  /// At least 1 as long as something is missing; below, how far from the dimensions as they were.
  double penalty(const std::vector<double>& x) {
    double change = 0;
    for (std::size_t d = 0; d < x.size(); ++d) change += (x[d] - m_first[d]) * (x[d] - m_first[d]);
    double missing = kNever;
    std::vector<double> values = values_of(x);
    take(values);
    try {
      const ClearanceReport r = clearance_over_motion(m_changed, m_options.sweep, m_options.follow);
      const double wish = m_options.clearance * (1 + kMargin);
      missing = std::isfinite(r.least) ? std::max(0.0, wish - r.least) / m_changed.length : 0;
      missing += std::max(0.0, end_off(m_changed) - 0.5 * end_slack()) / m_changed.length;
      missing += 10 * std::max(0.0, m_sweep_before.reached_share() - r.reached_share());
      if (m_options.follow >= 0 && m_sweep_range > 0) {
        const double share = range(m_changed, r) / m_sweep_range;
        missing += std::max({0.0, m_options.keep + 1e-3 - share, share + 1e-3 - m_options.most});
      }
    } catch (const std::invalid_argument&) {  // the start does not close
    }
    ++m_out.evaluations;
    const double beside = kBeside * change / double(x.size());
    const double value = missing > 0 ? 1 + 1e3 * missing + beside : beside;
    if (m_out.evaluations == 1 || value < m_least) {
      m_least = value;
      m_best = values;
    }
    m_out.history.push_back(m_least);
    return value;
  }

  /// Tries every parameter either way from x. @return the penalty where x is then
  double explore(std::vector<double>& x, double value, double step) {
    for (std::size_t d = 0; d < x.size() && m_out.evaluations < m_options.evaluations; ++d)
      for (const double by : {step, -step}) {
        if (m_out.parameters[d] == m_tied) continue;
        const double before = x[d];
        x[d] = std::clamp(before + by, 0.0, 1.0);
        const double next = x[d] == before ? value : penalty(x);
        if (next < value) {
          value = next;
          break;
        }
        x[d] = before;
      }
    return value;
  }

  void descend(std::vector<double> base) {
    double value = penalty(base), step = 0.25;
    while (step >= kFinest && m_out.evaluations < m_options.evaluations) {
      std::vector<double> next = base;
      double found = explore(next, value, step);
      if (!(found < value)) {
        step *= 0.5;
        continue;
      }
      while (found < value && m_out.evaluations < m_options.evaluations) {  // on in the same direction
        std::vector<double> further = next;
        for (std::size_t d = 0; d < further.size(); ++d) further[d] = std::clamp(2 * next[d] - base[d], 0.0, 1.0);
        base = next;
        value = found;
        next = further;
        found = explore(next, penalty(further), step);
      }
    }
  }

  const Mechanism& m;
  OptimiseOptions m_options;
  ClearanceOptions m_judge;
  Mechanism m_changed;
  ClearanceReport m_sweep_before;
  std::optional<EndOfWay> m_end;
  int m_tied = -1;  ///< the parameter that follows
  double m_sweep_range = 0, m_least = 0;
  std::vector<double> m_first, m_best;  ///< as shares of bounds; as values
  OptimiseResult m_out;
};

}  // namespace

OptimiseResult optimise(const Mechanism& m, const OptimiseOptions& options, const ClearanceOptions& judge) {
  return PatternSearch(m, options, judge).run();
}

}  // namespace trocar::studies
