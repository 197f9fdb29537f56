// The equations of one solve: implicit Euler, linear in what nodes move.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/spin.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

constexpr double kSlack = 1e-3;  ///< of the breaking force: what pulls less is loose
constexpr double kAhead = 0.7;   ///< that an element's ends are looked ahead, in spacings

void add_inertia(Tick& t) {
  const double mass = t.m.stuff.mass * t.m.spacing;
  for (int i = 0; i < t.m.nodes; ++i) {
    const double own = (i == 0 || i + 1 == t.m.nodes ? 0.5 : 1) * mass;
    t.w.system.add(i, i, 1, in_all_ways(own * (1 / (t.h * t.h) + t.m.drag / t.h)));
    t.w.system.push(i, own * (t.s.v[i] / t.h + t.m.gravity));
  }
}

/// Stretch is so stiff that an element which turns while its length is taken along its old direction would be pulled
/// back by its own turning: where the thread hangs loose it is linearised about where its ends are bound
/// for. Not where it touches itself: what solves correct there is no speed.
void add_stretch(Tick& t) {
  const double stiffness = t.m.stuff.stretch / t.m.spacing, slack = kSlack * t.m.stuff.knotted_break_force;
  for (int e = 0; e + 1 < t.m.nodes; ++e) {
    if (!t.s.alive[e]) continue;
    Vec3d ahead{};
    double r = t.w.length[e];
    Vec3d n = t.w.along[e];
    if (t.self + t.touching == 0 && stiffness * (r - t.m.spacing) < slack) {
      ahead = t.h * (t.s.v[e + 1] - t.s.v[e]);
      ahead -= dot(ahead, n) * n;
      const double far = dot(ahead, ahead), most = kAhead * t.m.spacing;
      if (far > most * most) ahead *= most / std::sqrt(far);
      const Vec3d d = r * n + ahead;
      r = length(d);
      n = d / r;
    }
    const double pull = stiffness * (r - t.m.spacing);
    const Symmetric k = along_and_across(stiffness, pull > 0 ? pull / r : 0, n);
    const Vec3d f = pull * n - k * ahead;
    t.w.system.add(e, e, 1, k), t.w.system.add(e + 1, e + 1, 1, k), t.w.system.add(e + 1, e, -1, k);
    t.w.system.push(e, f);
    t.w.system.push(e + 1, -f);
  }
}

/// Bends yield: beyond the yield curvature only the moment there is left, and a little more with the bend that stays.
/// The share of the stiffness that a solve keeps is what makes its moment right if it bends as far as the last did.
void add_bending(Tick& t) {
  const double k = t.m.stuff.bend / (t.m.spacing * t.m.spacing * t.m.spacing);
  const double yield = t.m.stuff.yield_curvature * t.m.spacing;
  const double harden = t.m.stuff.hardening / (1 - t.m.stuff.hardening);
  for (int i = 1; i + 1 < t.m.nodes; ++i) {
    if (!bends(t.s, i)) continue;
    const double share = yield > 0 ? kept_share(yield, t.s.bend[i].z) : 1;
    const Vec3d back = harden * t.w.bend_rest[i];  // the part of the moment that hardening has made
    const Vec3d moment = back + share * (t.w.bend_now[i] - t.w.bend_rest[i] - back);
    const Symmetric stiff = along_and_across(0, k * share, t.w.node_along[i]);
    const Vec3d f = (-k * t.m.spacing) * moment;
    t.w.system.add_bend(i, stiff);
    t.w.system.push(i - 1, f), t.w.system.push(i, -2.0 * f), t.w.system.push(i + 1, f);
  }
}

void add_self(Tick& t) {
  for (int k = 0; k < t.self; ++k) {
    const Touch& touch = t.w.self[k];
    const std::int32_t nodes[4] = {touch.a, touch.a + 1, touch.b, touch.b + 1};
    const double c[4] = {1 - touch.s, touch.s, touch.t - 1, -touch.t};
    t.w.system.add_term(nodes, c, 4, along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal));
    const Vec3d f = touch.press * touch.normal - touch.rub_stiffness * touch.strain;
    for (int j = 0; j < 4; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_obstacles(Tick& t) {
  for (int k = 0; k < t.touching; ++k) {
    const Touch& touch = t.w.touch[k];
    const std::int32_t nodes[2] = {touch.a, touch.a + 1};
    const double c[2] = {1 - touch.s, touch.s};
    const Symmetric stiff = along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal);
    t.w.system.add_term(nodes, c, 2, stiff);
    const Vec3d f = touch.press * touch.normal - touch.rub_stiffness * touch.strain + stiff * touch.moved;
    for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_spring(Tick& t, const ThreadPlace& at, const Symmetric& stiff, Vec3d force) {
  const std::int32_t nodes[2] = {at.element, at.element + 1};
  const double c[2] = {1 - at.w, at.w};
  t.w.system.add_term(nodes, c, 2, stiff);
  for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * force);
}

void add_holds(Tick& t) {
  const double k = hold_stiffness(t.m);
  for (int n = 0; n < t.m.holds; ++n) {
    const HoldState& h = t.s.holds[n];
    if (!h.active) continue;
    const ThreadPlace at = place_at(t.m, h.s);
    const Vec3d d = t.w.along[at.element];
    const bool given = n < int(t.drive.holds.size());
    const double rubs = given ? t.drive.holds[n].friction_limit : 0;
    const Vec3d off = point_at(t.m, t.s, h.s) - h.seen;
    const double limit = rubs > 0 ? rubs + clip_stops(t.s, h.s, -dot(off, d), kClipHalfWidth + kHolderHalfWidth) : 0;
    const double along = limit > 0 ? k * kept_share(limit / k, h.reached) : k;
    const Symmetric stiff = along_and_across(along, k, d);
    add_spring(t, at, stiff, stiff * (hold_target(t, n) - point_at(t.m, t.s, h.s)));
    if (!given || is_zero(t.drive.holds[n].direction)) continue;
    const Vec3d aim = aim_target(t, n, t.part), lies = t.s.x[at.element + 1] - t.s.x[at.element];
    const double turn = turn_stiffness(t.m);
    // what lies the other way round would be at rest against its hold: it is drawn to where it belongs
    const bool backwards = dot(lies, aim) < 0;
    const Symmetric across = backwards ? in_all_ways(turn) : along_and_across(0, turn, aim);
    const std::int32_t nodes[2] = {at.element, at.element + 1};
    const double c[2] = {-1, 1};
    t.w.system.add_term(nodes, c, 2, across);
    const Vec3d f = backwards ? turn * (t.m.spacing * aim - lies) : -(across * lies);
    for (int j = 0; j < 2; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_passages(Tick& t) {
  for (int n = 0; n < std::min(t.m.passages, int(t.drive.passages.size())); ++n) {
    const PassageState& p = t.s.passages[n];
    if (!p.active) continue;
    const double k = t.drive.passages[n].stiffness;
    const SmoothPlace smooth = smooth_place(t.m, p.s);
    const Vec3d d = passage_direction(t, n);
    const double stops = clip_stops(t.s, p.s, -dot(smooth.of(t.s.x) - p.seen, d), kClipHalfWidth);
    const double along = k * kept_share(passage_bound(t, n) + stops / k, p.reached);
    const Symmetric stiff = along_and_across(along, k, d);
    t.w.system.add_term(smooth.nodes, smooth.c, 3, stiff);
    const Vec3d f = stiff * (passage_target(t, n) - smooth.of(t.s.x));
    for (int j = 0; j < 3; ++j) t.w.system.push(smooth.nodes[j], smooth.c[j] * f);
  }
}

void add_ties(Tick& t) {
  const double k = t.m.stuff.stretch / t.m.spacing;
  for (int n = 0; n < t.m.ties; ++n) {
    const TieState& tie = t.s.ties[n];
    if (!tie.active) continue;
    const bool turned_round = tie.s > tie.t;
    const ThreadPlace a = place_at(t.m, turned_round ? tie.t : tie.s), b = place_at(t.m, turned_round ? tie.s : tie.t);
    if (b.element <= a.element + 1) continue;
    const std::int32_t nodes[4] = {a.element, a.element + 1, b.element, b.element + 1};
    const double c[4] = {1 - a.w, a.w, b.w - 1, -b.w};
    t.w.system.add_term(nodes, c, 4, in_all_ways(k));
    const Vec3d offset = turned_round ? tie.offset : -tie.offset;  // wanted from b to a
    const Vec3d f = k * (offset - point_at(t.m, t.s, turned_round ? tie.t : tie.s) +
                         point_at(t.m, t.s, turned_round ? tie.s : tie.t));
    for (int j = 0; j < 4; ++j) t.w.system.push(nodes[j], c[j] * f);
  }
}

void add_skins(Tick& t) {
  for (int k = 0; k < std::min(t.m.skins, int(t.drive.skins.size())); ++k) {
    if (!t.given_skin(k)) continue;
    const Touch touch = skin_touch(t, k);
    if (!(touch.press > 0)) continue;
    const Symmetric stiff = along_and_across(touch.stiffness, touch.rub_stiffness, touch.normal);
    t.w.system.add(touch.a, touch.a, 1, stiff);
    const Vec3d across = touch.moved - dot(touch.moved, touch.normal) * touch.normal;
    t.w.system.push(touch.a, touch.press * touch.normal + touch.rub_stiffness * (across - touch.strain));
  }
}

}  // namespace

void couple_touching(Tick& t) noexcept {
  t.w.system.open();
  for (int k = 0; k < t.self; ++k) {
    const Touch& touch = t.w.self[k];
    const std::int32_t nodes[4] = {touch.a, touch.a + 1, touch.b, touch.b + 1};
    t.w.system.couple(nodes, 4);
  }
  for (int k = 0; k < t.m.ties; ++k) {
    const TieState& tie = t.s.ties[k];
    const int a = place_at(t.m, std::min(tie.s, tie.t)).element, b = place_at(t.m, std::max(tie.s, tie.t)).element;
    const std::int32_t nodes[4] = {a, a + 1, b, b + 1};
    if (tie.active && b > a + 1) t.w.system.couple(nodes, 4);
  }
  couple_clips(t);
  t.w.system.arrange();
}

void add_terms(Tick& t) noexcept {
  add_inertia(t);
  add_stretch(t);
  add_bending(t);
  add_twist(t.m, t.s, t.w);
  add_self(t);
  add_obstacles(t);
  add_skins(t);
  add_holds(t);
  add_passages(t);
  add_ties(t);
  add_clips(t);
}

}  // namespace trocar::suture
