#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/suture_strangle.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {
namespace {

constexpr std::uint64_t kFindsEvery = 4;  // ticks in which a loop looks what it lies around
constexpr double kTouchesAhead = 0.0004;  // [m] contacts are there before they touch
constexpr double kElementsAlong = 0.012;  // [m] of a strand to either side of a loop that thread may lie on
constexpr double kHoldsFrom = 0.0003;     // [m] of depth: where it has sunk in
constexpr double kOffWithin = 0.0002;     // [m] of an end: it is off
constexpr double kGrooveRubs = 0.2;       // of thread on tissue that it has sunk into                    [d]
constexpr double kGrooveStiff = 3000;     // [N/m] of its sides, a node
constexpr double kGroove = 0.4;           // ... as deep as this, in radii of the strand                 [d]
constexpr double kSkinHardens = 0.15;     // of the thread's thickness, as suture::set_press() has it
constexpr double kMostStiff = 300000;     // [N/m] of all that presses on a strand, taken into account
constexpr double kLeastStiff = 4000;      // ... and at least: a strand weighs next to nothing
constexpr double kKeepsGoing = 0.5;       // of a strand's velocity, against which it is not held
constexpr double kAtRest = 0.2;           // [N] by which a loop may pull beyond its tension
constexpr double kMostSunk = 0.93;        // of the depth at which a strand is crushed
constexpr double kKnot = 0.0015;          // [m] that a knot at the mouth keeps a strand off
constexpr double kKnotPushes = 12000;     // [N/m] with which it does
constexpr double kLeastDepth = 1e-5;      // [m] at which a law's secant is taken
constexpr double kRoot = 0.03;            // [m] of what a strand grows out of, behind its end
constexpr double kBesideNext = 1.2;       // thicknesses of both threads from one loop's middle to the next one's
constexpr double kOffNext = 1;            // tangent of the slope that keeps two loops apart, at its steepest        [d]

/// Where a point is beside a strand's middle line.
struct Beside {
  StrandPlace place;
  Vec3d on, out;      ///< nearest point of the line [m]; unit, from there to the point
  double away = 1e9;  ///< [m]

  bool there() const noexcept { return away < 1e8; }
};

void look_at(const tissue::StrandState& s, int e, Vec3d p, Beside& best) noexcept {
  const Vec3d a = s.x[size_t(e)], ab = s.x[size_t(e) + 1] - a;
  const double w = std::clamp(dot(p - a, ab) / std::max(1e-12, dot(ab, ab)), 0.0, 1.0);
  const Vec3d on = a + w * ab, off = p - on;
  const double away = length(off);
  if (away < best.away) best = {{e, w}, on, away > 1e-9 ? off / away : any_perpendicular(normalised(ab)), away};
}

/// Along what still hangs together about the place.
Beside beside(const StrandBody& body, const tissue::StrandState& s, StrandPlace around, Vec3d p) noexcept {
  Beside best;
  const double from = arc_at(body, around);
  for (int e = around.element; e >= 0 && s.alive[size_t(e)] && from - body.arc[size_t(e) + 1] < kElementsAlong; --e)
    look_at(s, e, p, best);
  for (int e = around.element + 1;
       e + 1 < body.nodes() && s.alive[size_t(e)] && body.arc[size_t(e)] - from < kElementsAlong; ++e)
    look_at(s, e, p, best);
  return best;
}

/// Does the segment pass through the triangle? +1, -1: which way; 0: no. `w`: where on the segment.
int passes_through(Vec3d p, Vec3d q, Vec3d a, Vec3d b, Vec3d c, double& w) noexcept {
  const Vec3d normal = cross(b - a, c - a), d = q - p;
  const double speed = dot(d, normal), height = dot(a - p, normal);
  if (!(std::fabs(speed) > 1e-30)) return 0;
  w = height / speed;
  if (!(w >= 0 && w < 1)) return 0;
  const Vec3d at = p + w * d;
  const double u = dot(cross(b - a, at - a), normal), v = dot(cross(c - b, at - b), normal),
               t = dot(cross(a - c, at - c), normal);
  if (u < 0 || v < 0 || t < 0) return 0;
  return speed > 0 ? 1 : -1;
}

class Strangling {
 public:
  Strangling(const SutureModels& models, std::size_t index, const Bodies& bodies, double dt, Suture::States& states,
             SutureWork& w) noexcept
      : m_models(models),
        m_states(states),
        m_index(index),
        m_model(models.list[index]),
        m_bodies(bodies),
        m_dt(dt),
        m_state(states[index]),
        m_sling(m_state.sling),
        m_work(w) {}

  /// What is drawn against the tube's end lies on the knot there.
  void lie_on_knot(const SlingAround& a) noexcept {
    if (m_sling.stage != SlingState::open) return;
    const StrandBody& body = m_bodies.strand(a.at.body.index());
    const Beside at = beside(body, m_bodies.strand_state(a.at.body.index()), place_on_rod(a.at), m_sling.mouth.tip);
    if (!at.there()) return;
    const size_t e = size_t(at.place.element);
    const double depth = std::min(body.model.radius[e], std::max(0.0, a.radius)) + kKnot - at.away;
    if (depth <= 0) return;
    const Vec3d push = (-kKnotPushes * depth) * at.out;
    hold_back(at_element(m_bodies, a.at.body.index(), at.place.element, at.place.w, {}), push, m_dt * kKnotPushes);
    m_work.sling.force -= push;
  }

  /// A push on a strand, which is held against it, but not against all of its own velocity.
  void hold_back(const MaterialPoint& at, Vec3d push, double d) noexcept {
    put_load(m_bodies, at, {.f0 = push + kKeepsGoing * d * velocity_of(m_bodies, at), .d = d}, {Owner::body, 0, 0});
  }

  /// No more than both ends of a loop pull with: what a solve shows beyond that is not there in the next one.
  Vec3d bounded(Vec3d pull) const noexcept {
    const double most = 2 * (std::max(0.0, m_sling.tension) + kAtRest), size = length(pull);
    return size > most ? (most / size) * pull : pull;
  }

  void bear() noexcept {
    for (std::int32_t i = 0; i < m_sling.around_count; ++i) {
      const SlingAround& a = m_sling.around[size_t(i)];
      hold_back(a.at, bounded(a.pull), m_dt * std::clamp(a.stiff, kLeastStiff, kMostStiff));
      lie_on_knot(a);
    }
  }

  void find() noexcept {
    const std::array<SlingAround, kMostAround> before = m_sling.around;
    const std::int32_t had = m_sling.around_count;
    m_sling.around_count = 0;
    if (loop_nodes() < 4) return;
    measure();
    for (size_t i = 0; i < m_bodies.strand_count() && m_sling.around_count < kMostAround; ++i) {
      SlingAround found;
      for (std::int32_t k = 0; k < had; ++k)
        if (before[size_t(k)].at.body == BodyId::strand(i)) found = before[size_t(k)];
      const bool tight = found.at.body.exists() && found.squeeze > kHoldsFrom && has_sunk_in(m_bodies.strand(i), found);
      if (tight ? sits(i, found) : passes(i, found)) m_sling.around[size_t(m_sling.around_count++)] = found;
    }
  }

  void press() noexcept {
    std::fill(m_work.sling.on.begin(), m_work.sling.on.end(), -1);
    for (std::int32_t i = 0; i < m_sling.around_count; ++i) {
      SlingAround& a = m_sling.around[size_t(i)];
      a.radius = m_sling.knot / portable::two_pi - 0.5 * m_model.thread.stuff.diameter;
      const size_t strand = a.at.body.index();
      a.bears = strand < m_models.strangles.size() ? m_models.strangles[strand] : a.bears;
      for (int n = 0; n < loop_nodes(); ++n) press_node(i, a, n);
    }
    for (std::int32_t i = 0; i < m_sling.around_count; ++i) {
      const SlingAround& a = m_sling.around[size_t(i)];
      if (has_sunk_in(m_bodies.strand(a.at.body.index()), a))
        carry(i);
      else
        stand_still(i);
    }
  }

 private:
  int loop_nodes() const noexcept {
    if (!m_sling.computed()) return 0;
    return std::min(m_model.thread.nodes, suture::place_at(m_model.thread, m_sling.knot).element + 1);
  }

  /// What has sunk in goes where the strand goes. Planes that moved in the solve would have to push it there, and as a
  /// skin hardens, those before it push too hard and those behind it let go.
  void carry(std::int32_t number) noexcept {
    const int count = loop_nodes();
    for (int n = 0; n < count; ++n) {
      suture::SkinContact& plane = m_work.skins[size_t(n)];
      if (m_work.sling.on[size_t(n)] != number || plane.node != n) continue;
      m_state.thread.x[size_t(n)] += m_dt * plane.velocity;
      plane.velocity = {};
    }
    if (m_sling.stage != SlingState::left) return;
    const Vec3d velocity = velocity_of(m_bodies, m_sling.around[size_t(number)].at);
    for (int n = count; n <= m_sling.parted && n < m_model.thread.nodes; ++n)
      m_state.thread.x[size_t(n)] += m_dt * velocity;
  }

  /// What lies on one side only is left behind for a tick, and then pressed by the depth at which it lies, as the law
  /// says: planes that came at it would push with the skin's hardened stiffness, the strand, which weighs nothing,
  /// would be thrown back by that, and both would shake until one went through the other.
  void stand_still(std::int32_t number) noexcept {
    for (int n = 0, count = loop_nodes(); n < count; ++n) {
      suture::SkinContact& plane = m_work.skins[size_t(n)];
      if (m_work.sling.on[size_t(n)] != number || plane.node != n) continue;
      const Vec3d comes = dot(plane.velocity, plane.normal) * plane.normal;
      plane.velocity -= comes;
      plane.point -= m_dt * comes;
    }
  }

  /// Middle of the loop, and how far it reaches.
  void measure() noexcept {
    const int count = loop_nodes();
    m_middle = {};
    for (int n = 0; n < count; ++n) m_middle += m_state.thread.x[size_t(n)];
    m_middle = m_middle / double(count);
    m_reach = 0;
    for (int n = 0; n < count; ++n) m_reach = std::max(m_reach, length(m_state.thread.x[size_t(n)] - m_middle));
  }

  /// One that has sunk in leaves over an end, or not at all.
  bool sits(size_t strand, SlingAround& found) const noexcept {
    const StrandBody& body = m_bodies.strand(strand);
    const tissue::StrandState& s = m_bodies.strand_state(strand);
    const Beside at = beside(body, s, place_on_rod(found.at), m_middle);
    if (!at.there() || at.away > body.model.radius[size_t(at.place.element)]) return false;
    found.at = at_element(m_bodies, strand, at.place.element, at.place.w, {});
    return free_end(body, s, at.place).away > kOffWithin;
  }

  /// The surface is a fan about the loop's middle. Over an end that grows out of something the strand is taken to
  /// continue in there: what swells up into a loop that lies around its beginning does not let that off.
  bool passes(size_t strand, SlingAround& found) const noexcept {
    const StrandBody& body = m_bodies.strand(strand);
    const tissue::StrandState& s = m_bodies.strand_state(strand);
    int net = 0;
    for (int e = 0; e + 1 < body.nodes(); ++e)
      if (s.alive[size_t(e)]) net += passes(s.x[size_t(e)], s.x[size_t(e) + 1], strand, e, found);
    const int last = body.nodes() - 1;
    const auto root = [&](int node, int next) {
      return s.x[size_t(node)] + kRoot * normalised(s.x[size_t(node)] - s.x[size_t(next)]);
    };
    SlingAround at_end = found;
    if (body.model.prescribed[0] && s.alive[0])
      if (const int sign = passes(root(0, 1), s.x[0], strand, 0, at_end); sign != 0) {
        net += sign;
        at_end.at.weight[0] = 0;
        found = at_end;
      }
    if (body.model.prescribed[size_t(last)] && s.alive[size_t(last) - 1])
      if (const int sign = passes(s.x[size_t(last)], root(last, last - 1), strand, last - 1, at_end); sign != 0) {
        net += sign;
        at_end.at.weight[0] = 1;
        found = at_end;
      }
    return net != 0;
  }
  /// How often, and which way, the loop's surface is passed through from p to q, which is element `e` or belongs to it.
  int passes(Vec3d p, Vec3d q, size_t strand, int e, SlingAround& found) const noexcept {
    if (length(0.5 * (p + q) - m_middle) > m_reach + length(q - p)) return 0;
    const int count = loop_nodes();
    int net = 0;
    for (int n = 0; n < count; ++n) {
      double w = 0;
      const int sign = passes_through(p, q, m_middle, m_state.thread.x[size_t(n)],
                                      m_state.thread.x[size_t(n + 1 < count ? n + 1 : 0)], w);
      if (sign == 0) continue;
      net += sign;
      found.at = at_element(m_bodies, strand, e, w, {});
    }
    return net;
  }

  /// Where another loop has sunk in beside this one, the groove's side leads away from that: threads lie side by side.
  /// @param at  where on the strand the node lies [m]
  double slope_off_next(const SlingAround& mine, double at) const noexcept {
    double slope = 0;
    const double here = arc_of(m_bodies.models, mine.at);
    for (std::size_t i = 0; i < m_states.size(); ++i) {
      const SlingState& other = m_states[i].sling;
      if (i == m_index || !m_models.list[i].sling.there()) continue;
      const double room = 0.5 * kBesideNext * (m_model.thread.stuff.diameter + m_models.list[i].thread.stuff.diameter);
      for (std::int32_t k = 0; k < other.around_count; ++k) {
        const SlingAround& a = other.around[size_t(k)];
        if (a.at.body != mine.at.body || !(a.squeeze > kHoldsFrom)) continue;
        const double there = arc_of(m_bodies.models, a.at);
        const double side = here > there || (here == there && i < m_index) ? 1 : -1;
        slope += side * kOffNext * std::clamp((room - side * (at - there)) / room, 0.0, 1.0);
      }
    }
    return slope;
  }

  /// The plane that a node lies on there, such that it presses as the law says.
  void press_node(std::int32_t number, const SlingAround& a, int n) noexcept {
    const StrandBody& body = m_bodies.strand(a.at.body.index());
    const tissue::StrandState& s = m_bodies.strand_state(a.at.body.index());
    const Vec3d x = m_state.thread.x[size_t(n)];
    const Beside at = beside(body, s, place_on_rod(a.at), x);
    if (!at.there()) return;
    const size_t e = size_t(at.place.element);
    const double radius = body.model.radius[e], lumen = body.model.lumen[e], half = 0.5 * m_model.thread.stuff.diameter;
    const double depth = radius + half - at.away;
    if (depth < -kTouchesAhead) return;
    std::int32_t& on = m_work.sling.on[size_t(n)];
    if (on >= 0 && m_work.sling.deep[size_t(n)] >= depth) return;  // it lies deeper in another one
    const StrangleLaw law =
        strangle_law(youngs_of(body, at.place.element), radius, lumen, std::max(depth, kLeastDepth));
    const double piece = m_model.thread.spacing * (n == 0 ? 0.5 : 1.0);
    const FreeEnd end = free_end(body, s, at.place);
    const Vec3d along = normalised(s.x[e + 1] - s.x[e]);
    const double slope =
        end.side * slope_to_end(radius, std::max(0.0, depth), end.away) + slope_off_next(a, arc_at(body, at.place));
    const Vec3d normal = normalised(at.out + slope * along);
    const Vec3d velocity = s.v[e] + at.place.w * (s.v[e + 1] - s.v[e]);
    on = number;
    m_work.sling.stiff[size_t(n)] = piece * law.slope;
    m_work.sling.deep[size_t(n)] = depth;
    suture::SkinContact& plane = m_work.skins[size_t(n)];
    plane = plane_for(n, x, normal, velocity, piece * law.force, depth);
    // the deeper in its groove, the more the tissue beside it holds it
    const double on_it = m_model.thread.stuff.friction_tissue, sunk = std::clamp(depth / (kGroove * radius), 0.0, 1.0);
    plane.friction = on_it + sunk * std::max(0.0, kGrooveRubs - on_it);
  }

  /// A skin hardens with its own depth: F = k o (1 + (o / c)^2). Where it begins, o above the thread's side, so that it
  /// presses as the law says here; k is that of the groove's sides, which friction strains against.
  suture::SkinContact plane_for(int n, Vec3d x, Vec3d normal, Vec3d velocity, double force,
                                double depth) const noexcept {
    const double half = 0.5 * m_model.thread.stuff.diameter, c = kSkinHardens * m_model.thread.stuff.diameter;
    double o = force / kGrooveStiff;
    for (int k = 0; k < 12; ++k) {
      const double q = (o / c) * (o / c);
      o -= (o * (1 + q) - force / kGrooveStiff) / (1 + 3 * q);
    }
    suture::SkinContact plane;
    plane.node = n;
    plane.normal = normal;
    plane.velocity = velocity;
    plane.stiffness = kGrooveStiff;
    const double over = depth > 0 ? o : depth;  // of the thread's side in the plane
    plane.point = x - (half - over) * normal + m_dt * velocity;
    return plane;
  }

  const SutureModels& m_models;
  const Suture::States& m_states;
  std::size_t m_index;
  const SutureModel& m_model;
  const Bodies& m_bodies;
  double m_dt;
  SutureState& m_state;
  SlingState& m_sling;
  SutureWork& m_work;
  Vec3d m_middle;
  double m_reach = 0;
};

}  // namespace

StrangleLaw strangle_law(double youngs, double radius, double lumen, double depth) noexcept {
  const double wall = lumen > 0 ? radius - lumen : radius;
  const double crushed = 1 - kCrushed * wall / radius;
  const double e = std::min(depth / radius, kMostSunk * crushed), left = 1 - e / crushed;
  StrangleLaw law;
  law.force = youngs * radius * e / left;
  law.slope = youngs / (left * left);
  law.force += law.slope * (depth - e * radius);  // straight on beyond what the law is good for
  return law;
}

double slope_to_end(double radius, double depth, double away) noexcept {
  if (!(away < 20 * radius)) return 0;
  return depth / radius * portable::exp(-kSteepness * away / radius);
}

double cover_of_loop(double radius, double lumen, double inner) noexcept {
  if (!(lumen > 0)) return 0;
  return 1 - std::clamp((inner - (radius - lumen)) / lumen, 0.0, 1.0);
}

double cover_of_loop(const BodyModels& models, const SlingAround& a) noexcept {
  const tissue::StrandModel& m = models.strand_bodies[a.at.body.index()].model;
  return cover_of_loop(m.radius[size_t(a.at.element)], m.lumen[size_t(a.at.element)], a.radius);
}

double youngs_of(const StrandBody& body, int element) noexcept {
  const size_t e = size_t(element);
  const double r = body.model.radius[e], lumen = body.model.lumen[e];
  return body.model.stretch[e] / (portable::pi * (r * r - lumen * lumen));
}

FreeEnd free_end(const StrandBody& body, const tissue::StrandState& s, StrandPlace place) noexcept {
  const auto held = [&](int node) { return body.model.prescribed[size_t(node)] != 0; };
  const auto apart = [&](int e) { return length(s.x[size_t(e) + 1] - s.x[size_t(e)]); };
  FreeEnd end;
  double way = place.w * apart(place.element);
  int e = place.element - 1;
  for (; e >= 0 && s.alive[size_t(e)]; --e) way += apart(e);
  if (e >= 0 || !held(0)) end = {way, -1};
  way = (1 - place.w) * apart(place.element);
  for (e = place.element + 1; e + 1 < body.nodes() && s.alive[size_t(e)]; ++e) way += apart(e);
  const bool free = e + 1 < body.nodes() || !held(body.nodes() - 1);
  if (free && way < end.away) end = {way, 1};
  return end;
}

void strangle(const SutureModels& models, const Bodies& bodies, std::uint64_t tick, double dt, Suture::States& states,
              SutureWorks& work) noexcept {
  for (size_t i = 0; i < states.size(); ++i) {
    const SutureModel& m = models.list[i];
    if (!m.sling.there()) continue;
    Strangling strangling(models, i, bodies, dt, states, work.list[i]);
    strangling.bear();
    if ((tick + i) % kFindsEvery == 0) strangling.find();
    strangling.press();
  }
}

}  // namespace trocar::interactions
