#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <trocar/geometry/nurbs/closest.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kSurfaceSteps = 60;
constexpr int kLeavingPole = 4;       // times a pole may be left
constexpr double kStepSlack = 1e-15;  // of the domain, as are steps in the following
constexpr double kShortStep = 1e-6;

using Pair = std::array<double, 2>;  // of parameters, in units of the domain's extents

// Half the squared distance, its slopes and their slopes, all by parameters in units of the domain.
struct Valley {
  Vec3d point;
  double height = 0.0;
  Pair slope{}, metric{};  // metric: squares of the derivatives
  double uu = 0, uv = 0, vv = 0, twist = 0;
};

class Descent {
 public:
  Descent(const Surface& surface, Vec3d p, double u, double v) noexcept
      : m_surface(surface), m_p(p), m_scale{surface.u.extent(), surface.v.extent()} {
    m_at = {(into_domain(surface.u, u) - surface.u.start()) / m_scale[0],
            (into_domain(surface.v, v) - surface.v.start()) / m_scale[1]};
  }

  SurfaceFoot run() noexcept {
    m_now = valley(m_at);
    for (int leave = 0; leave <= kLeavingPole; ++leave) {
      for (int step = 0; step < kSurfaceSteps && go_down(); ++step) {
      }
      if (!leave_pole()) break;
    }
    return {u_of(m_at), v_of(m_at), m_now.point, std::sqrt(2.0 * m_now.height)};
  }

 private:
  const Knots& knots(int way) const noexcept { return way == 0 ? m_surface.u : m_surface.v; }
  // Exactly the ends where it is them.
  double along(int way, double t) const noexcept {
    if (!knots(way).periodic && t >= 1.0) return knots(way).end();
    return into_domain(knots(way), knots(way).start() + t * m_scale[way]);
  }
  double u_of(Pair t) const noexcept { return along(0, t[0]); }
  double v_of(Pair t) const noexcept { return along(1, t[1]); }

  Valley valley(Pair t) const noexcept {
    const SurfaceJet at = jet(m_surface, u_of(t), v_of(t));
    const Vec3d du = m_scale[0] * at.du, dv = m_scale[1] * at.dv, away = at.point - m_p;
    Valley here;
    here.point = at.point;
    here.height = 0.5 * dot(away, away);
    here.slope = {dot(away, du), dot(away, dv)};
    here.metric = {dot(du, du), dot(dv, dv)};
    here.twist = dot(du, dv);
    here.uu = here.metric[0] + m_scale[0] * m_scale[0] * dot(away, at.duu);
    here.uv = here.twist + m_scale[0] * m_scale[1] * dot(away, at.duv);
    here.vv = here.metric[1] + m_scale[1] * m_scale[1] * dot(away, at.dvv);
    return here;
  }

  // At an end that the distance falls beyond, the parameter stays.
  bool held(int way) const noexcept {
    if (knots(way).periodic) return false;
    return (m_at[way] <= 0.0 && m_now.slope[way] >= 0.0) || (m_at[way] >= 1.0 && m_now.slope[way] <= 0.0);
  }

  // Newton where the distance bends upwards, else by the metric alone (Gauss and Newton), which always goes down.
  Pair wished_step() const noexcept {
    const bool hold_u = held(0), hold_v = held(1);
    double a = m_now.uu, b = m_now.uv, c = m_now.vv;
    const double floor = 1e-14 * (m_now.metric[0] + m_now.metric[1]);
    const bool bowl = a > 0.0 && c > 0.0 && a * c - b * b > 1e-6 * a * c;
    if (!bowl) a = m_now.metric[0] + floor, b = m_now.twist, c = m_now.metric[1] + floor;
    if (!bowl && !(a * c - b * b > 1e-6 * a * c)) b = 0.0;
    if (hold_u && hold_v) return {0.0, 0.0};
    if (hold_u) return {0.0, c > 0.0 ? -m_now.slope[1] / c : 0.0};
    if (hold_v) return {a > 0.0 ? -m_now.slope[0] / a : 0.0, 0.0};
    const double whole = a * c - b * b;
    if (!(whole > 0.0)) return {0.0, 0.0};
    return {(b * m_now.slope[1] - c * m_now.slope[0]) / whole, (b * m_now.slope[0] - a * m_now.slope[1]) / whole};
  }

  Pair moved(Pair step, double share) const noexcept {
    Pair t;
    for (int way = 0; way < 2; ++way) {
      t[way] = m_at[way] + share * std::clamp(step[way], -0.25, 0.25);
      if (!knots(way).periodic) t[way] = std::clamp(t[way], 0.0, 1.0);
    }
    return t;
  }

  // What is left of the slope in lengths on the surface, squared, ends that hold left out.
  double steepness() const noexcept {
    double sum = 0.0;
    for (int way = 0; way < 2; ++way)
      if (!held(way) && m_now.metric[way] > 0.0) sum += m_now.slope[way] * m_now.slope[way] / m_now.metric[way];
    return sum;
  }

  // A step so short that rounding hides by how much it lowers the distance is judged by the slope.
  bool settle(Pair step) noexcept {
    const Pair at = m_at;
    const Valley now = m_now;
    const double before = steepness();
    m_at = moved(step, 1.0), m_now = valley(m_at);
    if (steepness() < before) return true;
    m_at = at, m_now = now;
    return false;
  }

  // One step that lowers the distance; false where none does any more.
  bool go_down() noexcept {
    const Pair step = wished_step();
    const double longest = std::max(std::fabs(step[0]), std::fabs(step[1]));
    if (longest <= kStepSlack) return false;
    if (longest <= kShortStep) return settle(step);
    for (double share = 1.0; share > 1e-4; share *= 0.5) {
      const Pair next = moved(step, share);
      const Valley there = valley(next);
      if (there.height < m_now.height) {
        m_at = next, m_now = there;
        return true;
      }
    }
    return false;
  }

  // At a pole the other parameter says nothing any more: look whether some direction leads down, and take it.
  bool leave_pole() noexcept {
    constexpr int kDirections = 32;
    for (int way = 0; way < 2; ++way) {
      const bool at_end = m_at[way] >= 1.0, at_start = m_at[way] <= 0.0;
      if (knots(way).periodic || !(at_start || at_end)) continue;
      if (m_now.metric[1 - way] > 1e-16 * m_now.metric[way]) continue;
      double steepest = 1e-9 * std::sqrt(m_now.height * m_now.metric[way]);
      Pair best = m_at;
      for (int k = 0; k < kDirections; ++k) {
        Pair t = m_at;
        t[1 - way] = (k + 0.5) / kDirections;
        const Valley there = valley(t);
        const double fall = at_end ? there.slope[way] : -there.slope[way];
        if (!(fall > steepest)) continue;
        steepest = fall, best = t;
        best[way] += (at_end ? -1.0 : 1.0) * std::min(0.1, fall / there.metric[way]);
      }
      for (int half = 0; half < 20 && !(best == m_at); ++half) {
        const Valley there = valley(best);
        if (there.height < m_now.height) {
          m_at = best, m_now = there;
          return true;
        }
        best[way] = 0.5 * (best[way] + m_at[way]);
      }
    }
    return false;
  }

  const Surface& m_surface;
  Vec3d m_p;
  Pair m_scale, m_at{};
  Valley m_now;
};

std::vector<double> sample_parameters(const Knots& knots) {
  const std::vector<double> spans = breaks(knots);
  std::vector<double> samples;
  const int each = std::max(2, std::min(knots.degree + 1, 1 + 64 / static_cast<int>(spans.size())));
  for (std::size_t s = 0; s + 1 < spans.size(); ++s)
    for (int k = 0; k < each; ++k) samples.push_back(spans[s] + (spans[s + 1] - spans[s]) * k / each);
  if (!knots.periodic) samples.push_back(spans.back());
  return samples;
}

}  // namespace

SurfaceFoot closest_from(const Surface& surface, Vec3d p, double u, double v) noexcept {
  return Descent(surface, p, u, v).run();
}

ClosestOnSurface::ClosestOnSurface(const Surface& surface) : m_surface(surface) {
  require_valid(surface, "closest");
  m_u = sample_parameters(surface.u), m_v = sample_parameters(surface.v);
  for (double v : m_v)
    for (double u : m_u) m_points.push_back(point(surface, u, v));
}

bool ClosestOnSurface::is_lowest_around(const std::vector<double>& distance2, int i, int j) const {
  const int nu = static_cast<int>(m_u.size()), nv = static_cast<int>(m_v.size());
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      int a = i + di, b = j + dj;
      if (m_surface.u.periodic) a = (a + nu) % nu;
      if (m_surface.v.periodic) b = (b + nv) % nv;
      if (a < 0 || a >= nu || b < 0 || b >= nv) continue;
      const int other = a + nu * b, own = i + nu * j;
      if (distance2[other] < distance2[own] || (distance2[other] == distance2[own] && other < own)) return false;
    }
  return true;
}

SurfaceFoot ClosestOnSurface::find(Vec3d p) const {
  constexpr std::size_t kMostStarts = 6;
  if (!finite(p)) throw std::invalid_argument("closest: the point is not a number");
  std::vector<double> distance2(m_points.size());
  for (std::size_t i = 0; i < m_points.size(); ++i) distance2[i] = dot(m_points[i] - p, m_points[i] - p);
  const int nu = static_cast<int>(m_u.size()), nv = static_cast<int>(m_v.size());
  std::vector<std::pair<double, int>> starts;
  for (int j = 0; j < nv; ++j)
    for (int i = 0; i < nu; ++i)
      if (is_lowest_around(distance2, i, j)) starts.emplace_back(distance2[i + nu * j], i + nu * j);
  std::sort(starts.begin(), starts.end());
  SurfaceFoot best;
  for (std::size_t s = 0; s < std::min(starts.size(), kMostStarts); ++s) {
    const SurfaceFoot foot = closest_from(m_surface, p, m_u[starts[s].second % nu], m_v[starts[s].second / nu]);
    if (s == 0 || foot.distance < best.distance) best = foot;
  }
  return best;
}

SurfaceFoot closest(const Surface& surface, Vec3d p) { return ClosestOnSurface(surface).find(p); }

}  // namespace trocar::geometry::nurbs
