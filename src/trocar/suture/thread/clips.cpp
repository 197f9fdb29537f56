// Clips on a thread: what they tie, where they slip, what they stop, how they are seen.
#include <algorithm>
#include <cmath>

#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/contacts.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

constexpr double kNoWay = 1e-9;       ///< [m]: what is nearer to a stop has come to it
constexpr double kBoth = 0.9;         ///< share of the larger pull from which on the other stretch slips as well
constexpr double kLeastAlong = 0.01;  ///< of a bar's direction: what pulls across a stretch does not draw it through

bool holds_there(const ThreadModel& m, const ThreadState& s, double arc) {
  return arc >= 0 && arc <= m.length && s.alive[std::size_t(place_at(m, arc).element)] != 0;
}

/// On the thread's curve, as passages are, but not over a place where it is parted.
SmoothPlace clip_place(const ThreadModel& m, const ThreadState& s, double arc) {
  const SmoothPlace smooth = smooth_place(m, arc);
  if (s.alive[std::size_t(smooth.nodes[0])] && s.alive[std::size_t(smooth.nodes[1])]) return smooth;
  const ThreadPlace at = place_at(m, arc);
  const int e = at.element;
  if (e + 2 < m.nodes) return {{e, e + 1, e + 2}, {1 - at.w, at.w, 0}};
  return {{e - 1, e, e + 1}, {0, 1 - at.w, at.w}};
}
Vec3d clip_point(const ThreadModel& m, const ThreadState& s, double arc) { return clip_place(m, s, arc).of(s.x); }
/// Of the curve there.
Vec3d clip_along(const Tick& t, const SmoothPlace& at) {
  const double after = 0.5 + at.c[2] - at.c[0];
  return normalised((1 - after) * t.w.along[at.nodes[0]] + after * t.w.along[at.nodes[1]], t.w.along[at.nodes[0]]);
}

/// Two neighbouring stretches, as the bar between them sees them.
struct Bar {
  SmoothPlace a, b;       ///< the lower place first
  double ca = 0, cb = 0;  ///< directions of the thread there, along the bar
  Vec3d along;            ///< from the first to the second
  double length = 0;      ///< [m]
  double strain = 0;      ///< [m]
  double bound = 0;       ///< of the strain, by friction [m]
  bool swapped = false;   ///< the lower place is that of the second stretch
  bool there = false;
};
double bar_stiffness(const ThreadModel& m) { return m.stuff.stretch / m.spacing; }

Bar bar_of(const Tick& t, const ThreadClip& c, int i) {
  Bar bar;
  bar.swapped = c.s[i] > c.s[i + 1];
  bar.a = clip_place(t.m, t.s, std::min(c.s[i], c.s[i + 1]));
  bar.b = clip_place(t.m, t.s, std::max(c.s[i], c.s[i + 1]));
  bar.there = bar.b.nodes[0] > bar.a.nodes[2];
  if (!bar.there) return bar;
  const Vec3d d = bar.b.of(t.s.x) - bar.a.of(t.s.x);
  bar.length = length(d);
  bar.along = normalised(d, c.axis_now);
  bar.strain = bar.length - c.apart[i];
  bar.ca = dot(bar.along, clip_along(t, bar.a)), bar.cb = dot(bar.along, clip_along(t, bar.b));
  const double most = std::max({std::fabs(bar.ca), std::fabs(bar.cb), kLeastAlong});
  bar.bound = kClipHolds / (bar_stiffness(t.m) * most);
  return bar;
}

/// Between the stretches of a clip, the clips of a thread.
template <class F>
void each_bar(Tick& t, F&& f) {
  for (int k = 0; k < t.s.clip_count; ++k)
    for (int i = 0; i + 1 < t.s.clips[k].count; ++i)
      if (const Bar bar = bar_of(t, t.s.clips[k], i); bar.there) f(t.s.clips[k], i, bar);
}

void add_weight(Tick& t, const ThreadClip& c) {
  const double mass = kClipMass / c.count;
  for (int i = 0; i < c.count; ++i) {
    const SmoothPlace at = clip_place(t.m, t.s, c.s[i]);
    t.w.system.add_term(at.nodes, at.c, 3, in_all_ways(mass * (1 / (t.h * t.h) + t.m.drag / t.h)));
    const Vec3d f = mass * (at.of(t.s.v) / t.h + t.m.gravity);
    for (int j = 0; j < 3; ++j) t.w.system.push(at.nodes[j], at.c[j] * f);
  }
}

void add_bar(Tick& t, const ThreadClip& c, int i, const Bar& bar) {
  const double k = bar_stiffness(t.m) * kept_share(bar.bound, c.reached[i]), pull = k * bar.strain;
  const std::int32_t* n[2] = {bar.a.nodes, bar.b.nodes};
  const std::int32_t nodes[6] = {n[0][0], n[0][1], n[0][2], n[1][0], n[1][1], n[1][2]};
  const double w[6] = {bar.a.c[0], bar.a.c[1], bar.a.c[2], -bar.b.c[0], -bar.b.c[1], -bar.b.c[2]};
  const double turns = pull > 0 && bar.length > 0 ? pull / bar.length : 0;
  t.w.system.add_term(nodes, w, 6, along_and_across(k, turns, bar.along));
  for (int j = 0; j < 6; ++j) t.w.system.push(nodes[j], (w[j] * pull) * bar.along);
}

/// How far a place of the thread may go before it comes to a stop there.
/// @param half  of the stop and of what comes to it together [m]
double way_until(double from, double way, double stop, double half) {
  const double off = way > 0 ? stop - from : from - stop;
  return off < 0 || (off == 0 && way > 0) ? std::fabs(way) : std::min(std::fabs(way), std::max(0.0, off - half));
}

/// A stretch goes through its clip, as far as tissue and jaws let the clip go along it.
void slide(Tick& t, ThreadClip& c, int i, double way) {
  double most = std::fabs(way);
  for (const PassageState& p : t.s.passages)
    if (p.active) most = std::min(most, way_until(c.s[i], way, p.s, kClipHalfWidth));
  for (int k = 0; k < std::min(t.m.holds, int(t.drive.holds.size())); ++k)
    if (t.s.holds[k].active && t.drive.holds[k].friction_limit > 0)
      most = std::min(most, way_until(c.s[i], way, t.s.holds[k].s, kClipHalfWidth + kHolderHalfWidth));
  c.s[i] += way > 0 ? most : -most;
}

void slip_bar(Tick& t, ThreadClip& c, int i, const Bar& bar) {
  c.reached[i] = std::fabs(bar.strain);
  const double beyond = c.reached[i] - bar.bound;
  if (!(beyond > 0)) return;
  const double most = std::max(std::fabs(bar.ca), std::fabs(bar.cb));
  const double ca = std::fabs(bar.ca) < kBoth * most ? 0 : bar.ca, cb = std::fabs(bar.cb) < kBoth * most ? 0 : bar.cb;
  const double sum = ca * ca + cb * cb;
  if (!(sum > kLeastAlong * kLeastAlong)) return;
  const double share = (bar.strain > 0 ? beyond : -beyond) / sum;
  const auto stretched = [&](const SmoothPlace& p) { return std::max(0.5, t.w.length[p.nodes[1]] / t.m.spacing); };
  const double way_a = share * ca / stretched(bar.a), way_b = -share * cb / stretched(bar.b);
  slide(t, c, i, bar.swapped ? way_b : way_a);
  slide(t, c, i + 1, bar.swapped ? way_a : way_b);
}

/// The thread's frame where a clip has its first stretch.
struct ClipFrame {
  Vec3d along, side, up;
  Vec3d out(Vec3d v) const { return v.x * along + v.y * side + v.z * up; }
  Vec3d in(Vec3d v) const { return {dot(v, along), dot(v, side), dot(v, up)}; }
};
ClipFrame frame_at(const ThreadModel& m, const ThreadState& s, double arc) {
  const std::size_t e = std::size_t(place_at(m, arc).element);
  ClipFrame f;
  f.along = normalised(s.x[e + 1] - s.x[e]);
  f.side = normalised(s.director[e] - dot(s.director[e], f.along) * f.along, any_perpendicular(f.along));
  f.up = cross(f.along, f.side);
  return f;
}
Vec3d to_last(const ThreadModel& m, const ThreadState& s, const ThreadClip& c) {
  return clip_point(m, s, c.s[c.count - 1]) - clip_point(m, s, c.s[0]);
}

void let_go(const ThreadModel& m, const ThreadState& s, ThreadClip& c, int i) {
  for (int k = i; k + 1 < c.count; ++k) c.s[k] = c.s[k + 1];
  for (int k = std::max(0, i - 1); k + 1 < kMostClipped; ++k) c.reached[k] = 0;
  --c.count;
  c.s[c.count] = 0;
  for (int k = 0; k + 1 < kMostClipped; ++k)
    c.apart[k] = k + 1 < c.count ? length(clip_point(m, s, c.s[k + 1]) - clip_point(m, s, c.s[k])) : 0;
  if (c.count == 0) return;
  const ClipFrame f = frame_at(m, s, c.s[0]);  // it stays as it lies
  c.axis = f.in(c.axis_now), c.open = f.in(c.open_now);
  if (c.count > 1) c.bar = f.in(normalised(to_last(m, s, c), c.axis_now));
}

/// It turns with its first stretch, and so that it lies over its last one.
void pose_clip(const ThreadModel& m, const ThreadState& s, ThreadClip& c) {
  const ClipFrame f = frame_at(m, s, c.s[0]);
  c.at = clip_point(m, s, c.s[0]);
  c.axis_now = f.out(c.axis), c.open_now = f.out(c.open);
  if (c.count < 2) return;
  const Vec3d was = f.out(c.bar), d = to_last(m, s, c), is = normalised(d, was);
  c.at += 0.5 * d;
  c.axis_now = normalised(turned(was, is, c.axis_now), c.axis_now);
  const Vec3d open = turned(was, is, c.open_now);
  c.open_now = normalised(open - dot(open, c.axis_now) * c.axis_now, any_perpendicular(c.axis_now));
}

}  // namespace

bool set_clip(const ThreadModel& m, ThreadState& state, std::int32_t number, std::span<const double> places, Vec3d axis,
              Vec3d open) noexcept {
  if (state.clip_count >= int(state.clips.size()) || places.empty()) return false;
  ThreadClip c;
  c.number = number;
  for (const double s : places)
    if (c.count < kMostClipped && holds_there(m, state, s)) c.s[c.count++] = s;
  if (c.count == 0) return false;
  for (int i = 0; i + 1 < c.count; ++i)
    c.apart[i] = std::max(m.stuff.diameter, length(clip_point(m, state, c.s[i + 1]) - clip_point(m, state, c.s[i])));
  const ClipFrame f = frame_at(m, state, c.s[0]);
  c.axis = f.in(axis), c.open = f.in(open);
  if (c.count > 1) c.bar = f.in(normalised(to_last(m, state, c), axis));
  pose_clip(m, state, c);
  state.clips[state.clip_count++] = c;
  state.calm = 0;
  return true;
}

const ThreadClip* clip_of(const ThreadState& state, std::int32_t number) noexcept {
  for (int k = 0; k < state.clip_count; ++k)
    if (state.clips[k].number == number) return &state.clips[k];
  return nullptr;
}

void spare_clips(const ThreadModel& m, int element, ThreadState& state) noexcept {
  for (int k = 0; k < state.clip_count; ++k)
    for (int i = 0; i < state.clips[k].count; ++i) {
      double& s = state.clips[k].s[i];
      const ThreadPlace at = place_at(m, s);
      if (at.element != element) continue;
      const bool first = element == 0 || !state.alive[element - 1], last = element + 2 >= m.nodes;
      const bool back = (at.w < 0.5 && !first) || last;
      s = (back ? element - kNoWay : element + 1 + kNoWay) * m.spacing;
    }
}

void couple_clips(Tick& t) noexcept {
  each_bar(t, [&](const ThreadClip&, int, const Bar& bar) {
    const std::int32_t *a = bar.a.nodes, *b = bar.b.nodes, nodes[6] = {a[0], a[1], a[2], b[0], b[1], b[2]};
    t.w.system.couple(nodes, 6);
  });
}

void add_clips(Tick& t) noexcept {
  for (int k = 0; k < t.s.clip_count; ++k) add_weight(t, t.s.clips[k]);
  each_bar(t, [&](const ThreadClip& c, int i, const Bar& bar) { add_bar(t, c, i, bar); });
}

double way_to_clip(const ThreadState& s, double from, double way, double half) noexcept {
  double most = std::fabs(way);
  for (int k = 0; k < s.clip_count; ++k)
    for (int i = 0; i < s.clips[k].count; ++i) most = std::min(most, way_until(from, way, s.clips[k].s[i], half));
  return most;
}

double clip_stops(const ThreadState& s, double from, double way, double half) noexcept {
  return s.clip_count > 0 && way_to_clip(s, from, way > 0 ? 1.0 : -1.0, half) < kNoWay ? kClipHolds : 0;
}

void push_clips(ThreadState& s, double from, double way, double half) noexcept {
  for (int k = 0; k < s.clip_count; ++k)
    for (int i = 0; i < s.clips[k].count; ++i) {
      const double free = way_until(from, way, s.clips[k].s[i], half), pushed = std::fabs(way) - free;
      if (pushed > 0) s.clips[k].s[i] += way > 0 ? pushed : -pushed;
    }
}

void settle_clips(Tick& t) noexcept {
  if (t.s.clip_count == 0) return;
  each_bar(t, [&](ThreadClip& c, int i, const Bar& bar) { slip_bar(t, c, i, bar); });
  int kept = 0;
  for (int k = 0; k < t.s.clip_count; ++k) {
    ThreadClip c = t.s.clips[k];
    for (int i = c.count; i-- > 0;)
      if (!holds_there(t.m, t.s, c.s[i])) let_go(t.m, t.s, c, i);
    if (c.count > 0) t.s.clips[kept++] = c;
  }
  t.s.clip_count = kept;
}

void pose_clips(const ThreadModel& m, ThreadState& s) noexcept {
  for (int k = 0; k < s.clip_count; ++k) pose_clip(m, s, s.clips[k]);
}

}  // namespace trocar::suture
