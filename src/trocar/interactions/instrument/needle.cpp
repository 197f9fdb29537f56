#include <algorithm>
#include <array>
#include <optional>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/instrument/needle.hpp>

namespace trocar::interactions {
namespace {

constexpr double kClear = 0.00005;   // [m] before the needle's end
constexpr double kFarthest = 0.003;  // [m] that nodes are driven in a tick
constexpr double kLeastFree = 0.1;   // share of a triangle's free nodes in the place that is pierced
constexpr double kRounding = 1e-7;   // [m]
constexpr int kMostCarried = 128;
constexpr int kMostRounds = 16;

/// A point seen from the needle: how far behind its end, and off its line.
struct Seen {
  double along;
  double x, y;
};

struct Frame {
  Vec3d end, dir, x, y;
  Seen see(Vec3d p) const noexcept {
    const double along = dot(end - p, dir);
    const Vec3d off = p - end + along * dir;
    return {along, dot(off, x), dot(off, y)};
  }
};

struct Frames {
  Frame before, after;
};

/// What sticks to the needle is seen at the same place off its line before and after, as both look along the same two
/// directions across.
Frames frames_of(const Needle& n) noexcept {
  const Vec3d d = n.dir1;
  const Vec3d least = std::fabs(d.x) < std::fabs(d.y)
                          ? (std::fabs(d.x) < std::fabs(d.z) ? Vec3d{1, 0, 0} : Vec3d{0, 0, 1})
                          : (std::fabs(d.y) < std::fabs(d.z) ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1});
  const Vec3d x = normalised(cross(d, least)), y = cross(d, x);
  return {{n.end0, n.dir0, x, y}, {n.end1, n.dir1, x, y}};
}

Seen mixed(const Seen& a, const Seen& b, double share) noexcept {
  return {a.along + share * (b.along - a.along), a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

/// With the edge in line with the needle at that share of the tick: does it meet the needle itself?
bool meets(const Seen& p, const Seen& q, double length) noexcept {
  if (p.x * q.x + p.y * q.y > 0) return false;  // both on one side of the line
  const double a = std::sqrt(p.x * p.x + p.y * p.y), b = std::sqrt(q.x * q.x + q.y * q.y);
  const double along = a + b > 0 ? (b * p.along + a * q.along) / (a + b) : p.along;
  return along >= 0 && along <= length;
}

bool goes_through(const Frames& f, double length, Vec3d p0, Vec3d q0, Vec3d p1, Vec3d q1) noexcept {
  const Seen pa = f.before.see(p0), qa = f.before.see(q0), pb = f.after.see(p1), qb = f.after.see(q1);
  const double mx = pa.x + qa.x + pb.x + qb.x, my = pa.y + qa.y + pb.y + qb.y;
  const auto aside = [mx, my](const Seen& p) { return mx * p.x + my * p.y > 0; };
  if (aside(pa) && aside(qa) && aside(pb) && aside(qb)) return false;
  // Twice the area between needle, p and q, seen along the needle: c0 + c1 t + c2 t^2.
  const double ux = pb.x - pa.x, uy = pb.y - pa.y, vx = qb.x - qa.x, vy = qb.y - qa.y;
  const double c0 = pa.x * qa.y - pa.y * qa.x, c2 = ux * vy - uy * vx;
  const double c1 = pa.x * vy - pa.y * vx + ux * qa.y - uy * qa.x;
  const double square = c1 * c1 - 4 * c0 * c2;
  if (!(square > 0)) return false;
  const double root = std::sqrt(square), half = -0.5 * (c1 + (c1 < 0 ? -root : root));
  double t[2];
  int roots = 0;
  if (c2 != 0) t[roots++] = half / c2;
  if (half != 0) t[roots++] = c0 / half;
  int through = 0;
  for (int i = 0; i < roots; ++i)
    if (t[i] > 0 && t[i] <= 1 && meets(mixed(pa, pb, t[i]), mixed(qa, qb, t[i]), length)) ++through;
  return through == 1;  // twice is there and back
}

struct Hit {
  bool hit = false;
  double deep = 0;  ///< of the needle's end beyond the triangle [m]
  Vec3d weights;
};
Hit pierced(Vec3d end, Vec3d dir, double length, Vec3d a, Vec3d b, Vec3d c) noexcept {
  const auto on = geometry::ray_triangle(end, -dir, a, b, c);
  return {on.hit && on.t <= length, on.t, on.weights};
}

/// Triangles that a needle may be near to, ascending.
struct NearList {
  static constexpr int kMost = 2048;
  std::array<int, kMost> triangle;
  int count = 0;
  bool all = false;  ///< they are too many to list

  void add(int t) noexcept {
    if (count == kMost)
      all = true;
    else
      triangle[std::size_t(count++)] = t;
  }
};

/// Those whose first corner lies in a box that comes nearer to the needle than `margin`.
void list_near(const Needle& needle, const Carried& body, double margin, NearList& list) noexcept {
  const Vec3d from = needle.end0 - needle.length * needle.dir0;
  const auto near = [&](const tissue::Box& box) { return meets_box(box, needle.end0, from, margin); };
  const int patches = int(body.before.patch.size()), in_block = tissue::kSkinBlock / tissue::kSkinPatch;
  for (int p = 0; p < patches; ++p) {
    if (p % in_block == 0 && !near(body.before.block[std::size_t(p / in_block)])) {
      p += in_block - 1;
      continue;
    }
    if (!near(body.before.patch[std::size_t(p)])) continue;
    const int last = std::min((p + 1) * tissue::kSkinPatch, body.skin.size());
    for (int v = p * tissue::kSkinPatch; v < last; ++v)
      for (int i = body.skin.face_first[std::size_t(v)]; i < body.skin.face_first[std::size_t(v) + 1]; ++i) {
        const int t = body.skin.face[std::size_t(i)];
        if (body.skin.triangles[std::size_t(t)][0] == v) list.add(t);
      }
  }
  std::sort(list.triangle.begin(), list.triangle.begin() + list.count);
}

/// One needle and one body in one tick.
class Zone {
 public:
  /// @param reach  [m] that needle and body together have moved  @param side  the longest of a triangle [m]
  Zone(const Needle& needle, const Carried& body, bool jaws, double reach, double side, double tick) noexcept
      : m_needle(needle), m_frames(frames_of(needle)), m_body(body), m_jaws(jaws), m_reach(reach), m_tick(tick) {
    const double most = reach + kFarthest;  // which it may become
    list_near(needle, body, std::sqrt(2 * (most * most + side * side)) + kRounding, m_near);
  }

  int carry() noexcept {
    for (int round = 0; round < kMostRounds && one_round(); ++round) {
    }
    return m_count;
  }

  bool impales() const noexcept {
    const Needle& n = m_needle;
    return any_near([&](const std::array<int, 3>& t) {
      const Hit hit = pierced(n.end0, n.dir0, n.length, before(t[0]), before(t[1]), before(t[2]));
      return hit.hit && hit.deep > kImpaled;
    });
  }

 private:
  Vec3d before(int v) const noexcept { return vec_cast<double>(m_body.before.position[std::size_t(v)]); }
  tissue::NodeState& node(int v) const noexcept {
    return m_body.rows[std::size_t(m_body.skin.weights[std::size_t(v)].row[0])];
  }
  Vec3d after(int v) const noexcept {
    const tissue::NodeState& n = node(v);
    return m_body.origin + Vec3d{n.x, n.y, n.z};
  }
  bool held(int v) const noexcept {
    if (!m_body.fixed.empty() && m_body.fixed[std::size_t(v)]) return true;
    return m_jaws && std::find(m_body.between.begin(), m_body.between.end(), v) != m_body.between.end();
  }

  enum How { slides, sticks };
  struct Taken {
    int vertex;
    How how;
  };

  /// @param how  along the needle
  /// @return is it new?
  bool take(int v, How how) noexcept {
    if (held(v)) return false;
    Taken* const end = m_taken.data() + m_count;
    Taken* const known = std::find_if(m_taken.data(), end, [v](const Taken& t) { return t.vertex == v; });
    if (known != end && (known->how == sticks || how == slides)) return false;
    if (known == end && m_count == kMostCarried) return false;
    if (known == end) ++m_count;
    *known = {v, how};
    const Needle& n = m_needle;
    const Vec3d from = before(v);
    const double slid = how == slides ? dot(n.end0 - from, n.dir0) - dot(n.end1 - after(v), n.dir1) : 0;
    go(v, from, n.carried(from) + slid * n.dir1);
    return true;
  }
  void go(int v, Vec3d from, Vec3d to) noexcept {
    const Vec3f x = vec_cast<float>(to - m_body.origin), velocity = vec_cast<float>((to - from) / m_tick);
    tissue::NodeState& n = node(v);
    n.x = x.x, n.y = x.y, n.z = x.z;
    n.vx = velocity.x, n.vy = velocity.y, n.vz = velocity.z;
  }

  bool near(const std::array<int, 3>& t) const noexcept {
    const Vec3d a = before(t[0]);
    const double u = std::clamp(dot(m_needle.end0 - a, m_needle.dir0), 0.0, m_needle.length);
    const double size2 = std::max(geometry::distance2(a, before(t[1])), geometry::distance2(a, before(t[2])));
    return geometry::distance2(a, m_needle.end0 - u * m_needle.dir0) < 2 * (m_reach * m_reach + size2);
  }

  /// Until ends(triangle), in the order of the triangles that are there and near.
  template <class Ends>
  bool any_near(Ends&& ends) const noexcept {
    const int count = m_near.all ? int(m_body.skin.triangles.size()) : m_near.count;
    for (int k = 0; k < count; ++k) {
      const std::size_t i = std::size_t(m_near.all ? k : m_near.triangle[std::size_t(k)]);
      if (!m_body.open.empty() && m_body.open[i]) continue;
      const std::array<int, 3>& t = m_body.skin.triangles[i];
      if (near(t) && ends(t)) return true;
    }
    return false;
  }

  bool one_round() noexcept {
    bool more = false;
    any_near([&](const std::array<int, 3>& t) {
      more = look_at(t) || more;
      return false;
    });
    return more;
  }

  bool look_at(const std::array<int, 3>& t) noexcept {
    bool more = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const int p = t[k], q = t[(k + 1) % 3];
      if (!goes_through(m_frames, m_needle.length, before(p), before(q), after(p), after(q))) continue;
      more = take(p, slides) || more;
      more = take(q, slides) || more;
    }
    const Needle& n = m_needle;
    const Hit hit = pierced(n.end1, n.dir1, n.length, after(t[0]), after(t[1]), after(t[2]));
    if (!hit.hit) return more;
    if (pierced(n.end0, n.dir0, n.length, before(t[0]), before(t[1]), before(t[2])).hit) return more;
    if (more) return true;
    for (const int v : t) more = take(v, sticks) || more;
    return more || drive(t, hit);
  }

  /// All of a triangle that can go has gone with the needle, and it is pierced still, as the rest of it is held: what
  /// can go is driven on before the needle's end, if that is near. It is not where jaws hold the rest and the triangle
  /// has come astride of them: a corner that had to go as far as their end would be torn through its neighbours.
  bool drive(const std::array<int, 3>& t, const Hit& hit) noexcept {
    double free = 0;
    for (std::size_t k = 0; k < 3; ++k) free += held(t[k]) ? 0.0 : hit.weights[int(k)];
    if (free < kLeastFree) return false;
    const double far = (hit.deep + kClear) / free;
    if (far > kFarthest - m_driven) return false;
    if (m_driven == 0) m_reach += kFarthest;
    m_driven += far;
    const Vec3f on = vec_cast<float>(far * m_needle.dir1);
    for (const int v : t) {
      if (held(v)) continue;
      tissue::NodeState& n = node(v);
      n.x += on.x, n.y += on.y, n.z += on.z;
    }
    return true;
  }

  const Needle& m_needle;
  const Frames m_frames;
  const Carried& m_body;
  const bool m_jaws;
  double m_reach;
  const double m_tick;
  NearList m_near;
  std::array<Taken, kMostCarried> m_taken;
  int m_count = 0;
  double m_driven = 0;  // [m]
};

Needle needle_of(Vec3d from0, Vec3d end0, Vec3d from1, Vec3d end1) noexcept {
  Needle n;
  n.end0 = end0;
  n.end1 = end1;
  n.dir0 = normalised(end0 - from0);
  n.dir1 = normalised(end1 - from1);
  n.length = std::min(length(end0 - from0), length(end1 - from1));
  return n;
}

}  // namespace

bool goes_through(const Needle& n, Vec3d p0, Vec3d q0, Vec3d p1, Vec3d q1) noexcept {
  return goes_through(frames_of(n), n.length, p0, q0, p1, q1);
}

double gap_of(const ToolShape& s) noexcept {
  if (s.has_foot) return 0;
  const Capsule &a = s.part[kJawA], &b = s.part[kJawB];
  return length(a.b - b.b) - a.radius - b.radius;
}

Needles needles_of(const ToolShape& before, const ToolShape& now, bool blunt, double thin) noexcept {
  Needles r;
  const Capsule &s0 = before.part[kShaft], &s1 = now.part[kShaft];
  if (!(length(s0.b - s0.a) > 0) || !(length(s1.b - s1.a) > 0)) return r;
  r.needle[r.count++] = needle_of(s0.a, s0.b, s1.a, s1.b);
  for (int i = 0; i < now.links && i < before.links; ++i)
    r.needle[r.count++] = needle_of(before.link[i].a, before.link[i].b, now.link[i].a, now.link[i].b);
  r.links = r.count - 1;
  const auto add = [&](int part) {
    const Capsule &j0 = before.part[part], &j1 = now.part[part];
    r.needle[r.count++] = needle_of(j0.a, j0.b, j1.a, j1.b);
  };
  if (now.has_foot) {
    add(kJawA);
    return r;
  }
  const double gap = std::max(gap_of(before), gap_of(now));
  if (!blunt) return r;
  if (gap < thin) r.needle[r.count++] = needle_of(before.pivot, before.frame.tip, now.pivot, now.frame.tip);
  if (gap < thin || gap > kWide) return r;
  add(kJawA), add(kJawB);
  return r;
}

namespace {

double way_of(const Needle& n) noexcept {
  const Vec3d from0 = n.end0 - n.length * n.dir0, from1 = n.end1 - n.length * n.dir1;
  return std::sqrt(std::max(geometry::distance2(n.end0, n.end1), geometry::distance2(from0, from1)));
}

/// The longest way of a node at the surface [m].
double way_of(const Carried& body) noexcept {
  const Vec3f origin = vec_cast<float>(body.origin);
  float most2 = 0;
  for (int v = 0; v < body.skin.size(); ++v) {
    if (!body.skin.at_surface(v)) continue;
    const tissue::NodeState& n = body.rows[std::size_t(body.skin.weights[std::size_t(v)].row[0])];
    const Vec3f off = Vec3f{n.x, n.y, n.z} - (body.before.position[std::size_t(v)] - origin);
    most2 = std::max(most2, dot(off, off));
  }
  return std::sqrt(double(most2)) + 1e-6;  // rounding
}

/// The longest side of a triangle at its first corner, as the tick began [m].
double side_of(const Carried& body) noexcept {
  const auto at = [&](int v) { return body.before.position[std::size_t(v)]; };
  float most2 = 0;
  for (const std::array<int, 3>& t : body.skin.triangles) {
    const Vec3f a = at(t[0]), p = at(t[1]) - a, q = at(t[2]) - a;
    most2 = std::max({most2, dot(p, p), dot(q, q)});
  }
  return std::sqrt(double(most2)) + 1e-6;  // rounding
}

}  // namespace

int carry_along(const Needles& needles, const Carried& body, double gap, double tick, CarriedExtent& extent) noexcept {
  std::array<std::optional<Zone>, Needles::kMost> zone;
  for (int i = 0; i < needles.count; ++i) {
    const Needle& n = needles.needle[i];
    const double way = way_of(n);
    if (extent.way < 0) extent.way = way_of(body);
    const double moved = extent.way;
    if (gap > 2 * way + moved) continue;
    if (!meets_box(body.before.bounds, n.end0, n.end0 - n.length * n.dir0, way + moved)) continue;
    if (extent.side < 0) extent.side = side_of(body);
    zone[std::size_t(i)].emplace(n, body, i > needles.links, way + moved, extent.side, tick);
    // What one part of the instrument has impaled slides off over the others.
    if (zone[std::size_t(i)]->impales()) return 0;
  }
  int sum = 0;
  for (std::optional<Zone>& each : zone)
    if (each) sum += each->carry();
  if (sum > 0) extent.way = -1;  // what was carried has another way
  return sum;
}

}  // namespace trocar::interactions
