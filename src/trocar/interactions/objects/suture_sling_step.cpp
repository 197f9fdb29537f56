#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/suture_sling_shape.hpp>
#include <trocar/interactions/objects/suture_sling_step.hpp>

namespace trocar::interactions {
namespace {

constexpr double kFeedsOpen = 0.10;    // of the handle's way: as long as less is drawn, the loop is fed out
constexpr double kGain = 0.25;         // of what thread would have to go for a tension to be right, a tick
constexpr double kSpeedGain = 0.020;   // [m/s] a newton that a tension is off by, at most
constexpr double kRunsAtMost = 0.6;    // [m/s] thread is pulled out of the tube
constexpr double kAtMouth = 0.0025;    // [m] a knot is at the mouth
constexpr double kStowsBelow = 0.020;  // [m] of the instrument in the body, where an opened one is packed again
constexpr double kStandsBelow = 0.3;   // [N] of tension up to which the tube's end leads the thread's direction
constexpr double kCalmer = 0.3;        // of a tension that is new: the rest is the earlier value
constexpr double kJustBelow = 1e-6;    // of an element: a place in it that is a node
constexpr int kTieSlot = 0;

double thickness_of(const SutureModel& m) noexcept { return m.thread.stuff.diameter; }
/// The first node in the tube.
int first_inside(const SutureModel& m, double fed) noexcept {
  return std::min(m.thread.nodes - 1, int(fed / m.thread.spacing) + 1);
}
Vec3d at_mouth(const SutureModel& m, const SlingMouth& mouth, double side) noexcept {
  return mouth.tip + (kThreadsApart * side * thickness_of(m)) * mouth.up;
}
/// What way of thread puts a tension right that is off by so much.
double way_for(const SutureModel& m, double off, double length, double fastest, double dt) noexcept {
  const double way = kGain * off * std::max(length, 2 * m.thread.spacing) / m.thread.stuff.stretch;
  return std::min({way, kSpeedGain * off * dt, fastest * dt});
}

/// An element that comes out of the tube continues from the one before it without twist.
void wake(int e, suture::ThreadState& t) noexcept {
  const size_t i = size_t(e);
  t.alive[i] = 1;
  t.twist[i] = t.twist[i + 1] = 0;
  if (e == 0) return;
  const Vec3d before = normalised(t.x[i] - t.x[i - 1]), along = normalised(t.x[i + 1] - t.x[i], before);
  const Vec3d across = t.director[i - 1] - dot(t.director[i - 1], along) * along;
  t.director[i] = normalised(across, any_perpendicular(along));
}

void feed_to(const SutureModel& m, double fed, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const int before = first_inside(m, g.fed), after = first_inside(m, fed);
  for (int e = before; e < after; ++e) wake(e, s.thread);
  for (int e = after; e < before; ++e) s.thread.alive[size_t(e)] = 0;
  g.fed = fed;
  if (before == after) return;
  suture::take_hold(m.thread, s.thread, m.sling.first_hold + kFeedHold, (after - kJustBelow) * m.thread.spacing);
}

void lie_in_tube(const SutureModel& m, SutureState& s) noexcept {
  const SlingState& g = s.sling;
  const Vec3d from = at_mouth(m, g.mouth, 1);
  for (int n = first_inside(m, g.fed) + 1; n < m.thread.nodes; ++n) {
    s.thread.x[size_t(n)] = from - (n * m.thread.spacing - g.fed) * g.mouth.axis;
    s.thread.v[size_t(n)] = {};
  }
}

/// Carried along as it lies by itself with so much thread.
void carry(const SutureModel& m, double thread, SutureState& s) noexcept {
  SlingState& g = s.sling;
  g.knot = g.fed = thread;
  lay_loop(m, thread, s);
  const int inside = first_inside(m, g.fed);
  for (size_t e = 0; e < s.thread.alive.size(); ++e)
    s.thread.alive[e] = int(e) < inside && g.stage >= SlingState::stowed;
  g.around_count = 0;
  g.was_closed = 0;
  g.tension = g.tail = g.pulled = 0;
}

void release_holds(const SutureModel& m, SutureState& s) noexcept {
  for (int k = 0; k < kSlingHolds; ++k) suture::release_hold(s.thread, m.sling.first_hold + k);
}
void take_holds(const SutureModel& m, bool knot, SutureState& s) noexcept {
  const int first = m.sling.first_hold;
  if (knot) suture::take_hold(m.thread, s.thread, first + kKnotHold, 0);
  suture::take_hold(m.thread, s.thread, first + kMouthHold, s.sling.fed);
  suture::take_hold(m.thread, s.thread, first + kFeedHold,
                    (first_inside(m, s.sling.fed) - kJustBelow) * m.thread.spacing);
}

/// Fed out until it is as large as it is made, or the handle says that this is enough.
void open_up(const SutureModel& m, const SlingHand& hand, double dt, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const bool feeds = hand.drawn < kFeedsOpen && g.fed < m.sling.loop;
  carry(m, feeds ? std::min(m.sling.loop, g.fed + kFeeds * dt) : g.fed, s);
  if (feeds) return;
  g.stage = SlingState::open;
  take_holds(m, true, s);
}

/// The handle leads it.
void open_or_close(const SutureModel& m, const SlingHand& hand, double dt, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const double closes = hand.most - m.sling.slides - g.tension;
  const double opens = g.tension - m.sling.slips - std::max(kTubeRubs, hand.most);
  if (closes > 0) feed_to(m, std::max(kLeastLoop, g.fed - way_for(m, closes, g.fed, kDraws, dt)), s);
  if (opens > 0) feed_to(m, std::min(m.thread.length, g.fed + way_for(m, opens, g.fed, kRunsAtMost, dt)), s);
  g.knot = g.fed;
}

/// Pulled away from the mouth with more than the tail is held by, when the handle does not draw any more.
void leave_mouth(const SutureModel& m, const SlingHand& hand, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const bool tight = g.around_count > 0 && g.tension > kStandsBelow;
  if (!tight || g.pulled <= std::max(kTubeRubs, hand.most) || hand.most > m.sling.slides) return;
  g.stage = SlingState::off;
  suture::release_hold(s.thread, m.sling.first_hold + kKnotHold);
  suture::tie(m.thread, s.thread, kTieSlot, 0, g.knot);
}

void slide_knot(const SutureModel& m, double dt, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const double shorter = std::min(g.knot, g.fed - g.knot);
  const double closes = g.tail - g.tension - m.sling.slides, opens = g.tension - g.tail - m.sling.slips;
  if (closes > 0) g.knot = std::max(kLeastLoop, g.knot - way_for(m, closes, shorter, kDraws, dt));
  if (opens > 0) g.knot = std::min(g.fed, g.knot + way_for(m, opens, shorter, kRunsAtMost, dt));
  suture::TieState& tie = s.thread.ties[kTieSlot];
  tie.t = g.knot;
  const Vec3d apart = suture::point_at(m.thread, s.thread, g.knot) - s.thread.x[0];
  tie.offset = 2 * kThreadsApart * thickness_of(m) * normalised(apart, g.mouth.up);
}

/// The tail runs out of the tube where it is pulled at, and is drawn in as the hand wants.
void run_tail(const SutureModel& m, const SlingHand& hand, Vec3d tip_before, double dt, SutureState& s) noexcept {
  SlingState& g = s.sling;
  const double holds = std::max(kTubeRubs, hand.most), tail = g.fed - g.knot;
  double fed = g.fed;
  if (g.tail > holds) fed += way_for(m, g.tail - holds, tail, kRunsAtMost, dt);
  if (g.tail > 0.7 * holds) {  // what the tube goes back by comes out of it
    const double leaves = dot(tip_before - g.mouth.tip, normalised(s.thread.x[0] - g.mouth.tip, g.mouth.axis));
    fed += std::clamp(leaves, 0.0, kRunsAtMost * dt);
  } else if (hand.most > kTubeRubs && g.tail < hand.most) {
    fed -= way_for(m, hand.most - g.tail, std::max(tail, 0.003), kDraws, dt);
  }
  feed_to(m, std::clamp(fed, g.knot, m.thread.length), s);
  const bool draws = hand.most > m.sling.slides;
  const bool at_mouth_again =
      draws && g.fed - g.knot < 1e-4 && tail < kAtMouth && length(s.thread.x[0] - g.mouth.tip) < kAtMouth;
  if (!at_mouth_again) return;
  g.stage = SlingState::open;
  feed_to(m, g.knot, s);
  suture::untie(s.thread, kTieSlot);
  suture::take_hold(m.thread, s.thread, m.sling.first_hold + kKnotHold, 0);
}

void place_holds(const SutureModel& m, SutureState& s, SutureWork& w) noexcept {
  const SlingState& g = s.sling;
  const size_t first = size_t(m.sling.first_hold);
  if (first + kSlingHolds > w.holds.size()) return;
  const Vec3d across = cross(g.mouth.axis, g.mouth.up);
  const bool stands = g.tension < kStandsBelow;
  if (g.stage != SlingState::off) {
    suture::Hold& knot = w.holds[first + kKnotHold];
    knot.x = at_mouth(m, g.mouth, -1);
    if (stands) knot.direction = g.mouth.axis;
    knot.side = across;
  }
  s.thread.holds[first + kMouthHold].s = g.fed;
  suture::Hold& mouth = w.holds[first + kMouthHold];
  mouth.x = at_mouth(m, g.mouth, 1);
  mouth.friction_limit = 0.001;
  if (stands) mouth.direction = -g.mouth.axis;
  suture::Hold& feed = w.holds[first + kFeedHold];
  feed.x = mouth.x - (first_inside(m, g.fed) * m.thread.spacing - g.fed) * g.mouth.axis;
}

/// What was cut off of it is not there any more.
void vanish(const SutureModel& m, SutureState& s) noexcept {
  const int last = s.sling.parted;
  for (int n = last + 1; n < m.thread.nodes; ++n) {
    s.thread.x[size_t(n)] = s.thread.x[size_t(last)];
    s.thread.v[size_t(n)] = {};
  }
}

}  // namespace

int last_out(const SutureModel& m, const SutureState& s) noexcept {
  if (!m.sling.there()) return m.thread.nodes - 1;
  if (s.sling.stage == SlingState::packed) return -1;
  return s.sling.stage == SlingState::left ? s.sling.parted : first_inside(m, s.sling.fed);
}

bool is_own_mouth(const SutureModel& m, const SutureState& s, const SutureRod& rod) noexcept {
  return m.sling.there() && s.sling.stage < SlingState::left && rod.tag.index == s.sling.hand &&
         is_jaw(rod.slot % kRodSlots);
}

void take_sling(const SutureModel& m, std::int32_t hand, SutureState& s) noexcept {
  s.sling.hand = hand;
  s.sling.stage = SlingState::stowed;
  carry(m, m.sling.stowed, s);
}
void put_down_sling(const SutureModel& m, SutureState& s) noexcept {
  s.sling.hand = -1;
  s.sling.stage = SlingState::packed;
  release_holds(m, s);
  carry(m, m.sling.stowed, s);
}

bool lead_sling(const SutureModel& m, double dt, SutureState& s, SutureWork& w) noexcept {
  SlingState& g = s.sling;
  const SlingHand& hand = w.sling.hand;
  if (g.stage == SlingState::left) {
    vanish(m, s);
    return true;
  }
  const Vec3d tip_before = g.mouth.tip;
  if (hand.hand >= 0) g.mouth = hand.mouth;
  if (g.stage >= SlingState::opening && g.stage <= SlingState::open && hand.depth < kStowsBelow &&
      g.around_count == 0) {
    g.stage = SlingState::stowed;
    release_holds(m, s);
  }
  if (g.stage <= SlingState::stowed) {
    carry(m, m.sling.stowed, s);
    if (g.stage == SlingState::stowed && hand.depth >= kStowsWithin && hand.drawn < kFeedsOpen)
      g.stage = SlingState::opening;
    return false;
  }
  if (g.stage == SlingState::opening) {
    open_up(m, hand, dt, s);
    if (g.stage == SlingState::opening) return false;
  }
  if (g.stage != SlingState::off) {
    open_or_close(m, hand, dt, s);
    if (g.stage == SlingState::open && g.tension < kStandsBelow) keep_shape(m, g.fed, s);
    leave_mouth(m, hand, s);
  } else {
    slide_knot(m, dt, s);
    run_tail(m, hand, tip_before, dt, s);
  }
  lie_in_tube(m, s);
  place_holds(m, s, w);
  return true;
}

void settle_sling(const SutureModel& m, double dt, SutureState& s, SutureWork& w) noexcept {
  SlingState& g = s.sling;
  for (std::int32_t i = 0; i < g.around_count; ++i) {
    SlingAround& a = g.around[size_t(i)];
    a.pull = {};
    a.press = a.stiff = a.squeeze = 0;
    double count = 0;
    for (size_t n = 0; n < w.sling.on.size() && n < w.skin_reactions.size(); ++n) {
      if (w.sling.on[n] != i) continue;
      const Vec3d force = w.skin_reactions[n];
      a.pull += force;
      a.press -= dot(force, w.skins[n].normal);
      a.stiff += w.sling.stiff[n];
      a.squeeze += w.sling.deep[n];
      ++count;
    }
    if (count > 0) a.squeeze /= count;
    a.cutting = std::max(0.0, a.cutting + (g.tension >= a.bears ? dt : -dt));
  }
  const int e = suture::place_at(m.thread, g.knot).element;
  const int beside = std::max(0, e - 2);
  g.tension += kCalmer * (suture::tension(m.thread, s.thread, beside) - g.tension);
  if (g.stage == SlingState::left) return;  // its force has what lies on the knot, until here
  const size_t first = size_t(m.sling.first_hold);
  for (size_t k = 0; k < kSlingHolds; ++k)
    if (s.thread.holds[first + k].active) w.sling.force += w.hold_reactions[first + k].force;
  const double tail = dot(w.hold_reactions[first + kFeedHold].force, g.mouth.axis);
  g.tail += kCalmer * (tail - g.tail);
  g.pulled = dot(w.sling.force, g.mouth.axis);
  lie_in_tube(m, s);
}

int parted_element(const SutureModel& m, const SutureState& s) noexcept {
  if (!s.sling.computed()) return -1;
  const int end = s.sling.stage == SlingState::left ? s.sling.parted : first_inside(m, s.sling.fed);
  for (int e = 0; e < end; ++e)
    if (!s.thread.alive[size_t(e)]) return e;
  return -1;
}

void cut_sling(const SutureModel& m, std::int32_t element, SutureState& s) noexcept {
  SlingState& g = s.sling;
  for (size_t e = size_t(element); e < s.thread.alive.size(); ++e) s.thread.alive[e] = 0;
  release_holds(m, s);
  if (element <= suture::place_at(m.thread, g.knot).element) {  // not the tail but the loop
    suture::untie(s.thread, kTieSlot);
    g.around_count = g.was_closed = 0;
    g.knot = 0;
  }
  g.stage = SlingState::left;
  g.parted = element;
  g.fed = std::min(g.fed, (element + 0.5) * m.thread.spacing);
  vanish(m, s);
}

}  // namespace trocar::interactions
