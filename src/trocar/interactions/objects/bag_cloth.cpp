#include <algorithm>
#include <cmath>

#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/objects/bag_cloth.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr double kOpens = 1.5, kCloses = 2.0;   // [s] all the way
constexpr double kRoom = 0.060;                 // [m] of the sleeve in the body before the hoop first comes out
constexpr double kNeck = 0.016;                 // [m] a sleeve no deeper than this has its end in the port
constexpr double kUnrolled = 0.9;               // share of the hoop that is out when all of the cloth is
constexpr double kRolled = 0.12;                // of its depth: how the cloth lies under the hoop as it comes out
constexpr double kFilmDrags = 4;                // [1/s] speed is lost to wet film and gas
constexpr double kQuickestNode = 3;             // [m/s]
constexpr double kStiff = 0.1;                  // [N/m] of a bend
constexpr double kTaut = 0.98, kStilled = 0.5;  // of its length, squared; share of a swing that is lost in a tick
constexpr double kViscous = 0.05;               // of any other motion between two nodes
constexpr double kComesOut = 0.1;               // share of what has sunk into the cloth that comes out in a tick
constexpr int kClothSweeps = 4;
constexpr double kThrownOut = 0.1;     // [m/s] at most
constexpr double kThick = 0.0008;      // [m] half the cloth's thickness, with what clings to it
constexpr double kRodClear = 0.0005;   // [m]
constexpr double kClothSlides = 0.15;  // Coulomb's coefficient of cloth on tissue and of contents on cloth
constexpr double kNearSkin = 0.012;    // [m]
constexpr std::uint64_t kSkinTurns = 4;

double stepped_to(double from, double to, double most) noexcept { return from + std::clamp(to - from, -most, most); }

/// Threads: too long, both ends give.
void pull_together(const BagModel& m, BagState& s) noexcept {
  const std::int32_t hoop = m.around;
  for (const BagThread& t : m.threads) {
    Vec3d &a = s.x[size_t(t.a)], &b = s.x[size_t(t.b)];
    const Vec3d way = b - a;
    const double l2 = dot(way, way);
    if (l2 <= t.length * t.length) continue;
    const double l = std::sqrt(l2), free = t.a < hoop ? 0.0 : 0.5;  // a is the smaller number: the hoop's, if any
    const Vec3d by = ((l - t.length) / l) * way;
    a += free * by;
    b -= (1 - free) * by;
  }
}

/// The hoop gives nothing.
void rein_in(const BagModel& m, BagState& s) noexcept {
  for (const BagThread& t : m.reins) {
    Vec3d& b = s.x[size_t(t.b)];
    const Vec3d way = b - s.x[size_t(t.a)];
    const double l2 = dot(way, way);
    if (l2 > t.length * t.length) b -= (1 - t.length / std::sqrt(l2)) * way;
  }
}

/// Cloth does not swing like a spring.
void still_threads(const BagModel& m, BagState& s) noexcept {
  for (const BagThread& t : m.threads) {
    const Vec3d way = s.x[size_t(t.b)] - s.x[size_t(t.a)];
    const double l2 = dot(way, way);
    if (l2 < kTaut * t.length * t.length) continue;
    Vec3d &a = s.v[size_t(t.a)], &b = s.v[size_t(t.b)];
    const bool held = t.a < m.around;
    const Vec3d apart = b - a, by = (kStilled * dot(apart, way) / l2) * way + kViscous * apart;
    if (!held) a += 0.5 * by;
    b -= (held ? 1.0 : 0.5) * by;
  }
}

/// Bends: too short, both ends are pushed apart a little.
void keep_apart(const BagModel& m, double h, BagState& s) noexcept {
  const double give = m.mass / (kStiff * h * h);
  for (const BagThread& t : m.bends) {
    Vec3d &a = s.x[size_t(t.a)], &b = s.x[size_t(t.b)];
    const Vec3d way = b - a;
    const double l = length(way);
    if (l >= t.length || !(l > 1e-9)) continue;
    const bool held = t.a < m.around;
    const double share = (t.length - l) / ((held ? 1 : 2) + give);
    const Vec3d by = (share / l) * way;
    if (!held) a -= by;
    b += by;
  }
}

void press_out(const BagModel& m, BagState& s, BagWork& w) noexcept {
  for (const BagPress& p : w.presses) {
    if (p.node < m.around) continue;
    Vec3d& x = s.x[size_t(p.node)];
    const double lacks = -dot(x - p.at, p.normal);
    if (!(lacks > 0)) continue;
    const double by = lacks / (1 + p.give);
    x += by * p.normal;
    const Vec3d slid = x - w.before[size_t(p.node)], across = slid - dot(slid, p.normal) * p.normal;
    const double far = length(across);
    if (far > 1e-9) x -= std::min(1.0, kClothSlides * by / far) * across;
  }
}

bool meets(const tissue::Box& box, const collision::Capsule& rod, double keep) noexcept {
  for (int c = 0; c < 3; ++c)
    if (std::max(rod.a[c], rod.b[c]) + keep < double(box.low[c]) ||
        std::min(rod.a[c], rod.b[c]) - keep > double(box.high[c]))
      return false;
  return true;
}

void push_aside(const BagModel& m, BagState& s, const BagWork& w) noexcept {
  for (const BagRod& rod : w.rods) {
    const double keep = rod.now.radius + kThick + kRodClear;
    if (!meets(w.bounds, rod.now, keep)) continue;
    for (size_t n = size_t(m.around); n < s.x.size(); ++n) {
      const Vec3d off = s.x[n] - collision::nearest_on_axis(rod.now, s.x[n]);
      const double away2 = dot(off, off);
      if (away2 < keep * keep && away2 > 1e-12) s.x[n] += (keep / std::sqrt(away2) - 1) * off;
    }
  }
}

Vec3d place_of(const BagTouch& t, const BagState& s) noexcept {
  if (t.nodes[0] < 0) return t.hoop;
  return t.weights.x * s.x[size_t(t.nodes[0])] + t.weights.y * s.x[size_t(t.nodes[1])] +
         t.weights.z * s.x[size_t(t.nodes[2])];
}

/// Moves both sides of a touch apart by `by`, each as light as it is.
void part(const BagModel& m, const BagTouch& t, Vec3d by, BagState& s, BagWork& w) noexcept {
  BagBody& body = w.bodies[size_t(t.point)];
  double give[3] = {0, 0, 0}, all = body.light;
  for (size_t k = 0; k < 3; ++k) {
    if (t.nodes[k] < m.around) continue;
    give[k] = t.weights[int(k)];
    all += give[k] * give[k];
  }
  if (!(all > 1e-9)) return;
  body.moved += (body.light / all) * by;
  for (size_t k = 0; k < 3; ++k)
    if (give[k] > 0) s.x[size_t(t.nodes[k])] -= (give[k] / all) * by;
}

/// What has sunk in before this tick comes out again bit by bit: all at once it would be thrown.
void be_patient(double h, const BagState& s, BagWork& w) noexcept {
  for (BagTouch& t : w.touches) {
    const BagBody& body = w.bodies[size_t(t.point)];
    const double sunk = t.away - dot(body.x - h * body.speed - place_of(t, s), t.normal);
    if (sunk > 0) t.away -= (1 - kComesOut) * sunk;
  }
}

void hold_off(const BagModel& m, BagState& s, BagWork& w) noexcept {
  for (BagTouch& t : w.touches) {
    const BagBody& body = w.bodies[size_t(t.point)];
    const double lacks = t.away - dot(body.x + body.moved - place_of(t, s), t.normal);
    if (!(lacks > 0)) continue;
    part(m, t, lacks * t.normal, s, w);
    t.pressed += lacks;
  }
}

/// What lies on cloth is taken along by it, as far as friction goes.
void rub(const BagModel& m, double h, BagState& s, BagWork& w) noexcept {
  for (const BagTouch& t : w.touches) {
    if (!(t.pressed > 0) || t.nodes[0] < 0) continue;
    Vec3d was;
    for (size_t k = 0; k < 3; ++k) was += t.weights[int(k)] * w.before[size_t(t.nodes[k])];
    const BagBody& body = w.bodies[size_t(t.point)];
    const Vec3d slid = (h * body.speed + body.moved) - (place_of(t, s) - was);
    const Vec3d across = slid - dot(slid, t.normal) * t.normal;
    const double far = length(across);
    if (far > 1e-9) part(m, t, (-std::min(1.0, kClothSlides * t.pressed / far)) * across, s, w);
  }
}

}  // namespace

void follow_hand(const BagHand& hand, double h, const BagWork& w, BagState& s) noexcept {
  s.hand = hand.hand;
  s.frame = hand.frame;
  double wanted = s.out != 0 ? 0 : 1 - hand.handle;
  if (!s.there() && hand.depth < kRoom) wanted = 0;
  if (wanted < s.hoop) wanted = std::max(wanted, std::min(s.hoop, w.narrowest));
  s.hoop = wanted > s.hoop ? stepped_to(s.hoop, wanted, h / kOpens) : stepped_to(s.hoop, wanted, h / kCloses);
  s.unrolled = std::max(s.unrolled, s.hoop);
  if (s.unrolled > kUnrolled) s.unrolled = 1;
  if (s.shut() && hand.depth < kNeck) s.out = 1;
}

Vec3d speed_after(const BagBody& body, double h) noexcept {
  const double far = length(body.moved);
  if (!(far > 0)) return body.speed;
  const Vec3d way = body.moved / far;
  const double was = dot(body.speed, way), now = std::min(was + far / h, std::max(was, kThrownOut));
  return body.speed + (now - was) * way;
}

void lay_hoop(const BagModel& m, BagState& s) noexcept {
  const Vec3d middle = s.middle(m), side = s.frame.side();
  const size_t laid = s.unrolled < 1 ? s.x.size() : size_t(m.around);
  for (size_t n = 0; n < laid; ++n) {
    const Vec3d d = m.drawn[n];
    const Vec3d x = middle + s.hoop * (d.x * s.frame.axis + d.y * side + kRolled * d.z * s.frame.up);
    s.v[n] = {0, 0, 0};
    s.x[n] = x;
  }
}

tissue::Box bounds_of(const BagState& s) noexcept {
  tissue::Box box;
  for (const Vec3d& x : s.x) box.add(vec_cast<float>(x));
  return box;
}

void find_normals(const BagModel& m, const BagState& s, BagWork& w) noexcept {
  for (Vec3d& n : w.normal) n = {0, 0, 0};
  for (const auto& t : m.triangles) {
    const Vec3d a = s.x[size_t(t[0])], n = cross(s.x[size_t(t[1])] - a, s.x[size_t(t[2])] - a);
    for (const std::int32_t node : t) w.normal[size_t(node)] += n;
  }
  for (Vec3d& n : w.normal) n = normalised(n, {0, 0, 1});
}

void find_skins(const BagModel& m, std::span<const Surface> surfaces, std::uint64_t tick, BagState& s,
                const BagWork& w) noexcept {
  for (size_t n = size_t(tick % kSkinTurns); n < size_t(m.nodes()); n += kSkinTurns) {
    double least = kNearSkin;
    s.skins[n].surface = -1;
    for (size_t i = 0; i < surfaces.size(); ++i) {
      const tissue::Box& box = surfaces[i].pose->bounds;
      if (!box.near_box(w.bounds, float(kNearSkin)) || !box.reaches(s.x[n], least)) continue;
      const int vertex = nearest_vertex_near(surfaces[i], s.x[n], least);
      if (vertex < 0) continue;
      least = length(surfaces[i].position(vertex) - s.x[n]);
      s.skins[n] = {std::int32_t(i), vertex};
    }
  }
}

void rest_cloth(const BagModel& m, const Surface& surface, std::int32_t number, BagState& s, NetworkLoads* loads,
                BagWork& w) noexcept {
  for (size_t n = 0; n < s.x.size(); ++n) {
    if (s.skins[n].surface != number || s.skins[n].vertex >= surface.skin->size()) continue;
    const int vertex = s.skins[n].vertex = walk_to_nearest(surface, s.skins[n].vertex, s.x[n]);
    if (surface.torn(vertex)) continue;
    const Vec3d normal = surface.normal(vertex), at = surface.position(vertex);
    const double above = dot(s.x[n] - at, normal), depth = kThick - above;
    if (depth < -0.002 || depth > kDeepestContact || w.presses.size() == w.presses.capacity()) continue;
    const double given = std::min(depth, kQuickestApart);
    BagPress press{std::int32_t(n), s.x[n] + (loads && given > 0 ? 0.5 : 1.0) * given * normal, normal, 0};
    if (loads) {
      press.give = m.mass / (kBodyStiffness * core::kTick * core::kTick);
      if (given > 0) push_skin(surface, vertex, -0.5 * given * normal, normal, kBodyStiffness, kBodyDamping, *loads);
    }
    w.presses.push_back(press);
  }
}

bool advance_cloth(const BagModel& m, Vec3d gravity, double h, BagState& s, BagWork& w) noexcept {
  be_patient(h, s, w);
  w.before = s.x;
  for (size_t n = size_t(m.around); n < s.x.size() && s.unrolled >= 1; ++n) {
    s.v[n] = (1 - kFilmDrags * h) * (s.v[n] + h * gravity);
    s.x[n] += h * s.v[n];
  }
  lay_hoop(m, s);
  if (s.unrolled < 1) return true;
  keep_apart(m, h, s);
  for (int sweep = 0; sweep < kClothSweeps; ++sweep) {
    press_out(m, s, w);
    push_aside(m, s, w);
    hold_off(m, s, w);
    pull_together(m, s);
    rein_in(m, s);
  }
  rub(m, h, s, w);
  bool sound = true;
  for (size_t n = size_t(m.around); n < s.x.size(); ++n) {
    const Vec3d v = (s.x[n] - w.before[n]) / h;
    const double quick = length(v);
    s.v[n] = quick > kQuickestNode ? (kQuickestNode / quick) * v : v;
    sound = sound && quick < 1e6;
  }
  still_threads(m, s);
  return sound;
}

}  // namespace trocar::interactions
