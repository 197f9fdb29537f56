#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/kinematics/loops/equations.hpp>

namespace trocar::kinematics {

Closure reach(const BodyFrame& frame, const Frame& wanted, unsigned directions) noexcept {
  Closure c;
  c.a.local = wanted;
  c.b = frame;
  set_directions(c, directions);
  return c;
}

Closure through(const BodyFrame& shaft, Vec3d port) noexcept {
  Closure c;
  c.a = shaft;
  c.b.local.p = port;
  set_directions(c, kTx | kTy);
  return c;
}

InverseWork::InverseWork(const Mechanism& m, int goals)
    : loops(m, goals),
      damped(m.rows + goals + m.u_count() + int(m.dependents.size()), m.u_count()),
      start(m.independent.size()),
      best(m.independent.size()),
      gradient(m.independent.size()),
      rhs(std::size_t(m.rows + goals + m.u_count()) + m.dependents.size()),
      kernel(m.independent.size()),
      own(m.independent) {
  for (const int i : m.dependents)
    for (int k = m.expand_start[std::size_t(i)]; k < m.expand_start[std::size_t(i) + 1]; ++k)
      own[std::size_t(m.expand[std::size_t(k)].u)] = -1;
}

namespace {

constexpr double kNear = 1e-5;  // residual from which Newton's steps end the work

/// Part `k` of a sequence that fills [0, 1) evenly, in the k-th prime's digits. [Halton 1960]
double halton(int index, int k) noexcept {
  constexpr int kPrimes[] = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43, 47, 53};
  const int prime = kPrimes[k % 16];
  double value = 0, digit = 1;
  for (int i = index + k / 16; i > 0; i /= prime) {
    digit /= prime;
    value += digit * (i % prime);
  }
  return value;
}

class Inverting {
 public:
  Inverting(const Mechanism& mechanism, std::span<const Closure> goals, std::span<double> u, InverseWork& work,
            const InverseOptions& options)
      : m(mechanism), m_goals(goals), m_u(u), w(work), m_options(options), m_rows(rows_of(m, goals)) {}

  InverseReport go() noexcept {
    InverseReport report;
    double least = 1e300;
    std::copy(m_u.begin(), m_u.end(), w.start.begin());
    while (report.attempts < m_options.attempts) {
      if (report.attempts > 0) another_start(report.attempts);
      ++report.attempts;
      keep_within();
      const double size = damped_steps(report);
      report.last = kinematics::close(m, m_u, w.loops, m_options.loops, m_goals);
      if (report.last.closed() && report.last.limit >= 0) mend_limits(report.last);
      if (report.reached()) return report;
      const double miss = report.last.closed() ? 0.5 * kNear : size;
      if (miss < least) {
        least = miss;
        std::copy(m_u.begin(), m_u.end(), w.best.begin());
      }
    }
    std::copy(w.best.begin(), w.best.end(), m_u.begin());
    report.last = kinematics::close(m, m_u, w.loops, m_options.loops, m_goals);
    return report;
  }

 private:
  int q_of(std::size_t k) const noexcept { return w.own[std::size_t(w.loops.free[k])]; }

  void another_start(int attempt) noexcept {
    for (std::size_t i = 0; i < m_u.size(); ++i) {
      const auto q = std::size_t(m.independent[i]);
      if (w.loops.held[i]) continue;
      const double part = halton(attempt, int(i));
      const bool angle = m.measures[q] == Measure::angle, limited = std::isfinite(m.low[q]) && std::isfinite(m.high[q]);
      const double around = w.start[i], reach = angle ? portable::pi : m.length;
      double low = limited ? m.low[q] : around - reach, high = limited ? m.high[q] : around + reach;
      if (angle && high - low > portable::two_pi) {
        const double middle = 0.5 * (low + high);
        low = middle - portable::pi;
        high = middle + portable::pi;
      }
      m_u[i] = low + part * (high - low);
    }
  }

  void keep_within() noexcept {
    list_free(w.loops);
    for (std::size_t k = 0; k < w.loops.free.size(); ++k)
      if (const int q = q_of(k); q >= 0) {
        double& x = m_u[std::size_t(w.loops.free[k])];
        x = std::clamp(x, m.low[std::size_t(q)], m.high[std::size_t(q)]);
      }
  }

  /// How far a coordinate that follows others is beyond its limits, scaled.
  double excess(int q) const noexcept {
    const auto i = std::size_t(q);
    const double x = w.loops.pose.q[i], unit = m.measures[i] == Measure::length ? m.length : 1;
    return (x > m.high[i] ? x - m.high[i] : x < m.low[i] ? x - m.low[i] : 0) / unit;
  }

  /// Residuals at u, and what is beyond limits that no step can be kept within.
  double size_at_u() noexcept {
    const double size = evaluate(m, m_u, w.loops, m_goals);
    double sum = size * size;
    for (const int q : m.dependents) sum += excess(q) * excess(q);
    return std::sqrt(sum);
  }

  void damped_step(double size, double damping) noexcept {
    LoopWork& l = w.loops;
    const int n = int(l.free.size()), limits = int(m.dependents.size()), rows = m_rows + n + limits;
    double* a = w.damped.matrix(rows, n);
    std::fill_n(a, rows * n, 0.0);
    std::fill(w.rhs.begin(), w.rhs.end(), 0.0);
    std::copy_n(l.r.begin(), m_rows, w.rhs.begin());
    const double diagonal = std::sqrt(damping) * std::min(1.0, size);
    for (int j = 0; j < n; ++j) {
      std::copy_n(l.slope.begin() + l.free[std::size_t(j)] * m_rows, m_rows, a + j * rows);
      a[j * rows + m_rows + j] = diagonal;
    }
    for (int k = 0; k < limits; ++k) {
      const int q = m.dependents[std::size_t(k)];
      const double over = excess(q);
      if (over == 0) continue;
      w.rhs[std::size_t(m_rows + n + k)] = over;
      const double unit = m.measures[std::size_t(q)] == Measure::length ? m.length : 1;
      for (int e = m.expand_start[std::size_t(q)]; e < m.expand_start[std::size_t(q) + 1]; ++e) {
        const Mechanism::Entry& entry = m.expand[std::size_t(e)];
        for (int j = 0; j < n; ++j)
          if (l.free[std::size_t(j)] == entry.u) a[j * rows + m_rows + n + k] = entry.ratio * m.scale(entry.u) / unit;
      }
    }
    w.damped.factor(1e-14);
    w.damped.solve(w.rhs.data(), l.step.data());
    std::copy(m_u.begin(), m_u.end(), l.trial.begin());
    for (int j = 0; j < n; ++j) {
      const int u = l.free[std::size_t(j)];
      m_u[std::size_t(u)] -= std::clamp(l.step[std::size_t(j)], -1.0, 1.0) * m.scale(u);
    }
    keep_within();
  }

  /// @return the residual's size where they end
  double damped_steps(InverseReport& report) noexcept {
    double size = size_at_u(), damping = 1e-2;
    bool fresh = true;
    for (int k = 0; k < m_options.iterations && size > kNear && !w.loops.free.empty(); ++k) {
      ++report.iterations;
      if (fresh) evaluate_slopes(m, w.loops, m_goals, m_rows);
      damped_step(size, damping);
      const double next = size_at_u();
      fresh = next < size;
      if (fresh) {
        damping = std::max(1e-9, 0.2 * damping);
        if (size - next < 1e-4 * size && damping < 1e-6) return next;  // a valley that ends elsewhere
        size = next;
      } else {
        damping *= 8;
        std::copy(w.loops.trial.begin(), w.loops.trial.end(), m_u.begin());
        size_at_u();
        if (damping > 1e6) return size;
      }
    }
    return size;
  }

  /// A closed pose is beyond a limit: by whole turns, then along what the goals leave free.
  void mend_limits(LoopReport& last) noexcept {
    for (std::size_t k = 0; k < w.loops.free.size(); ++k) {
      const int q = q_of(k);
      if (q < 0 || m.measures[std::size_t(q)] != Measure::angle) continue;
      double& x = m_u[std::size_t(w.loops.free[k])];
      while (x < m.low[std::size_t(q)] - 1e-12 && x + portable::two_pi <= m.high[std::size_t(q)]) x += portable::two_pi;
      while (x > m.high[std::size_t(q)] + 1e-12 && x - portable::two_pi >= m.low[std::size_t(q)]) x -= portable::two_pi;
    }
    last = kinematics::close(m, m_u, w.loops, m_options.loops, m_goals);
    for (int round = 0; round < 40 && last.closed() && last.limit >= 0 && last.idle() > 0; ++round) {
      const int n = int(w.loops.free.size());
      std::fill(w.gradient.begin(), w.gradient.end(), 0.0);
      for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
        const double q = w.loops.pose.q[i], slack = 1e-6 * (m.measures[i] == Measure::length ? m.length : 1);
        const double over = q > m.high[i] ? q - m.high[i] + slack : q < m.low[i] ? q - m.low[i] - slack : 0;
        if (over == 0) continue;
        const double unit = m.measures[i] == Measure::length ? m.length : 1;
        for (int e = m.expand_start[i]; e < m.expand_start[i + 1]; ++e) {
          const auto u = std::size_t(m.expand[std::size_t(e)].u);
          w.gradient[u] += m.expand[std::size_t(e)].ratio * m.scale(int(u)) / unit * (over / unit);
        }
      }
      std::fill(w.rhs.begin(), w.rhs.end(), 0.0);
      double along_all = 0;
      for (int k = 0; k < last.idle(); ++k) {
        w.loops.qr.null_vector(k, w.kernel.data());
        double along = 0;
        for (int j = 0; j < n; ++j)
          along += w.kernel[std::size_t(j)] * w.gradient[std::size_t(w.loops.free[std::size_t(j)])];
        for (int j = 0; j < n; ++j) w.rhs[std::size_t(j)] += along * w.kernel[std::size_t(j)];
        along_all += along * along;
      }
      double size = 0;
      for (const double g : w.gradient) size += g * g;
      if (!(along_all > 1e-12 * size)) return;
      // as far as would end the excess if it ended evenly, and not too far for the loops
      const double share = std::min(size / along_all, 0.3 / std::sqrt(along_all));
      for (int j = 0; j < n; ++j) {
        const int u = w.loops.free[std::size_t(j)];
        m_u[std::size_t(u)] -= share * w.rhs[std::size_t(j)] * m.scale(u);
      }
      last = kinematics::close(m, m_u, w.loops, m_options.loops, m_goals);
    }
  }

  const Mechanism& m;
  std::span<const Closure> m_goals;
  std::span<double> m_u;
  InverseWork& w;
  const InverseOptions& m_options;
  int m_rows;
};

}  // namespace

InverseReport inverse(const Mechanism& m, std::span<const Closure> goals, std::span<double> u, InverseWork& work,
                      const InverseOptions& options) noexcept {
  return Inverting(m, goals, u, work, options).go();
}

std::string words(const Mechanism& m, const InverseReport& r) {
  if (r.reached())
    return tr("reached to {:.1e} m and {:.1e} rad, in {} attempt{}", r.last.metres, r.last.radians, r.attempts,
              r.attempts == 1 ? "" : "s");
  return tr("not reached in {} attempts: {}", r.attempts, words(m, r.last));
}

}  // namespace trocar::kinematics
