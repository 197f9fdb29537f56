// From one closed pose to another: tangent, then correction, in steps that halve where the loops come open or the
// branch changes, and grow again where all is well.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/loops/close.hpp>

namespace trocar::kinematics {
namespace {

constexpr double kLongestTurn = 0.15;  ///< of any coordinate in a step [rad, lengths]
constexpr double kLeastStep = 1e-9;    ///< share of the way
constexpr int kMostSteps = 20'000;

class Moving {
 public:
  Moving(const Mechanism& mechanism, std::span<double> u, std::span<const Target> targets, const Branch& branch,
         LoopWork& work, const LoopOptions& options)
      : m(mechanism),
        m_u(u),
        m_targets(targets),
        m_branch(branch),
        w(work),
        m_options(options),
        m_tangent(u.size(), 0) {
    m_options.rank = branch.rank();
    for (const Target& t : targets) m_from.push_back(u[std::size_t(t.independent)]);
  }

  MoveReport go() {
    MoveReport report;
    report.last = close(m, m_u, w, m_options);
    if (!report.last.closed()) return report;
    double step = first_step();
    m_good.assign(m_u.begin(), m_u.end());
    m_share = branch_share(m, m_branch, w);
    while (report.reached < 1 && report.steps < kMostSteps) {
      tangent();
      double share = std::min(step, 1 - report.reached);
      double longest = 0;
      for (std::size_t i = 0; i < m_u.size(); ++i)
        longest = std::max(longest, std::fabs(m_tangent[i]) * share / m.scale(int(i)));
      if (longest > kLongestTurn) share *= kLongestTurn / longest;
      if (m_falls > 0) share = std::min(share, 0.5 * m_share / m_falls);
      bool good = false;
      for (; !good && share >= kLeastStep; share = good ? share : 0.25 * share) good = attempt(report, share);
      if (!good) break;
      step = std::min(1.0, 2 * share);
      ++report.steps;
    }
    std::copy(m_good.begin(), m_good.end(), m_u.begin());
    report.last = close(m, m_u, w, m_options);
    if (report.reached < 1) report.singular = report.last.pivot < kDeadPoint;
    return report;
  }

 private:
  static constexpr double kDeadPoint = 1e-2;  ///< pivot where a way ends that a dead point ends

  double first_step() const {
    double longest = 0;
    for (std::size_t k = 0; k < m_targets.size(); ++k)
      longest = std::max(longest, std::fabs(m_targets[k].value - m_from[k]) / m.scale(m_targets[k].independent));
    return longest > 0.1 * kLongestTurn ? 0.1 * kLongestTurn / longest : 1;
  }

  /// du per share of the way, by the slopes where close() has ended.
  void tangent() {
    std::fill(m_tangent.begin(), m_tangent.end(), 0.0);
    std::fill(w.r.begin(), w.r.end(), 0.0);
    for (std::size_t k = 0; k < m_targets.size(); ++k) {
      const int i = m_targets[k].independent;
      const double way = m_targets[k].value - m_from[k];
      m_tangent[std::size_t(i)] = way;
      for (int row = 0; row < m.rows; ++row)
        w.r[std::size_t(row)] += w.slope[std::size_t(i * m.rows + row)] * way / m.scale(i);
    }
    if (m.rows == 0 || w.free.empty()) return;
    w.qr.solve(w.r.data(), w.step.data());
    for (std::size_t k = 0; k < w.free.size(); ++k) m_tangent[std::size_t(w.free[k])] = -w.step[k] * m.scale(w.free[k]);
  }

  bool attempt(MoveReport& report, double share) {
    const double to = std::min(1.0, report.reached + share);
    for (std::size_t i = 0; i < m_u.size(); ++i) m_u[i] = m_good[i] + share * m_tangent[i];
    for (std::size_t k = 0; k < m_targets.size(); ++k)
      m_u[std::size_t(m_targets[k].independent)] = m_from[k] + to * (m_targets[k].value - m_from[k]);
    if (1 - to < 1e-12)
      for (const Target& t : m_targets) m_u[std::size_t(t.independent)] = t.value;
    const LoopReport now = close(m, m_u, w, m_options);
    const double now_share = branch_share(m, m_branch, w);
    double leap = 0;
    for (std::size_t i = 0; i < m_u.size(); ++i)
      leap = std::max(leap, std::fabs(m_u[i] - m_good[i] - share * m_tangent[i]) / m.scale(int(i)));
    if (now.status != LoopStatus::closed || leap > 0.5 * kLongestTurn || !(now_share > 0.5 * m_share)) {
      std::copy(m_good.begin(), m_good.end(), m_u.begin());
      close(m, m_u, w, m_options);  // the slopes there, for the tangent
      return false;
    }
    m_falls = (m_share - now_share) / share;
    m_share = now_share;
    report.last = now;
    report.reached = 1 - to < 1e-12 ? 1 : to;
    std::copy(m_u.begin(), m_u.end(), m_good.begin());
    return true;
  }

  const Mechanism& m;
  std::span<double> m_u;
  std::span<const Target> m_targets;
  const Branch& m_branch;
  LoopWork& w;
  LoopOptions m_options;
  /// Of the branch's minor, and how fast it falls: a step may halve it. Branches meet where it is 0, and beyond that
  /// the other one may have the same sign.
  double m_share = 1, m_falls = 0;
  std::vector<double> m_from, m_tangent, m_good;
};

}  // namespace

MoveReport move(const Mechanism& m, std::span<double> u, std::span<const Target> targets, const Branch& branch,
                LoopWork& work, const LoopOptions& options) {
  return Moving(m, u, targets, branch, work, options).go();
}

std::string words(const Mechanism& m, const MoveReport& r) {
  if (r.arrived()) return words(m, r.last);
  if (!r.last.closed()) return "does not begin at a closed pose: " + words(m, r.last);
  return tr("stopped after {:.4g} % of the way, {}", 100 * r.reached,
            r.singular ? tr("singular: a dead point (smallest pivot {:.1e}), beyond which the loops "
                            "are out of reach or change their branch",
                            r.last.pivot)
                       : "beyond which the loops are out of reach");
}

}  // namespace trocar::kinematics
