// Downhill on the squared distance to a surface. The surface is smooth between edges only, knots that are repeated as
// often as the degree, so that the descent stays within one such region at a time and passes on to the next where that
// goes further down.
#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/geometry/nurbs/closest.hpp>

namespace trocar::geometry::nurbs {
namespace {

constexpr int kDescentSteps = 60;
constexpr int kMostPassages = 64;     // from region to region, and off poles
constexpr double kStepSlack = 1e-15;  // of the domain, as are steps in the following
constexpr double kShortStep = 1e-6;
constexpr double kLongestStep = 0.25;

using Pair = std::array<double, 2>;

// Spans between two edges, or ends, or the seam of a periodic direction.
struct Region {
  int first = 0, last = 0;  // spans
  double low = 0.0, high = 0.0;
};

bool is_edge(const Knots& knots, int place) noexcept {
  int repeats = 1;
  for (int k = place; k > 0 && knots.values[k - 1] == knots.values[place]; --k) ++repeats;
  for (int k = place; knots.values[k + 1] == knots.values[place]; ++k) ++repeats;
  return repeats >= knots.degree;
}

Region region_around(const Knots& knots, int span) noexcept {
  Region r{span, span, 0.0, 0.0};
  while (r.first > knots.degree && !is_edge(knots, r.first)) --r.first;
  while (r.last + 1 < knots.functions() && !is_edge(knots, r.last + 1)) ++r.last;
  r.low = knots.values[r.first], r.high = knots.values[r.last + 1];
  return r;
}

// Half the squared distance, its slopes and their slopes, all by parameters in units of the domain.
struct Valley {
  Vec3d point;
  double height = 0.0;
  Pair slope{}, metric{};  // metric: squares of the derivatives
  double uu = 0, uv = 0, vv = 0, twist = 0;
};

class Descent {
 public:
  Descent(const Surface& surface, Vec3d p, double u, double v) noexcept : m_surface(surface), m_p(p) {
    m_at = {into_domain(surface.u, u), into_domain(surface.v, v)};
    for (int way = 0; way < 2; ++way) {
      m_scale[way] = knots(way).extent();
      m_region[way] = region_around(knots(way), span_of(knots(way), m_at[way]));
    }
    m_now = valley(m_at);
  }

  SurfaceFoot run() noexcept {
    for (int passage = 0; passage <= kMostPassages; ++passage) {
      for (int step = 0; step < kDescentSteps && go_down(); ++step) {
      }
      if (!pass_edge() && !leave_pole()) break;
    }
    return {into_domain(m_surface.u, m_at[0]), into_domain(m_surface.v, m_at[1]), m_now.point,
            std::sqrt(2.0 * m_now.height)};
  }

 private:
  const Knots& knots(int way) const noexcept { return way == 0 ? m_surface.u : m_surface.v; }
  int span(int way, double t) const noexcept {
    return std::clamp(span_of(knots(way), t), m_region[way].first, m_region[way].last);
  }

  Valley valley(Pair t) const noexcept {
    const SurfaceJet at = jet_in_spans(m_surface, span(0, t[0]), span(1, t[1]), t[0], t[1]);
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

  // At a border that the distance falls beyond, the parameter stays.
  bool held(int way) const noexcept {
    const double t = m_at[way], slope = m_now.slope[way];
    return (t <= m_region[way].low && slope >= 0.0) || (t >= m_region[way].high && slope <= 0.0);
  }

  // Newton where the distance bends upwards, else by the metric alone (Gauss and Newton), which always goes down. In
  // units of the domain.
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
      const double by = share * std::clamp(step[way], -kLongestStep, kLongestStep) * m_scale[way];
      t[way] = std::clamp(m_at[way] + by, m_region[way].low, m_region[way].high);
    }
    return t;
  }

  // What is left of the slope in lengths on the surface, squared, borders that hold left out.
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
    if (!(longest > kStepSlack)) return false;
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

  // Beyond a border the surface may continue, and the distance fall: true if so, and then that is where we are.
  bool pass_edge() noexcept {
    for (int way = 0; way < 2; ++way) {
      const Region old = m_region[way];
      const Pair at = m_at;
      const bool high = at[way] >= old.high, low = at[way] <= old.low;
      if (!high && !low) continue;
      const Knots& k = knots(way);
      const bool end = high ? old.high >= k.end() : old.low <= k.start();
      if (end && !k.periodic) continue;
      if (end) m_at[way] = high ? k.start() : k.end();
      int beside = high ? (end ? k.degree : old.last + 1) : (end ? k.functions() - 1 : old.first - 1);
      while (k.values[beside + 1] == k.values[beside]) beside += high ? 1 : -1;  // a span that has a length
      m_region[way] = region_around(k, beside);
      const Valley there = valley(m_at);
      const double fall = high ? -there.slope[way] : there.slope[way];
      if (fall > 1e-12 * std::sqrt(there.height * there.metric[way])) {
        m_now = there;
        return true;
      }
      m_region[way] = old, m_at = at;
    }
    return false;
  }

  // At a pole the other parameter says nothing any more: look whether some direction leads down, and take it.
  bool leave_pole() noexcept {
    constexpr int kDirections = 32;
    for (int way = 0; way < 2; ++way) {
      const Knots &along = knots(way), &around = knots(1 - way);
      const bool at_end = m_at[way] >= along.end(), at_start = m_at[way] <= along.start();
      if (along.periodic || !(at_start || at_end)) continue;
      if (m_now.metric[1 - way] > 1e-16 * m_now.metric[way]) continue;
      const Region old = m_region[1 - way];
      double steepest = 1e-9 * std::sqrt(m_now.height * m_now.metric[way]);
      Pair best = m_at;
      for (int k = 0; k < kDirections; ++k) {
        Pair t = m_at;
        t[1 - way] = around.start() + around.extent() * (k + 0.5) / kDirections;
        m_region[1 - way] = region_around(around, span_of(around, t[1 - way]));
        const Valley there = valley(t);
        const double fall = at_end ? there.slope[way] : -there.slope[way];
        if (!(fall > steepest)) continue;
        steepest = fall, best = t;
        best[way] += (at_end ? -1.0 : 1.0) * std::min(0.1, fall / there.metric[way]) * m_scale[way];
      }
      m_region[1 - way] = region_around(around, span_of(around, best[1 - way]));
      for (int half = 0; half < 20 && best[way] != m_at[way]; ++half) {
        best[way] = std::clamp(best[way], m_region[way].low, m_region[way].high);
        const Valley there = valley(best);
        if (there.height < m_now.height) {
          m_at = best, m_now = there;
          return true;
        }
        best[way] = 0.5 * (best[way] + m_at[way]);
      }
      m_region[1 - way] = old;
    }
    return false;
  }

  const Surface& m_surface;
  Vec3d m_p;
  Pair m_scale{}, m_at{};
  Region m_region[2];
  Valley m_now;
};

}  // namespace

SurfaceFoot closest_from(const Surface& surface, Vec3d p, double u, double v) noexcept {
  return Descent(surface, p, u, v).run();
}

}  // namespace trocar::geometry::nurbs
