#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/contacts.hpp>

namespace trocar::suture {
namespace {

constexpr double kSoftness = 0.02;   ///< of nearest places
constexpr double kOnset = 0.02;      ///< overlap over which a press sets in, as a share of the thickness
constexpr double kHardening = 0.15;  ///< overlap at which it is twice as stiff as it begins
constexpr double kAllowed = 0.25;    ///< overlap that a solve may bring, as a share of the thickness
constexpr double kDeeper = 0.1;      ///< what a deeper one may grow by
constexpr double kKeptApart = 0.5;   ///< of the distance of two axes that a solve may take at the very most

void widen(Vec3d& low, Vec3d& high, Vec3d p) {
  for (int k = 0; k < 3; ++k) {
    low[k] = p[k] < low[k] ? p[k] : low[k];
    high[k] = p[k] > high[k] ? p[k] : high[k];
  }
}
bool boxes_within(const Vec3d& low, const Vec3d& high, const Vec3d& other_low, const Vec3d& other_high, double reach) {
  return low.x - other_high.x < reach && other_low.x - high.x < reach && low.y - other_high.y < reach &&
         other_low.y - high.y < reach && low.z - other_high.z < reach && other_low.z - high.z < reach;
}

struct Corners {
  Vec3d low, high;
};
Corners around(const Vec3d& a, const Vec3d& b) {
  Corners c{a, a};
  widen(c.low, c.high, b);
  return c;
}
bool within(const Corners& a, const Corners& b, double reach) {
  return boxes_within(a.low, a.high, b.low, b.high, reach);
}

/// f(element, obstacle), ordered, of those whose boxes are nearer than reach(obstacle).
template <class Reach, class F>
void visit_near_obstacles(const ThreadModel& m, const ThreadState& s, std::span<const Obstacle> given, ThreadWork& w,
                          const Reach& reach, const F& f) {
  const int elements = m.nodes - 1, obstacles = std::min(int(given.size()), int(m.obstacles));
  for (int first = 0; first < elements; first += kGroup) {
    const int end = std::min(elements, first + kGroup);
    Corners group{s.x[first], s.x[first]};
    for (int i = first + 1; i <= end; ++i) widen(group.low, group.high, s.x[i]);
    int count = 0;
    for (int o = 0; o < obstacles; ++o)
      if (s.obstacles[o].active && within(group, around(s.obstacles[o].a, s.obstacles[o].b), reach(o)))
        w.close[count++] = o;
    for (int a = first; a < end && count > 0; ++a) {
      if (!s.alive[a]) continue;
      const Corners element = around(s.x[a], s.x[a + 1]);
      for (int k = 0; k < count; ++k) {
        const int o = w.close[k];
        if (!given[o].spares(a) && within(element, around(s.obstacles[o].a, s.obstacles[o].b), reach(o))) f(a, o);
      }
    }
  }
}

/// Where two elements are nearest, and how far.
struct Nearness {
  double s, t, distance;
  Vec3d normal;  ///< unit, from the second to the first
};
Nearness nearness(const ThreadState& st, int a, int b, double softness) {
  const Vec3d p = st.x[a], d = st.x[a + 1] - p, q = st.x[b], e = st.x[b + 1] - q;
  const NearestPlaces at = nearest_places(p, d, q, e, softness);
  const Vec3d between = p + at.s * d - q - at.t * e;
  const double r = length(between);
  return {at.s, at.t, r, r > 1e-12 ? between / r : any_perpendicular(normalised(d))};
}

const ElementRub* find_rub(const ElementRub* first, const ElementRub* last, int a, int b) {
  const ElementRub* const at = std::lower_bound(
      first, last, std::pair{a, b},
      [](const ElementRub& r, std::pair<int, int> k) { return r.a < k.first || (r.a == k.first && r.b < k.second); });
  return at != last && at->a == a && at->b == b ? at : nullptr;
}

/// A contact that slides along continues as its neighbour's: with its strain.
void inherit(const ElementRub* first, const ElementRub* last, bool both, Touch& touch) {
  const ElementRub* best = find_rub(first, last, touch.a, touch.b);
  if (!best) {
    constexpr int kSteps[][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}};
    for (const auto& step : kSteps) {
      if (!both && step[1] != 0) continue;
      const ElementRub* const other = find_rub(first, last, touch.a + step[0], touch.b + step[1]);
      if (other && (!best || other->press > best->press)) best = other;
    }
  }
  if (!best) return;
  touch.strain = best->rub.strain - dot(best->rub.strain, touch.normal) * touch.normal;
  touch.reached = best->rub.reached;
}

/// What of a strain is beyond the bound is gone.
void keep_bound(Touch& touch) {
  const double size = length(touch.strain);
  if (size > touch.bound) touch.strain *= touch.bound / size;
}

}  // namespace

void set_press(Touch& touch, double stiffness, double thickness, double gap) noexcept {
  const double onset = kOnset * thickness, overlap = -gap;
  const double force =
      overlap < onset ? stiffness * (overlap + onset) * (overlap + onset) / (4 * onset) : stiffness * overlap;
  const double slope = overlap < onset ? stiffness * (overlap + onset) / (2 * onset) : stiffness;
  const double deep = overlap > 0 ? overlap / (kHardening * thickness) : 0;
  touch.press = force * (1 + deep * deep);
  touch.stiffness = slope * (1 + deep * deep) + force * 2 * deep / (kHardening * thickness);
}

int find_near(const ThreadModel& m, const ThreadState& s, double reach, ThreadWork& w) noexcept {
  const int elements = m.nodes - 1, groups = (elements + kGroup - 1) / kGroup;
  for (int g = 0; g < groups; ++g) {
    const int last = std::min(elements, (g + 1) * kGroup);
    Vec3d low = s.x[g * kGroup], high = low;
    for (int i = g * kGroup + 1; i <= last; ++i) widen(low, high, s.x[i]);
    w.box[2 * g] = low, w.box[2 * g + 1] = high;
  }
  int count = 0;
  for (int g = 0; g < groups; ++g)
    for (int h = g; h < groups; ++h) {
      if (!boxes_within(w.box[2 * g], w.box[2 * g + 1], w.box[2 * h], w.box[2 * h + 1], reach)) continue;
      const int a_end = std::min(elements, (g + 1) * kGroup), b_end = std::min(elements, (h + 1) * kGroup);
      for (int a = g * kGroup; a < a_end; ++a) {
        if (!s.alive[a]) continue;
        Vec3d low = s.x[a], high = low;
        widen(low, high, s.x[a + 1]);
        if (!boxes_within(low, high, w.box[2 * h], w.box[2 * h + 1], reach)) continue;
        for (int b = std::max(h * kGroup, a + 2); b < b_end; ++b) {
          if (!s.alive[b]) continue;
          Vec3d other_low = s.x[b], other_high = other_low;
          widen(other_low, other_high, s.x[b + 1]);
          if (!boxes_within(low, high, other_low, other_high, reach)) continue;
          if (nearness(s, a, b, 0).distance >= reach) continue;
          w.keys[count++] = (std::int64_t(a) << 32) + b;
        }
      }
    }
  std::sort(w.keys.begin(), w.keys.begin() + count);
  for (int k = 0; k < count; ++k) w.near[k] = {std::int32_t(w.keys[k] >> 32), std::int32_t(w.keys[k] & 0xffffffff)};
  return count;
}

int find_touching(const ThreadModel& m, const ThreadState& s, int near, ThreadWork& w, bool& full,
                  double& closest) noexcept {
  const double thickness = m.stuff.diameter;
  const ElementRub* const first = s.self.data();
  const ElementRub* const last = first + s.self_count;
  int count = 0;
  for (int k = 0; k < near; ++k) {
    const auto [a, b] = w.near[k];
    if (b - a < m.apart) continue;
    const Nearness at = nearness(s, a, b, kSoftness);
    if (at.distance - thickness >= kOnset * thickness) continue;
    closest = std::min(closest, nearness(s, a, b, 0).distance);
    if (count == m.contacts) {
      full = true;
      break;
    }
    Touch& touch = w.self[count++];
    touch = {.a = a, .b = b, .s = at.s, .t = at.t, .normal = at.normal};
    set_press(touch, m.contact_stiffness, thickness, at.distance - thickness);
    inherit(first, last, true, touch);
    set_friction(touch, m.stuff.friction_thread, 0.5 * m.contact_stiffness);
    keep_bound(touch);
  }
  return count;
}

double closest_of(const ThreadState& s, int self, const ThreadWork& w) noexcept {
  double closest = 1e9;
  for (int k = 0; k < self; ++k) closest = std::min(closest, nearness(s, w.self[k].a, w.self[k].b, 0).distance);
  return closest;
}

int find_obstacles(const ThreadModel& m, const ThreadState& s, std::span<const Obstacle> given, ThreadWork& w,
                   bool& full) noexcept {
  const double radius = 0.5 * m.stuff.diameter;
  const ElementRub* const first = s.touch.data();
  const ElementRub* const last = first + s.touch_count;
  int count = 0;
  const auto reach = [&](int o) { return 1.1 * (given[o].radius + radius); };
  visit_near_obstacles(m, s, given, w, reach, [&](int a, int o) {
    const ObstacleState& seen = s.obstacles[o];
    const Vec3d p = s.x[a], d = s.x[a + 1] - p, e = seen.b - seen.a;
    const NearestPlaces at = nearest_places(p, d, seen.a, e, kSoftness);
    const Vec3d between = p + at.s * d - seen.a - at.t * e;
    const double distance = length(between), gap = distance - (given[o].radius + radius);
    if (gap >= kOnset * m.stuff.diameter) return;
    if (count == m.contacts) {
      full = true;
      return;
    }
    Touch& touch = w.touch[count++];
    touch = {.a = a, .b = o, .s = at.s, .t = at.t};
    touch.normal = distance > 1e-12 ? between / distance : any_perpendicular(normalised(e));
    set_press(touch, m.contact_stiffness, m.stuff.diameter, gap);
    inherit(first, last, false, touch);
    set_friction(touch, given[o].friction < 0 ? m.stuff.friction_steel : given[o].friction, 0.5 * m.contact_stiffness);
    keep_bound(touch);
    touch.moved = (1 - at.t) * w.obstacle_moves[2 * o] + at.t * w.obstacle_moves[2 * o + 1];
  });
  return count;
}

double safe_share(const ThreadModel& m, const ThreadState& s, int near, std::span<const Obstacle> given, double most,
                  ThreadWork& w) noexcept {
  const double thickness = m.stuff.diameter;
  double share = 1;
  const auto keep = [&share, thickness](double distance, double at_rest, double approach) {
    const double allowed =
        std::min(kKeptApart * distance, std::max(distance - at_rest + kAllowed * thickness, kDeeper * thickness));
    if (approach * share > allowed) share = allowed / approach;
  };
  const auto least = [&w](int e, Vec3d n) { return std::min(dot(w.delta[e], n), dot(w.delta[e + 1], n)); };
  for (int k = 0; k < near; ++k) {
    const auto [a, b] = w.near[k];
    const Nearness at = nearness(s, a, b, 0);
    keep(at.distance, thickness, -least(a, at.normal) - least(b, -at.normal));
  }
  // what is farther away than they may come together is kept apart by itself
  const auto reach = [&](int o) {
    const Vec3d* const moves = &w.obstacle_moves[2 * o];
    const double together = most + std::sqrt(std::max(dot(moves[0], moves[0]), dot(moves[1], moves[1])));
    return 1.01 * (given[o].radius + 0.5 * thickness + together / kKeptApart);
  };
  visit_near_obstacles(m, s, given, w, reach, [&](int a, int o) {
    const ObstacleState& seen = s.obstacles[o];
    const Vec3d p = s.x[a], d = s.x[a + 1] - p, e = seen.b - seen.a;
    const NearestPlaces at = nearest_places(p, d, seen.a, e, 0);
    const Vec3d between = p + at.s * d - seen.a - at.t * e;
    const double distance = length(between);
    if (!(distance > 1e-12)) return;
    const Vec3d n = between / distance;
    const double moves = std::min(dot(w.obstacle_moves[2 * o], -n), dot(w.obstacle_moves[2 * o + 1], -n));
    keep(distance, given[o].radius + 0.5 * thickness, -least(a, n) - moves);
  });
  return share;
}

}  // namespace trocar::suture
