#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <trocar/studies/clearance.hpp>
#include <trocar/studies/halton.hpp>
#include <trocar/studies/handles.hpp>
#include <trocar/studies/shape_distance.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Parts: bodies that nothing moves against each other have one number, that of the first of them.
std::vector<int> parts_of(const Mechanism& m) {
  std::vector<int> part(m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b)
    part[b] = b > 0 && m.bodies[b].motion == Motion::none ? part[std::size_t(m.bodies[b].parent)] : int(b);
  return part;
}

/// Without drives and loops coordinates with limits are what leads.
Mechanism led(const Mechanism& m) {
  Mechanism out = m;
  for (int u = 0; u < m.u_count() && m.drives.empty() && m.rows == 0; ++u) {
    const auto q = std::size_t(m.independent[std::size_t(u)]);
    if (std::isfinite(m.low[q]) && std::isfinite(m.high[q]))
      out.drives.push_back({m.coordinates[q], u, 0, m.low[q], m.high[q]});
  }
  return out;
}

class ClearanceSweep {
 public:
  ClearanceSweep(const Mechanism& mechanism, const ClearanceOptions& options, int follow)
      : m(led(mechanism)), m_options(options), m_follow(follow), m_work(mechanism), m_u(mechanism.start_u()) {
    list_pairs();
    for (const Drive& d : m.drives) m_out.drives.push_back(d.name);
  }

  ClearanceReport run() {
    hold_drives(m, m_work);
    const LoopReport first = close(m, m_u, m_work);
    if (!first.closed()) throw std::invalid_argument("the start: " + words(m, first));
    m_branch = branch_at(m, m_u, m_work);
    m_start = m_u;
    if (m.drives.empty())
      look({}, true);
    else if (m.drives.size() == 1)
      along_the_drive();
    else
      at_many_handles();
    if (m_options.refine)
      for (Pair& p : m_pairs)
        if (std::isfinite(p.out.least)) refine(p);
    return sorted();
  }

 private:
  struct Pair {
    PairClearance out;
    std::vector<std::pair<int, int>> shapes;
    double now = 0;
    std::vector<double> u;  ///< the pose where it is least
  };

  /// Bodies without mass between a joint's freedoms are the joint, not parts.
  bool neighbours(int a, int b) const {
    return std::find(m_joined.begin(), m_joined.end(), std::pair(std::min(a, b), std::max(a, b))) != m_joined.end();
  }
  void join(int a, int b) {
    if (a != b) m_joined.emplace_back(std::min(a, b), std::max(a, b));
  }

  void list_pairs() {
    const std::vector<int> part = parts_of(m);
    std::vector<int> link_of(m.bodies.size(), -1);
    for (std::size_t l = 0; l < m.links.size(); ++l) link_of[std::size_t(m.link_body[l])] = int(l);
    for (std::size_t b = 1; b < m.bodies.size(); ++b) {
      int parent = m.bodies[b].parent;
      while (link_of[std::size_t(parent)] < 0) parent = m.bodies[std::size_t(parent)].parent;
      if (link_of[b] >= 0) join(part[b], part[std::size_t(parent)]);
    }
    for (const Closure& c : m.closures) join(part[std::size_t(c.a.body)], part[std::size_t(c.b.body)]);
    for (std::size_t i = 0; i < m.shapes.size(); ++i)
      for (std::size_t k = i + 1; k < m.shapes.size(); ++k) {
        const int a = m.shapes[i].body, b = m.shapes[k].body;
        const int first = link_of[std::size_t(a)], second = link_of[std::size_t(b)];
        const int pa = part[std::size_t(a)], pb = part[std::size_t(b)];
        if (pa == pb || neighbours(pa, pb) || ignored(first, second)) continue;
        pair_of(first, second).shapes.emplace_back(int(i), int(k));
      }
  }
  bool ignored(int a, int b) const {
    return std::any_of(m_options.ignored.begin(), m_options.ignored.end(), [&](const std::pair<int, int>& p) {
      return (p.first == a && p.second == b) || (p.first == b && p.second == a);
    });
  }
  Pair& pair_of(int first, int second) {
    for (Pair& p : m_pairs)
      if (p.out.first == first && p.out.second == second) return p;
    m_pairs.push_back({});
    m_pairs.back().out = {first, second, kFar, -kFar, {}, {}};
    return m_pairs.back();
  }

  double of(const Pair& p) const {
    double least = kFar;
    for (const auto& [i, k] : p.shapes)
      least = std::min(least, clearance(placed(m.shapes[std::size_t(i)], m_work.pose),
                                        placed(m.shapes[std::size_t(k)], m_work.pose)));
    return least;
  }

  /// Takes the pose where m_work stands.
  void look(const std::vector<double>& handles, bool there) {
    ++m_out.poses;
    if (m.drives.size() == 1) m_out.handles.push_back(handles[0]);
    m_out.reached += there;
    for (Pair& p : m_pairs) {
      const double now = there ? of(p) : std::numeric_limits<double>::quiet_NaN();
      if (m.drives.size() == 1) p.out.curve.push_back(now);
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
  void at_many_handles() {
    std::vector<double> handles(m.drives.size());
    for (int k = 0; k < m_options.samples; ++k) {
      for (std::size_t d = 0; d < handles.size(); ++d) handles[d] = halton(k + 1, int(d));
      m_u = m_start;
      const bool there = go(handles);
      look(handles, there);
    }
  }

  /// Compass search in the handles about the least pose.
  void refine(Pair& p) {
    double step = m.drives.size() == 1 ? 1.0 / m_options.steps : 0.1;
    for (int round = 0; round < 60 && step > 1e-5; ++round) {
      bool better = false;
      for (std::size_t d = 0; d < m.drives.size(); ++d)
        for (const double by : {step, -step}) {
          std::vector<double> handles = p.out.handles;
          handles[d] = std::clamp(handles[d] + by, 0.0, 1.0);
          m_u = p.u;
          if (!go(handles)) continue;
          const double now = of(p);
          if (!(now < p.out.least)) continue;
          p.out.least = now;
          p.out.handles = handles;
          p.u = m_u;
          better = true;
        }
      if (!better) step *= 0.5;
    }
  }

  ClearanceReport sorted() {
    m_out.least = kFar;
    for (Pair& p : m_pairs)
      if (std::isfinite(p.out.least))
        (p.out.always() && !m_options.strict ? m_out.joined : m_out.pairs).push_back(std::move(p.out));
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
  Branch m_branch;
  std::vector<std::pair<int, int>> m_joined;
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
