// Building a thread, laying it, and what slots take and let go.
#include <cmath>
#include <stdexcept>
#include <string>

#include <trocar/core/field_hash.hpp>
#include <trocar/suture/thread/chain.hpp>
#include <trocar/suture/thread/tick.hpp>

namespace trocar::suture {
namespace {

[[noreturn]] void refuse_thread(const std::string& what) { throw std::invalid_argument("thread: expected " + what); }

void check(const ThreadDescription& d) {
  const ThreadStuff& t = d.stuff;
  if (!(t.diameter > 0) || !(t.stretch > 0) || !(t.bend > 0) || !(t.twist > 0) || !(t.mass > 0))
    refuse_thread("diameter, stretch, bend, twist and mass > 0");
  if (!(t.yield_curvature >= 0) || !(t.hardening >= 0 && t.hardening < 1))
    refuse_thread("yield_curvature >= 0 and 0 <= hardening < 1");
  if (!(t.friction_thread >= 0) || !(t.friction_steel >= 0) || !(t.friction_tissue >= 0))
    refuse_thread("friction >= 0");
  if (!(t.knotted_break_force > 0) || !(t.break_force > 0)) refuse_thread("break forces > 0");
  if (!(d.tick > 0) || !(d.drag >= 0)) refuse_thread("tick > 0 and drag >= 0");
  if (d.most_solves < 1 || !(d.solve_motion > 0)) refuse_thread("at least one solve, and solve_motion > 0");
  if (d.holds < 0 || d.obstacles < 0 || d.skins < 0 || d.passages < 0 || d.ties < 0) refuse_thread("slots >= 0");
  if (!(d.length > 0) || !(d.spacing >= 0)) refuse_thread("length > 0 and spacing >= 0");
}

}  // namespace

ThreadModel build(const ThreadDescription& d) {
  check(d);
  ThreadModel m;
  const double spacing = d.spacing > 0 ? d.spacing : 2 * d.stuff.diameter;
  const double elements = std::floor(d.length / spacing + 0.5);
  if (!(elements >= 4 && elements <= 2000)) refuse_thread("4 to 2000 elements, got " + std::to_string(elements));
  m.nodes = int(elements) + 1;
  m.spacing = d.length / elements;
  m.length = d.length;
  m.stuff = d.stuff;
  m.tick = d.tick;
  m.gravity = d.gravity;
  m.drag = d.drag;
  m.most_solves = d.most_solves;
  m.solve_motion = d.solve_motion * d.stuff.diameter;
  m.shaped = d.shaped ? 1 : 0;
  m.contact_stiffness = 1.3 * d.stuff.knotted_break_force / d.stuff.diameter;
  // Around half a turn as tight as the thread's own thickness lets it be, 1.57 diameters of thread lie.
  m.apart = 2;
  while ((m.apart - 1) * m.spacing < 1.6 * d.stuff.diameter) ++m.apart;
  m.holds = d.holds, m.obstacles = d.obstacles, m.skins = d.skins, m.passages = d.passages, m.ties = d.ties;
  m.contacts = 16 * m.nodes;
  return m;
}

ThreadState laid(const ThreadModel& m, std::span<const Vec3d> path) {
  if (path.empty()) refuse_thread("a path of at least one point");
  ThreadState s;
  const std::size_t n = std::size_t(m.nodes);
  s.x.resize(n), s.v.resize(n), s.twist.resize(n), s.bend.resize(n);
  s.director.resize(n - 1), s.alive.assign(n - 1, 1);
  s.holds.resize(std::size_t(m.holds)), s.obstacles.resize(std::size_t(m.obstacles));
  s.skins.resize(std::size_t(m.skins)), s.passages.resize(std::size_t(m.passages));
  s.ties.resize(std::size_t(m.ties));
  s.clips.resize(kMostThreadClips);
  s.self.resize(std::size_t(m.contacts)), s.touch.resize(std::size_t(m.contacts));

  // Nodes are set one chord after the other, so that elements have their rest length.
  s.x[0] = path[0];
  std::size_t piece = 0;
  double along = 0;  // on that piece, 0..1
  Vec3d direction{1, 0, 0};
  for (std::size_t i = 1; i < n; ++i) {
    bool found = false;
    for (; piece + 1 < path.size(); ++piece, along = 0) {
      const Vec3d a = path[piece], d = path[piece + 1] - a, from = a - s.x[i - 1];
      const double dd = dot(d, d), half = dot(from, d), c = dot(from, from) - m.spacing * m.spacing;
      const double root = half * half - dd * c;
      if (!(dd > 0) || !(root >= 0)) continue;
      const double w = (-half + std::sqrt(root)) / dd;
      if (!(w >= along && w <= 1)) continue;
      along = w;
      s.x[i] = a + w * d;
      found = true;
      break;
    }
    if (found)
      direction = normalised(s.x[i] - s.x[i - 1], direction);
    else
      s.x[i] = s.x[i - 1] +
               m.spacing * (path.size() > 1 ? normalised(path.back() - path[path.size() - 2], direction) : direction);
  }
  Vec3d before = normalised(s.x[1] - s.x[0]);
  s.director[0] = any_perpendicular(before);
  for (std::size_t e = 1; e + 1 < n; ++e) {
    const Vec3d t = normalised(s.x[e + 1] - s.x[e], before);
    s.director[e] = carried(before, t, s.director[e - 1]);
    before = t;
  }
  return s;
}

ThreadWork make_work(const ThreadModel& m) {
  ThreadWork w;
  const std::size_t n = std::size_t(m.nodes), contacts = std::size_t(m.contacts);
  w.system = BlockSystem(m.nodes);
  w.delta.resize(n), w.length.resize(n), w.along.resize(n);
  w.node_along.resize(n), w.node_director.resize(n), w.bend_now.resize(n), w.bend_rest.resize(n);
  w.box.resize(2 * (n / kGroup + 1));
  w.near.resize(n * (n - 1) / 2), w.keys.resize(n * (n - 1) / 2);
  w.self.resize(contacts), w.touch.resize(contacts), w.rubs.resize(contacts);
  w.spin_diagonal.resize(n), w.spin_off.resize(n), w.spin.resize(n);
  w.close.resize(std::size_t(m.obstacles));
  w.obstacle_moves.resize(2 * std::size_t(m.obstacles)), w.pull.resize(2 * std::size_t(m.obstacles));
  return w;
}

void take_hold(const ThreadModel& m, ThreadState& state, int slot, double s) noexcept {
  if (slot < 0 || slot >= m.holds || !(s >= 0 && s <= m.length)) return;
  HoldState& h = state.holds[std::size_t(slot)];
  h = {};
  h.active = h.fresh = 1;
  h.s = s;
  state.calm = 0;
}
void release_hold(ThreadState& state, int slot) noexcept {
  if (slot < 0 || slot >= int(state.holds.size())) return;
  state.holds[std::size_t(slot)] = {};
  state.calm = 0;
}
void open_passage(const ThreadModel& m, ThreadState& state, int slot, double s) noexcept {
  if (slot < 0 || slot >= m.passages || !(s >= 0 && s <= m.length)) return;
  PassageState& p = state.passages[std::size_t(slot)];
  p = {};
  p.active = p.fresh = 1;
  p.s = s;
  state.calm = 0;
}
void close_passage(ThreadState& state, int slot) noexcept {
  if (slot < 0 || slot >= int(state.passages.size())) return;
  state.passages[std::size_t(slot)] = {};
  state.calm = 0;
}
void tie(const ThreadModel& m, ThreadState& state, int slot, double s, double t) noexcept {
  if (slot < 0 || slot >= m.ties || !(s >= 0 && s <= m.length && t >= 0 && t <= m.length)) return;
  state.ties[std::size_t(slot)] = {1, s, t, point_at(m, state, t) - point_at(m, state, s)};
  state.calm = 0;
}
void untie(ThreadState& state, int slot) noexcept {
  if (slot < 0 || slot >= int(state.ties.size())) return;
  state.ties[std::size_t(slot)] = {};
  state.calm = 0;
}
void cut(const ThreadModel& m, ThreadState& state, double s) noexcept {
  if (!(s >= 0 && s <= m.length)) return;
  const int element = place_at(m, s).element;
  spare_clips(m, element, state);
  state.alive[std::size_t(element)] = 0;
  state.calm = 0;
}

ThreadPlace place_at(const ThreadModel& m, double s) noexcept {
  const double along = s > 0 ? (s < m.length ? s / m.spacing : double(m.nodes - 1)) : 0;
  int e = int(along);
  if (e > m.nodes - 2) e = m.nodes - 2;
  return {e, along - e};
}
Vec3d point_at(const ThreadModel& m, const ThreadState& state, double s) noexcept {
  const ThreadPlace p = place_at(m, s);
  return (1 - p.w) * state.x[std::size_t(p.element)] + p.w * state.x[std::size_t(p.element) + 1];
}
double tension(const ThreadModel& m, const ThreadState& s, int e) noexcept {
  if (!s.alive[std::size_t(e)]) return 0;
  return m.stuff.stretch * (length(s.x[std::size_t(e) + 1] - s.x[std::size_t(e)]) / m.spacing - 1);
}

void add_to_hash(core::Hasher& h, const ThreadState& s) noexcept { core::add_fields(h, s); }
void add_to_hash(core::Hasher& h, const ThreadModel& m) noexcept { core::add_fields(h, m); }

}  // namespace trocar::suture
