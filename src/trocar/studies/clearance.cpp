#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <trocar/studies/clearance.hpp>
#include <trocar/studies/halton.hpp>
#include <trocar/studies/handles.hpp>
#include <trocar/studies/link_pairs.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr int kMostTries = 20;        // for each pose within limits that is wanted
constexpr int kPlainSequence = 8;     // freedoms up to which Halton's sequence fills a cube as it is
constexpr std::int64_t kLeap = 1009;  // beyond, every so many of its points; no base divides it [Kocis & Whiten 1997]

/// Without drives, coordinates lead that loops leave free: within their limits, angles without limits a whole turn.
Mechanism led(const Mechanism& m) {
  Mechanism out = m;
  if (!m.drives.empty()) return out;
  std::vector<char> follows(std::size_t(m.u_count()), 0);
  if (m.rows > 0) {
    LoopWork work(m);
    std::vector<double> u = m.start_u();
    hold(work, {});
    if (!close(m, u, work).closed()) return out;
    for (const int column : branch_at(m, u, work).columns) follows[std::size_t(column)] = 1;
  }
  for (int u = 0; u < m.u_count(); ++u) {
    const auto q = std::size_t(m.independent[std::size_t(u)]);
    const bool limited = m.low[q] > -kinematics::kNoLimit && m.high[q] < kinematics::kNoLimit;
    if (follows[std::size_t(u)] || (!limited && m.measures[q] != Measure::angle)) continue;
    out.drives.push_back(
        {m.coordinates[q], u, 0, limited ? m.low[q] : -portable::pi, limited ? m.high[q] : portable::pi});
  }
  return out;
}

class ClearanceSweep {
 public:
  ClearanceSweep(const Mechanism& mechanism, const ClearanceOptions& options, int follow)
      : m(led(mechanism)),
        m_options(options),
        m_follow(follow),
        m_work(mechanism),
        m_u(mechanism.start_u()),
        m_links(mechanism, options.ignored) {
    for (const LinkPair& p : m_links.all()) m_pairs.push_back({{p.first, p.second, kFar, -kFar, {}, {}, false}, {}});
    for (const Drive& d : m.drives) m_out.drives.push_back(d.name);
  }

  ClearanceReport run() {
    hold_drives(m, m_work);
    const LoopReport first = close(m, m_u, m_work);
    if (!first.closed()) throw std::invalid_argument("the start: " + words(m, first));
    m_branch = branch_at(m, m_u, m_work);
    m_start = m_u;
    m_drawn = m_options.drawn.empty() ? m_links.drawn(m, m_work.pose) : m_options.drawn;
    if (m.drives.empty())
      look({}, true);
    else if (m.drives.size() == 1)
      along_the_drive();
    else
      at_many_handles();
    if (m_options.refine)
      for (std::size_t k = 0; k < m_pairs.size(); ++k)
        if (std::isfinite(m_pairs[k].out.least)) refine(k);
    return sorted();
  }

 private:
  struct Pair {
    PairClearance out;
    std::vector<double> u;  ///< the pose where it is least
  };

  double gap(std::size_t pair) const { return m_links.gap(m_links.all()[pair], m, m_work.pose, m_drawn); }

  /// Takes the pose where m_work stands.
  void look(const std::vector<double>& handles, bool there) {
    ++m_out.poses;
    if (m.drives.size() == 1) m_out.handles.push_back(handles[0]);
    m_out.reached += there;
    for (std::size_t k = 0; k < m_pairs.size(); ++k) {
      Pair& p = m_pairs[k];
      const double now = there ? gap(k) : std::numeric_limits<double>::quiet_NaN();
      if (m.drives.size() == 1) p.out.curve.push_back(std::isfinite(now) ? now : std::nan(""));
      if (there && now < p.out.least) {
        p.out.least = now;
        p.out.handles = handles;
        p.u = m_u;
      }
      if (there) p.out.most = std::max(p.out.most, now);
    }
    if (m_follow < 0 || m.drives.size() != 1) return;
    const Vec3d at = place(m.frames[std::size_t(m_follow)], m_work.pose).p;
    if (there && m_followed) m_out.path += length(at - m_before);
    m_before = at;
    m_followed = there;
  }

  /// To these handles from the pose u, which is then there. @return closed and within limits
  bool go(const std::vector<double>& handles) {
    if (m.rows == 0) {
      set_handles(m, handles, m_u);
      return close(m, m_u, m_work).limit < 0;
    }
    if (!move_handles(m, handles, m_u, m_branch, m_work).arrived()) return false;
    const LoopReport report = close(m, m_u, m_work);
    return report.closed() && report.limit < 0;
  }

  void along_the_drive() {
    go({0});
    for (int k = 0; k <= m_options.steps; ++k) {
      const std::vector<double> handles{double(k) / m_options.steps};
      const bool there = go(handles);
      look(handles, there);
    }
  }
  /// Until enough poses are within limits.
  void at_many_handles() {
    std::vector<double> handles(m.drives.size());
    const std::int64_t leap = int(handles.size()) > kPlainSequence ? kLeap : 1;
    for (int k = 0; m_out.reached < m_options.samples && k < kMostTries * m_options.samples; ++k) {
      for (std::size_t d = 0; d < handles.size(); ++d) handles[d] = halton(leap * (k + 1), int(d));
      m_u = m_start;
      const bool there = go(handles);
      look(handles, there);
    }
  }

  /// Compass search in the handles about the least pose.
  void refine(std::size_t pair) {
    Pair& p = m_pairs[pair];
    double step = m.drives.size() == 1 ? 1.0 / m_options.steps : 0.1;
    for (int round = 0; round < 60 && step > 1e-5; ++round) {
      bool better = false;
      for (std::size_t d = 0; d < m.drives.size(); ++d)
        for (const double by : {step, -step}) {
          std::vector<double> handles = p.out.handles;
          handles[d] = std::clamp(handles[d] + by, 0.0, 1.0);
          m_u = p.u;
          if (!go(handles)) continue;
          const double now = gap(pair);
          if (!(now < p.out.least)) continue;
          p.out.least = now;
          p.out.handles = handles;
          p.u = m_u;
          better = true;
        }
      if (!better) step *= 0.5;
    }
  }

  /// Neighbours are told of where they are in each other as they are not drawn; elsewhere they are meant to touch.
  ClearanceReport sorted() {
    m_out.least = kFar;
    for (std::size_t k = 0; k < m_pairs.size(); ++k) {
      PairClearance& p = m_pairs[k].out;
      const LinkPair& links = m_links.all()[k];
      p.beside_joint = links.neighbours();
      if (!std::isfinite(p.least) || (p.beside_joint && p.least >= -m_links.slack(links, m))) continue;
      (p.always() && !p.beside_joint && !m_options.strict ? m_out.joined : m_out.pairs).push_back(std::move(p));
    }
    std::stable_sort(m_out.pairs.begin(), m_out.pairs.end(),
                     [](const PairClearance& a, const PairClearance& b) { return a.least < b.least; });
    if (!m_out.pairs.empty()) m_out.least = m_out.pairs.front().least;
    return std::move(m_out);
  }

  const Mechanism m;
  const ClearanceOptions& m_options;
  int m_follow;
  LoopWork m_work;
  std::vector<double> m_u, m_start;
  LinkPairs m_links;
  std::vector<double> m_drawn;
  Branch m_branch;
  std::vector<Pair> m_pairs;
  Vec3d m_before;
  bool m_followed = false;
  ClearanceReport m_out;
};

}  // namespace

ClearanceReport clearance_over_motion(const Mechanism& m, const ClearanceOptions& options, int follow) {
  return ClearanceSweep(m, options, follow).run();
}

}  // namespace trocar::studies
