#include <algorithm>
#include <cmath>

#include <trocar/tissue/elastostatic/field_kernels.hpp>
#include <trocar/tissue/elastostatic/load_case.hpp>

namespace trocar::tissue {
namespace {

constexpr double kLeastGive = 1e-9;  // [m/N] of a prescribed displacement: 1 nm per newton

constexpr Vec3d kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

/// One load case as it is worked on.
class Case {
 public:
  Case(const ComplianceView& compliance, double share, std::span<const PointTerm> terms, std::span<LoadPoint> points,
       LoadCaseWork& work) noexcept
      : m_c(compliance), m_share(share), m_terms(terms), m_points(points), m_work(work) {}

  /// Numbers the unknowns. @return points that found room
  int number() noexcept {
    int taken = 0;
    m_n = 0;
    for (; taken < int(m_points.size()); ++taken) {
      const int more = m_points[std::size_t(taken)].unknowns();
      if (m_n + more > kMostUnknowns) break;
      for (int axis = 0; axis < more; ++axis, ++m_n) {
        m_work.point[std::size_t(m_n)] = taken;
        m_work.axis[std::size_t(m_n)] = axis;
      }
    }
    return taken;
  }

  void ask(std::span<const Vec3d> now) noexcept {
    for (int i = 0; i < m_n; ++i) {
      const LoadPoint& p = point(i);
      m_work.want[std::size_t(i)] = dot(direction(i), p.want - now[std::size_t(m_work.point[std::size_t(i)])]);
    }
    note_what_is_asked();
    if (m_work.asked != m_work.made_for) {
      fill();
      m_work.made_for = m_work.asked;
      m_work.made = 0;
    }
  }

  /// Forces with an active set: contacts that would pull are left out, those left out that are too deep come back.
  void balance() noexcept {
    m_active = 0;
    for (int i = 0; i < m_n; ++i) m_work.active[std::size_t(m_active++)] = i;
    for (int round = 0; round < kMostRounds; ++round) {
      find_forces();
      if (!let_go_of_those_that_pull() && (round + 2 >= kMostRounds || !take_back_one())) return;
    }
    for (int i = 0; i < m_n; ++i)  // the set did not settle: no contact pulls, all the same
      if (point(i).one_sided) m_work.force[std::size_t(i)] = std::max(m_work.force[std::size_t(i)], 0.0);
  }

  void give() noexcept {
    for (LoadPoint& p : m_points) p.force = {};
    for (int i = 0; i < m_n; ++i) {
      LoadPoint& p = point(i);
      p.force += m_work.force[std::size_t(i)] * direction(i);
    }
  }

 private:
  LoadPoint& point(int i) const noexcept { return m_points[std::size_t(m_work.point[std::size_t(i)])]; }
  Vec3d direction(int i) const noexcept {
    const LoadPoint& p = point(i);
    return p.along() ? p.dir : kAxes[m_work.axis[std::size_t(i)]];
  }
  double give_of(int i) const noexcept { return std::max(point(i).give, kLeastGive); }
  double& a(int i, int j) const noexcept { return m_work.compliance[std::size_t(j) * kMostUnknowns + std::size_t(i)]; }

  void note_what_is_asked() noexcept {
    std::vector<double>& key = m_work.asked;
    key.clear();
    key.push_back(m_share);
    key.push_back(m_n);
    int last = -1;
    for (int i = 0; i < m_n; ++i) {
      if (m_work.point[std::size_t(i)] == last) continue;
      last = m_work.point[std::size_t(i)];
      const LoadPoint& p = point(i);
      for (const double x : {p.give, p.dir.x, p.dir.y, p.dir.z}) key.push_back(x);
      for (int t = p.first; t < p.first + p.count; ++t) {
        key.push_back(m_terms[std::size_t(t)].slot);
        key.push_back(double(m_terms[std::size_t(t)].weight));
      }
    }
  }

  /// W_p C W_q^T, of two points.
  void between(const LoadPoint& p, const LoadPoint& q, double (&block)[3][3]) const noexcept {
    for (auto& row : block)
      for (double& x : row) x = 0;
    for (int j = q.first; j < q.first + q.count; ++j) {
      const PointTerm& to = m_terms[std::size_t(j)];
      for (int b = 0; b < 3; ++b) {
        const float* column = m_c.column(to.slot, b);
        for (int i = p.first; i < p.first + p.count; ++i) {
          const PointTerm& from = m_terms[std::size_t(i)];
          const double w = double(from.weight) * double(to.weight);
          for (int r = 0; r < 3; ++r) block[r][b] += w * double(column[3 * from.slot + r]);
        }
      }
    }
  }

  void fill() noexcept {
    double block[3][3];
    for (int j = 0; j < m_n; j += point(j).unknowns())
      for (int i = j; i < m_n; i += point(i).unknowns()) {
        const LoadPoint &p = point(i), &q = point(j);
        between(p, q, block);
        if (!p.along() && !q.along()) {
          for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 3; ++x) a(i + x, j + y) = m_share * block[x][y];
          continue;
        }
        for (int y = 0; y < q.unknowns(); ++y)
          for (int x = 0; x < p.unknowns(); ++x) {
            const Vec3d to = direction(j + y), from = direction(i + x);
            double sum = 0;
            for (int r = 0; r < 3; ++r) sum += from[r] * (block[r][0] * to.x + block[r][1] * to.y + block[r][2] * to.z);
            a(i + x, j + y) = m_share * sum;
          }
      }
    for (int j = 0; j < m_n; ++j)
      for (int i = 0; i < j; ++i) a(i, j) = a(j, i);
  }

  void find_forces() noexcept {
    const bool all = m_active == m_n;
    if (!all || m_work.made != m_n) {
      m_work.made = 0;
      for (int j = 0; j < m_active; ++j) {
        const int q = m_work.active[std::size_t(j)];
        double* const column = m_work.factor.data() + std::size_t(j) * kMostUnknowns;
        for (int i = j; i < m_active; ++i) column[i] = a(m_work.active[std::size_t(i)], q);
        column[j] += give_of(q);
      }
      const bool sound = field_kernels().factorise(m_active, kMostUnknowns, m_work.factor.data(), m_work.turned.data());
      if (sound && all) m_work.made = m_n;
      if (!sound) {  // points so near each other that rounding decides: no force rather than any
        std::fill_n(m_work.force.begin(), m_n, 0.0);
        return;
      }
    }
    for (int i = 0; i < m_active; ++i)
      m_work.gap[std::size_t(i)] = m_work.want[std::size_t(m_work.active[std::size_t(i)])];
    field_kernels().substitute(m_active, kMostUnknowns, m_work.factor.data(), m_work.turned.data(), m_work.gap.data());
    std::fill_n(m_work.force.begin(), m_n, 0.0);
    for (int i = 0; i < m_active; ++i)
      m_work.force[std::size_t(m_work.active[std::size_t(i)])] = m_work.gap[std::size_t(i)];
  }

  bool let_go_of_those_that_pull() noexcept {
    int kept = 0;
    for (int i = 0; i < m_active; ++i) {
      const int u = m_work.active[std::size_t(i)];
      if (point(u).one_sided && m_work.force[std::size_t(u)] < 0)
        m_work.force[std::size_t(u)] = 0;
      else
        m_work.active[std::size_t(kept++)] = u;
    }
    const bool any = kept < m_active;
    m_active = kept;
    return any;
  }

  /// The one that is deepest. In order, so that the set has one way to go.
  bool take_back_one() noexcept {
    int deepest = -1;
    double most = 1e-7;  // [m] no matter
    for (int i = 0, at = 0; i < m_n; ++i) {
      if (at < m_active && m_work.active[std::size_t(at)] == i) {
        ++at;
        continue;
      }
      double gap = m_work.want[std::size_t(i)];
      for (int j = 0; j < m_active; ++j) {
        const int u = m_work.active[std::size_t(j)];
        gap -= a(i, u) * m_work.force[std::size_t(u)];
      }
      if (gap > most) most = gap, deepest = i;
    }
    if (deepest < 0) return false;
    int at = m_active++;
    for (; at > 0 && m_work.active[std::size_t(at - 1)] > deepest; --at)
      m_work.active[std::size_t(at)] = m_work.active[std::size_t(at - 1)];
    m_work.active[std::size_t(at)] = deepest;
    return true;
  }

  const ComplianceView& m_c;
  const double m_share;
  const std::span<const PointTerm> m_terms;
  const std::span<LoadPoint> m_points;
  LoadCaseWork& m_work;
  int m_n = 0, m_active = 0;
};

}  // namespace

LoadCaseWork make_load_case_work(int most_terms) {
  LoadCaseWork w;
  const std::size_t n = kMostUnknowns;
  for (std::vector<double>* v : {&w.compliance, &w.factor, &w.turned}) v->resize(n * n);
  for (std::vector<double>* v : {&w.want, &w.force, &w.gap}) v->resize(n);
  for (std::vector<std::int32_t>* v : {&w.point, &w.axis, &w.active}) v->resize(n);
  for (std::vector<double>* v : {&w.made_for, &w.asked}) v->reserve(2 + 4 * n + 2 * std::size_t(most_terms));
  return w;
}

int solve(const ComplianceView& compliance, double share, std::span<const PointTerm> terms, std::span<const Vec3d> now,
          std::span<LoadPoint> points, LoadCaseWork& work) noexcept {
  Case load_case(compliance, share, terms, points, work);
  const int taken = load_case.number();
  load_case.ask(now);
  load_case.balance();
  load_case.give();
  return taken;
}

}  // namespace trocar::tissue
