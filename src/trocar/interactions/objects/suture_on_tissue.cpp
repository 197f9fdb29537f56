#include <algorithm>
#include <cmath>

#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/objects/suture_on_tissue.hpp>
#include <trocar/interactions/objects/suture_sling_step.hpp>
#include <trocar/interactions/objects/suture_stitch.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSkinReach = 0.006;      // [m] further from a skin's vertices, it is not looked at
constexpr double kSkinAhead = 0.0004;     // [m] contacts are there before they touch
constexpr double kDeepestRest = 0.0025;   // [m] deeper is another side of the body
constexpr double kSureOfSide = 0.00005;   // [m] below a skin from which on a node's side is made sure of
constexpr std::uint64_t kLooksAnew = 16;  // ticks in which each bead and node looks for its skin again
constexpr double kCalms = 0.5;            // of what tissue resists, as damping beside a needle
constexpr double kTurnsTo = 0.02;      // of the way a tick: skin under a tip is as it was for some 50 ms. Our estimate
constexpr double kSameSide = 0.3;      // cosine between normals of one and the same patch of skin
constexpr double kBeforeSwage = 0.85;  // of the needle's length: up to there its own thread meets it
constexpr double kHardStiffness = 2000;  // [N/m] of walls and instruments at a bead
constexpr double kSteelFriction = 0.15, kWallFriction = 0.3, kTissueFriction = 0.1;  // of needles

int heaviest_corner(const SkinPoint& on) noexcept {
  size_t best = 0;
  for (size_t k = 1; k < 3; ++k)
    if (on.weights[int(k)] > on.weights[int(best)]) best = k;
  return on.vertex[best];
}

const Surface& surface_of(const Bodies& bodies, BodyId body) noexcept {
  return body.is(BodyKind::organ) ? bodies.organ(body.index()) : bodies.membrane(body.index()).surface;
}

NearSkin at_surface(const Bodies& bodies, BodyId body, int vertex, Vec3d p) noexcept {
  const Surface& surface = surface_of(bodies, body);
  NearSkin near;
  if (vertex < 0 || vertex >= surface.skin->size() || !surface.skin->at_surface(vertex) || surface.torn(vertex))
    return near;
  const SkinPoint on = nearest_skin_point(surface, vertex, p);
  const Vec3d off = p - on.point;
  const double away = length(off);
  double side = dot(off, on.normal) < 0 ? -1.0 : 1.0;
  const int corner = heaviest_corner(on);
  near = {body.is(BodyKind::organ) ? on_vertex(bodies, body.index(), corner) : at_node(bodies, body, corner), on.point,
          on.normal, side * away};
  if (away > 1e-5 && away < 0.003) near.normal = normalised((side / away) * off + 0.2 * on.normal);
  if (body.is(BodyKind::membrane)) {  // both sides of a fold are outside; of a pouch, too
    near.normal = side * near.normal;
    near.distance = away - bodies.membrane(body.index()).half_thickness;
  }
  return near;
}

NearSkin at_element(const Bodies& bodies, BodyId body, int e, Vec3d p) noexcept {
  const StrandBody& strand = bodies.strand(body.index());
  const tissue::StrandState& s = bodies.strand_state(body.index());
  NearSkin near;
  if (e < 0 || e + 1 >= strand.nodes() || !s.alive[size_t(e)]) return near;
  const Vec3d a = s.x[size_t(e)], ab = s.x[size_t(e) + 1] - a;
  const double w = std::clamp(dot(p - a, ab) / std::max(1e-12, dot(ab, ab)), 0.0, 1.0);
  const Vec3d off = p - (a + w * ab), out = normalised(off, any_perpendicular(normalised(ab)));
  const double radius = strand.model.radius[size_t(e)];
  return {at_element(bodies, body.index(), e, w, {}), a + w * ab + radius * out, out, length(off) - radius};
}

/// From the last place on.
NearSkin look_again(const Bodies& bodies, MaterialPoint& last, Vec3d p) noexcept {
  const BodyId body = last.body;
  if (!body.exists()) return {};
  NearSkin best;
  if (body.is(BodyKind::strand)) {
    best = at_element(bodies, body, last.element, p);
    for (const int step : {-1, 1})
      for (int e = last.element + step; e >= 0 && e + 1 < bodies.strand(body.index()).nodes(); e += step) {
        const NearSkin next = at_element(bodies, body, e, p);
        if (!(next.distance < best.distance)) break;
        best = next;
      }
  } else {
    const Surface& surface = surface_of(bodies, body);
    if (!surface.pose->bounds.reaches(p, kSkinReach)) return {};
    best = at_surface(bodies, body, walk_to_nearest(surface, vertex_of(bodies, last), p), p);
  }
  if (best.there()) last = best.at;
  return best;
}

MaterialPoint look_everywhere(const Bodies& bodies, Vec3d p) noexcept {
  MaterialPoint best;
  double least = kSkinReach;
  const auto look = [&](BodyId body) {
    const NearSkin near = nearest_skin(bodies, body, p, kSkinReach);
    if (!near.there() || !(std::fabs(near.distance) < least)) return;
    least = std::fabs(near.distance);
    best = near.at;
  };
  for (size_t i = 0; i < bodies.organ_count(); ++i) look(BodyId::organ(i));
  for (size_t i = 0; i < bodies.membrane_count(); ++i) look(BodyId::membrane(i));
  for (size_t i = 0; i < bodies.strand_count(); ++i) look(BodyId::strand(i));
  return best;
}

/// Half of the depth is the tissue's, with twice the stiffness: both feel the same force.
void push_tissue(const Bodies& bodies, const NearSkin& on, double depth) noexcept {
  const Vec3d way = -0.5 * std::min(depth, kQuickestApart) * on.normal;
  put_load(bodies, on.at,
           {.k = 2 * kBodyStiffness, .target = place_of(bodies, on.at) + way, .d = kBodyDamping, .dir = on.normal},
           {Owner::body, 0, 0});
}

/// One suture in a tick.
class Resting {
 public:
  Resting(const SutureModels& models, size_t index, const Bodies& bodies, const tissue::Box& cavity, double dt,
          SutureState& s, SutureWorks& all) noexcept
      : m_models(models),
        m_model(models.list[index]),
        m_index(index),
        m_bodies(bodies),
        m_cavity(cavity),
        m_dt(dt),
        m_state(s),
        m_all(all),
        m_work(all.list[index]) {}

  /// What was done to tissue in the last tick.
  void bear() noexcept {
    for (int i = 0; i < m_state.hole_count; ++i) {
      const SutureHole& h = m_state.holes[size_t(i)];
      const double resists = (h.slot < 0 ? kAcrossWire : kThreadHole) * m_dt;
      press(h.at, vector_of(h.force), resists, h.slot < 0 ? kCalms * resists : 0.0, speed_at(double(h.arc)));
    }
    const SutureTouch& t = m_state.touch;
    const double resists = kTipStiffness * m_dt;
    if (t.kind != SutureTouch::none) press(t.at, -vector_of(t.force), resists, kCalms * resists, speed_at(0));
  }
  /// @param resists  to changes of its velocity: stiffness of what presses times the tick [N s/m]
  /// @param damps    to moving beside what presses, which goes with `velocity` [N s/m]
  void press(const MaterialPoint& at, Vec3d force, double resists, double damps, Vec3d velocity) noexcept {
    const Vec3d f0 = force + resists * velocity_of(m_bodies, at) + damps * velocity;
    put_load(m_bodies, at, {.f0 = f0, .d = resists + damps}, {Owner::anchor, 0, 0});
  }
  /// Of the needle [m/s].
  Vec3d speed_at(double arc) const noexcept {
    return suture::speed_of(m_state.needle, rotate(m_state.needle.q, m_model.needle.place(arc)));
  }

  void find(std::uint64_t tick) noexcept {
    const int beads = m_model.needle.beads;
    for (int b = 0; b < beads; ++b) rest_bead(b, turn(tick, b));
    for (int n = 0; n <= last_out(m_model, m_state); ++n) rest_node(n, turn(tick, beads + n));
    if (beads > 0) find_tip();
    meet_rods();
  }

 private:
  static bool turn(std::uint64_t tick, int i) noexcept { return (tick + std::uint64_t(i)) % kLooksAnew == 0; }

  NearSkin look(int i, Vec3d p, bool anew) noexcept {
    MaterialPoint& near = m_state.near[size_t(i)];
    if (anew) near = look_everywhere(m_bodies, p);
    return look_again(m_bodies, near, p);
  }

  void rest_bead(int b, bool anew) noexcept {
    const suture::NeedleModel& m = m_model.needle;
    const double arc = m.bead(b), radius = 0.5 * m.wire;
    const Vec3d p = suture::needle_point(m, m_state.needle, arc);
    const NearSkin on = look(b, p, anew);
    if (on.there() && on.distance - radius < kSkinAhead && on.distance > -kDeepestRest &&
        !goes_through(m_model, m_state, on.at.body, arc, true) && !(b == 0 && pricks(on)))
      rest(b, on, radius);
    const WallPlaces walls = walls_near(m_models.walls, p);
    for (int k = 0; k < walls.count; ++k) {
      const WallPlace& wall = walls.list[size_t(k)];
      if (wall.distance - radius < kSkinAhead)
        touch(b, wall.normal, wall.distance - radius, {}, kHardStiffness, kWallFriction, -1);
    }
  }
  void rest(int b, const NearSkin& on, double radius) noexcept {
    const double gap = on.distance - radius;
    touch(b, on.normal, gap, velocity_of(m_bodies, on.at), kBodyStiffness, kTissueFriction, -1);
    if (gap < 0) push_tissue(m_bodies, on, -gap);
  }
  void touch(int b, Vec3d normal, double gap, Vec3d velocity, double stiffness, double friction, int rod) noexcept {
    const size_t before = m_work.needle.contacts.size();
    suture::NeedleContact c;
    c.bead = b;
    c.normal = normal;
    c.gap = gap;
    c.velocity = velocity;
    c.stiffness = stiffness;
    c.friction = friction;
    suture::add(m_work.needle.contacts, c, m_work.needle);
    if (m_work.needle.contacts.size() > before) m_work.contact_rods.push_back(rod);
    m_all.overflowed = m_all.overflowed || m_work.needle.overflowed;
  }

  void rest_node(int n, bool anew) noexcept {
    const int i = m_model.needle.beads + n;
    const double s = n * m_model.thread.spacing, radius = 0.5 * m_model.thread.stuff.diameter;
    const Vec3d p = m_state.thread.x[size_t(n)];
    const NearSkin on = look(i, p, anew);
    suture::SkinContact& c = m_work.skins[size_t(n)];
    const bool on_skin = on.there() && on.distance - radius < kSkinAhead && on.distance > -kDeepestRest &&
                         !goes_through(m_model, m_state, on.at.body, s, false) && !strangled(on.at.body) &&
                         !is_beside(on, p);
    // in a corner between both, what it is deeper in
    const WallPlaces walls = walls_near(m_models.walls, p);
    const WallPlace* nearest = nullptr;
    for (int k = 0; k < walls.count; ++k)
      if (!nearest || walls.list[size_t(k)].distance < nearest->distance) nearest = &walls.list[size_t(k)];
    if (nearest && nearest->distance - radius < kSkinAhead && !(on_skin && on.distance < nearest->distance)) {
      c = {n, nearest->point, nearest->normal, {0, 0, 0}, kHardStiffness, -1};
    } else if (on_skin) {
      // what is found deep in it comes out as bodies do
      const double deeper = std::max(0.0, radius - on.distance - kQuickestApart);
      const Vec3d velocity = velocity_of(m_bodies, on.at);
      c = {n, on.point + m_dt * velocity - deeper * on.normal, on.normal, velocity, kBodyStiffness, -1, 2 * radius};
      if (on.distance < radius) push_tissue(m_bodies, on, radius - on.distance);
    } else {
      keep_in_cavity(n, p, c);
    }
  }
  /// Below a patch of skin, but not in the organ: another side of it is nearer, whose vertices are further away.
  bool is_beside(const NearSkin& on, Vec3d p) const noexcept {
    return on.at.body.is(BodyKind::organ) && on.distance < -kSureOfSide &&
           !encloses(surface_of(m_bodies, on.at.body), p);
  }
  void keep_in_cavity(int n, Vec3d p, suture::SkinContact& c) const noexcept {
    for (int k = 0; k < 3; ++k) {
      const double low = double(m_cavity.low[k]), high = double(m_cavity.high[k]);
      if (p[k] > low + kSkinAhead && p[k] < high - kSkinAhead) continue;
      Vec3d on = p, normal;
      on[k] = p[k] < 0.5 * (low + high) ? low : high;
      normal[k] = p[k] < 0.5 * (low + high) ? 1 : -1;
      c = {n, on, normal, {0, 0, 0}, kHardStiffness, -1};
      return;
    }
  }

  /// Its own law says what a loop meets there (suture_strangle.hpp).
  bool strangled(BodyId body) const noexcept { return m_state.sling.lies_around(body); }

  Vec3d tip() const noexcept { return suture::needle_point(m_model.needle, m_state.needle, 0); }
  Vec3d drives() const noexcept { return suture::needle_direction(m_model.needle, m_state.needle, 0); }
  bool pricks(const NearSkin& on) const noexcept { return dot(drives(), on.normal) < -kPricks; }

  /// Skin in front of the tip: of the body that it is outside of, or of that it is in.
  void find_tip() noexcept {
    SutureTouch& t = m_state.touch;
    const bool inside = m_state.inside.exists();
    const NearSkin on =
        inside ? nearest_skin(m_bodies, m_state.inside, tip(), 0.015) : look_again(m_bodies, m_state.near[0], tip());
    const auto kind = inside ? SutureTouch::inside : SutureTouch::outside;
    const Vec3d faces = t.kind == kind ? vector_of(t.normal) : on.normal;
    const double side = inside ? -1 : 1, off = side * on.distance, ahead = -side * dot(drives(), faces);
    if (t.kind == kind && on.there() && on.at.body == t.at.body && dot(on.normal, vector_of(t.normal)) < kSameSide) {
      // it has been drawn so far that another part of the skin is nearer
      if (-side * dot(tip() - place_of(m_bodies, t.at), vector_of(t.normal)) < -kTipLeaves) t = {};
      return;
    }
    if (t.kind != SutureTouch::none &&
        (t.kind != kind || !on.there() || t.at.body != on.at.body || off > kTipLeaves || ahead < 0.5 * kPricks))
      t = {};
    if (t.kind == SutureTouch::none) {
      if (!on.there() || off > kTipAhead || ahead < kPricks || off < -kDeepestRest) return;
      t = {};
      t.kind = kind;
      t.at = attach(m_bodies, on.at.body, on.point);
      t.normal = array_of(on.normal);
      return;
    }
    // a dimple's facets are steep, and a tip in its bottom is nearest to one after the other
    const Vec3d normal = vector_of(t.normal);
    t.normal = array_of(normalised(normal + kTurnsTo * (on.normal - normal), on.normal));
  }

  void meet_rods() noexcept {
    for (size_t i = 0; i < m_all.rods.size(); ++i) {
      const SutureRod& rod = m_all.rods[i];
      const bool held = rod.held == std::int32_t(m_index);
      if (m_model.has_needle() && !(held && rod.holds_needle)) at_rod(int(i), rod);
      if (m_model.has_thread() && !is_own_mouth(m_model, m_state, rod)) keep_off(rod, held && !rod.holds_needle);
    }
    if (m_model.has_thread() && m_model.has_needle()) keep_off_needle();
  }
  void at_rod(int number, const SutureRod& rod) noexcept {
    const suture::NeedleModel& m = m_model.needle;
    const Vec3d off = collision::nearest_on_axis(rod.now, m_state.needle.x) - m_state.needle.x;
    const double far = m.length + rod.now.radius;
    if (dot(off, off) > far * far) return;
    const Vec3d axis = rod.now.b - rod.now.a;
    for (int b = 0; b < m.beads; ++b) {
      const Vec3d p = suture::needle_point(m, m_state.needle, m.bead(b));
      const double w = std::clamp(dot(p - rod.now.a, axis) / std::max(1e-12, dot(axis, axis)), 0.0, 1.0);
      const Vec3d on = rod.now.a + w * axis;
      const double away = length(p - on), gap = away - rod.now.radius - 0.5 * m.wire;
      if (gap > kSkinAhead) continue;
      // The rod is where it is to be: what it has gone into the bead is way, not speed.
      touch(b, normalised(p - on, {0, 0, 1}), gap, {}, kHardStiffness, kSteelFriction, number);
    }
  }
  /// Jaws that hold thread keep off all of it but what is between them. Blades are sunk into it by half its thickness:
  /// where they meet, its axis has room between them, and it stays there until they cut it.
  void keep_off(const SutureRod& rod, bool holds) noexcept {
    const double sunk = rod.cuts ? 0.5 * m_model.thread.stuff.diameter : 0;
    suture::Obstacle o{true, rod.now.a, rod.now.b, std::max(0.0, rod.now.radius - sunk), -1};
    if (rod.astride) o.gathered = m_work.gathered;
    if (holds) {
      const SuturePinch& p = m_all.pinches[size_t(rod.tag.index)];
      const int room = int(kRoomAtPinch / m_model.thread.spacing) + 1;
      if (p.count == 0 || p.suture != std::int32_t(m_index)) return;
      o.spared = p.lowest - room, o.spared_end = p.highest + room;
    }
    if (rod.slot < int(m_work.obstacles.size())) m_work.obstacles[size_t(rod.slot)] = o;
  }
  void keep_off_needle() noexcept {
    const suture::NeedleModel& m = m_model.needle;
    const int first = int(m_work.obstacles.size()) - kNeedlePieces;
    for (int k = 0; k < kNeedlePieces && first >= 0; ++k) {
      const auto at = [&](int i) {
        return suture::needle_point(m, m_state.needle, kBeforeSwage * m.length * i / kNeedlePieces);
      };
      m_work.obstacles[size_t(first + k)] = {true, at(k), at(k + 1), 0.5 * m.wire, -1};
    }
  }

  const SutureModels& m_models;
  const SutureModel& m_model;
  size_t m_index;
  const Bodies& m_bodies;
  const tissue::Box& m_cavity;
  double m_dt;
  SutureState& m_state;
  SutureWorks& m_all;
  SutureWork& m_work;
};

}  // namespace

NearSkin nearest_skin(const Bodies& bodies, BodyId body, Vec3d p, double reach) noexcept {
  if (body.is(BodyKind::strand)) {
    NearSkin best;
    for (int e = 0; e + 1 < bodies.strand(body.index()).nodes(); ++e) {
      const NearSkin next = at_element(bodies, body, e, p);
      if (next.there() && next.distance < best.distance) best = next;
    }
    return best.there() && best.distance < reach ? best : NearSkin{};
  }
  const Surface& surface = surface_of(bodies, body);
  if (!surface.pose->bounds.reaches(p, reach)) return {};
  return at_surface(bodies, body, nearest_vertex_near(surface, p, reach), p);
}

void rest_on_tissue(const SutureModels& models, const Bodies& bodies, const tissue::Box& cavity, std::uint64_t tick,
                    double dt, Suture::States& states, SutureWorks& work) noexcept {
  for (size_t i = 0; i < states.size(); ++i) {
    Resting resting(models, i, bodies, cavity, dt, states[i], work);
    resting.bear();
    resting.find(tick);
  }
}

}  // namespace trocar::interactions
