#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/loops/close.hpp>
#include <trocar/kinematics/loops/conditions.hpp>
#include <trocar/kinematics/loops/equations.hpp>

namespace trocar::kinematics {

LoopWork::LoopWork(const Mechanism& m, int goals)
    : pose(m),
      held(m.independent.size(), 0),
      r(std::size_t(m.rows + goals)),
      slope(std::size_t(m.rows + goals) * m.independent.size()),
      step(m.independent.size()),
      trial(m.independent.size()),
      minor(m.independent.size() * m.independent.size()),
      qr(m.rows + goals, m.u_count()) {
  free.reserve(m.independent.size());
}

void hold(LoopWork& work, std::span<const int> held) noexcept {
  std::fill(work.held.begin(), work.held.end(), static_cast<unsigned char>(0));
  for (const int u : held) work.held[std::size_t(u)] = 1;
}

void hold_drives(const Mechanism& m, LoopWork& work) noexcept {
  std::fill(work.held.begin(), work.held.end(), static_cast<unsigned char>(0));
  for (const Drive& d : m.drives) work.held[std::size_t(d.independent)] = 1;
}

namespace {

template <class F>
void each_condition(const Mechanism& m, std::span<const Closure> goals, F&& f) noexcept {
  int row = 0;
  for (const std::span<const Closure> list : {std::span<const Closure>(m.closures), goals})
    for (const Closure& c : list)
      for (int k = 0; k < c.count; ++k) f(row++, is_length(c.conditions[std::size_t(k)]));
}

}  // namespace

int rows_of(const Mechanism& m, std::span<const Closure> goals) noexcept {
  int count = m.rows;
  for (const Closure& c : goals) count += c.count;
  return count;
}

void list_free(LoopWork& w) noexcept {
  w.free.clear();  // its room was reserved
  for (std::size_t u = 0; u < w.held.size(); ++u)
    if (!w.held[u]) w.free.push_back(int(u));
}

double evaluate(const Mechanism& m, std::span<const double> u, LoopWork& w, std::span<const Closure> goals) noexcept {
  forward(m, u, w.pose);
  residuals(m.closures, w.pose, w.r.data());
  residuals(goals, w.pose, w.r.data() + m.rows);
  double sum = 0;
  const double by = 1 / m.length;
  each_condition(m, goals, [&](int row, bool is_metres) {
    double& r = w.r[std::size_t(row)];
    if (is_metres) r *= by;
    sum += r * r;
  });
  return std::sqrt(sum);
}

void evaluate_slopes(const Mechanism& m, LoopWork& w, std::span<const Closure> goals, int rows) noexcept {
  slopes(m, m.closures, w.pose, w.slope.data(), rows);
  slopes(m, goals, w.pose, w.slope.data(), rows, m.rows);
  const double by = 1 / m.length;
  for (int u = 0; u < m.u_count(); ++u) {
    double* column = w.slope.data() + std::size_t(u) * std::size_t(rows);
    const double scale = m.scale(u);
    each_condition(m, goals, [&](int row, bool is_metres) { column[row] *= is_metres ? scale * by : scale; });
  }
}

namespace {

/// Of the columns that are free. @return the rank
int factor(const Mechanism& m, LoopWork& w, std::span<const Closure> goals, int rows, double least) noexcept {
  evaluate_slopes(m, w, goals, rows);
  double* a = w.qr.matrix(rows, int(w.free.size()));
  for (std::size_t k = 0; k < w.free.size(); ++k)
    std::copy_n(w.slope.begin() + w.free[k] * rows, rows, a + k * std::size_t(rows));
  return w.qr.factor(least);
}

/// The largest gap of a closure, as a length and as an angle.
void measure_gaps(const Mechanism& m, const LoopWork& w, std::span<const Closure> goals, LoopReport& report) noexcept {
  const double* r = w.r.data();
  for (const std::span<const Closure> list : {std::span<const Closure>(m.closures), goals})
    for (const Closure& c : list) {
      double metres = 0, radians = 0;
      for (int k = 0; k < c.count; ++k, ++r) (is_length(c.conditions[std::size_t(k)]) ? metres : radians) += *r * *r;
      report.metres = std::max(report.metres, m.length * std::sqrt(metres));
      report.radians = std::max(report.radians, std::sqrt(radians));
    }
}

constexpr double kLongestStep = 0.7;  // [rad, lengths]: beyond, the slopes say little
constexpr double kNoise = 1e-10;      // of a residual that no step makes smaller any more, and still counts as none

}  // namespace

LoopReport close(const Mechanism& m, std::span<double> u, LoopWork& w, const LoopOptions& options,
                 std::span<const Closure> goals) noexcept {
  LoopReport report;
  const int rows = rows_of(m, goals);
  list_free(w);
  report.unknowns = int(w.free.size());
  report.conditions = rows;
  double size = evaluate(m, u, w, goals);
  for (; size > options.tolerance && report.iterations < options.iterations; ++report.iterations) {
    // Where conditions depend on each other at the closed pose, their pivots are as small as the residual on the way to
    // it, and steps along them would be noise.
    const int rank = factor(m, w, goals, rows, std::clamp(0.1 * size, 1e-9, 1e-3));
    if (rank == 0) break;
    w.qr.solve(w.r.data(), w.step.data());
    double longest = 0;
    for (std::size_t k = 0; k < w.free.size(); ++k) longest = std::max(longest, std::fabs(w.step[k]));
    double share = longest > kLongestStep ? kLongestStep / longest : 1;
    double next = size;
    std::copy(u.begin(), u.end(), w.trial.begin());
    for (int halving = 0; halving < 12; ++halving, share *= 0.5) {
      for (std::size_t k = 0; k < w.free.size(); ++k) {
        const auto i = std::size_t(w.free[k]);
        u[i] = w.trial[i] - share * w.step[k] * m.scale(w.free[k]);
      }
      next = evaluate(m, u, w, goals);
      if (next < (1 - 1e-3 * share) * size) break;
    }
    if (!(next < size)) {
      std::copy(w.trial.begin(), w.trial.end(), u.begin());
      size = evaluate(m, u, w, goals);
      break;
    }
    size = next;
  }
  measure_gaps(m, w, goals, report);
  const int most = std::min(rows, report.unknowns);
  report.rank = most > 0 ? factor(m, w, goals, rows, std::max(1e-8, 10 * size)) : 0;
  const int expected = options.rank >= 0 ? std::min(options.rank, most) : report.rank;
  report.pivot = expected > report.rank || expected == 0 ? 0 : w.qr.pivot(expected - 1);
  if (!(size <= std::max(options.tolerance, kNoise)))
    report.status = LoopStatus::out_of_reach;
  else if (expected > 0 && report.pivot < options.singular)
    report.status = LoopStatus::singular;
  report.limit = beyond_limits(m, w.pose.q);
  return report;
}

Branch branch_at(const Mechanism& m, std::span<const double> u, LoopWork& w) {
  list_free(w);
  evaluate(m, u, w, {});
  Branch branch;
  const int rank = m.rows > 0 && !w.free.empty() ? factor(m, w, {}, m.rows, 1e-8) : 0;
  for (int k = 0; k < rank; ++k) branch.columns.push_back(w.free[std::size_t(w.qr.column(k))]);
  std::sort(branch.columns.begin(), branch.columns.end());
  numerics::PivotedQr across(std::max(rank, 1), std::max(m.rows, 1));
  double* a = across.matrix(rank, m.rows);
  for (int i = 0; i < m.rows; ++i)
    for (int k = 0; k < rank; ++k) a[i * rank + k] = w.slope[std::size_t(branch.columns[std::size_t(k)] * m.rows + i)];
  across.factor(0);
  for (int k = 0; k < rank; ++k) branch.rows.push_back(across.column(k));
  std::sort(branch.rows.begin(), branch.rows.end());
  branch.there = 1;
  branch.there = branch_share(m, branch, w);
  return branch;
}

double branch_share(const Mechanism& m, const Branch& branch, LoopWork& w) noexcept {
  const int n = int(branch.columns.size());
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      w.minor[std::size_t(k * n + i)] =
          w.slope[std::size_t(branch.columns[std::size_t(k)] * m.rows + branch.rows[std::size_t(i)])];
  return numerics::determinant(n, w.minor.data()) / branch.there;
}

std::string words(const Mechanism& m, const LoopReport& r) {
  std::string text;
  switch (r.status) {
    case LoopStatus::closed:
      text = r.conditions == 0 ? "no loops" : tr("closed to {:.1e} m and {:.1e} rad", r.metres, r.radians);
      break;
    case LoopStatus::singular:
      text = tr("closed, and singular: at a dead point (smallest pivot {:.1e})", r.pivot);
      break;
    case LoopStatus::out_of_reach:
      text = tr("out of reach: the nearest pose is open by {:.3g} mm and {:.3g} degrees", 1e3 * r.metres,
                r.radians * 180 / portable::pi);
      break;
  }
  if (r.closed() && r.redundant() > 0)
    text += tr("; over-constrained but consistent: {} of {} conditions follow from the others", r.redundant(),
               r.conditions);
  if (r.closed() && r.idle() > 0)
    text += fmt::format("; {}", r.idle() == 1 ? std::string("a degree of freedom is undetermined")
                                              : tr("{} degrees of freedom are undetermined", r.idle()));
  if (r.limit >= 0) {
    const auto i = std::size_t(r.limit);
    const bool angle = m.measures[i] == Measure::angle;
    const double by = angle ? 180 / portable::pi : 1e3;
    text += tr("; {} is beyond its limits ({:.4g} to {:.4g} {})", m.coordinates[i], by * m.low[i], by * m.high[i],
               angle ? "degrees" : "mm");
  }
  return text;
}

}  // namespace trocar::kinematics
