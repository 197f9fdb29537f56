#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/mat6.hpp>
#include <trocar/interactions/objects/rigid.hpp>
#include <trocar/interactions/objects/rigid_contacts.hpp>
#include <trocar/numerics/mat3.hpp>

namespace trocar::interactions {
namespace {

constexpr size_t kMostContacts = 96;          // of one body
constexpr double kFastest = 3, kSpins = 300;  // [m/s], [rad/s] nothing that hands do is faster

bool finite(const RigidState& s) noexcept {
  for (const double v :
       {s.x.x, s.x.y, s.x.z, s.q.w, s.q.x, s.q.y, s.q.z, s.v.x, s.v.y, s.v.z, s.w.x, s.w.y, s.w.z, s.still})
    if (!(std::fabs(v) < 1e6)) return false;
  return true;
}

Vec3d bounded(Vec3d v, double most) noexcept {
  const double l = length(v);
  return l > most ? (most / l) * v : v;
}

Mat3d inertia_of(const RigidModel& m, const RigidState& s) noexcept {
  const Mat3d r = to_mat3(s.q);
  return r * m.inertia * transposed(r);
}

/// u -> v x u
Mat3d crossing(Vec3d v) noexcept { return {{{0, -v.z, v.y}, {v.z, 0, -v.x}, {-v.y, v.x, 0}}}; }

constexpr double kSleeps = 0.25;        // [s] after which what lies still sleeps
constexpr double kLies = 2e-4;          // [m/s] no point of it is faster
constexpr double kWakesWithin = 0.002;  // [m] what moves so near wakes it
constexpr double kMoves = 1e-7;         // [m] in a tick

bool moves_beside(const RigidRod& rod, const RigidModel& m, const RigidState& s) noexcept {
  if (collision::way_of(rod.before, rod.now) < kMoves) return false;
  const Vec3d off = collision::nearest_on_axis(rod.now, s.x) - s.x;
  const double far = m.reach + rod.now.radius + kWakesWithin;
  return dot(off, off) < far * far;
}

bool wakes(const RigidModels& models, const Rigid::States& states, size_t i, const RigidWork& work) noexcept {
  const RigidModel& m = models.list[i];
  for (const RigidHold& hold : work.holds)
    if (hold.body == std::int32_t(i)) return true;
  for (const RigidRod& rod : work.rods)
    if (moves_beside(rod, m, states[i])) return true;
  for (size_t j = 0; j < states.size(); ++j) {
    const Vec3d off = states[i].x - states[j].x;
    const double far = m.reach + models.list[j].reach + kWakesWithin;
    if (j != i && work.awake[j] && dot(off, off) < far * far) return true;
  }
  return false;
}

/// Who wakes one may have been woken by a third.
void find_awake(const RigidModels& models, const Rigid::States& states, RigidWork& work) noexcept {
  for (size_t i = 0; i < states.size(); ++i) work.awake[i] = !states[i].inside() && states[i].still < kSleeps;
  for (const RigidBed& bed : work.beds) work.awake[size_t(bed.body)] = true;  // tissue never lies quite still
  for (bool more = true; more;) {
    more = false;
    for (size_t i = 0; i < states.size(); ++i)
      if (!work.awake[i] && !states[i].inside() && wakes(models, states, i, work)) {
        work.awake[i] = true;
        more = true;
      }
  }
}

/// @param reach  of its farthest point [m]
void note_stillness(double h, double reach, RigidState& s) noexcept {
  s.still = length(s.v) + reach * length(s.w) < kLies ? s.still + h : 0;
  if (s.still >= kSleeps) s.v = s.w = {0, 0, 0};
}

/// How fast it turns at the end of the tick if nothing touches it: one Newton step of the implicit gyroscopic
/// equation, in its own frame. [Catto 2015]
Vec3d turned_freely(const RigidModel& m, const RigidState& s, double h) noexcept {
  const Vec3d w = rotate(conjugate(s.q), s.w), iw = m.inertia * w;
  const Mat3d j = m.inertia + h * (crossing(w) * m.inertia - crossing(iw));
  return rotate(s.q, w - inverse(j) * (h * cross(w, iw)));
}

/// Motion at the end of the tick without contacts, and what an impulse adds to it.
void predict(const RigidModels& models, Vec3d gravity, double h, size_t i, const RigidState& s,
             RigidWork& work) noexcept {
  const RigidModel& m = models.list[i];
  const Mat3d inertia = inertia_of(m, s);
  const Vec3d spin = inertia * turned_freely(m, s, h), push = m.mass * (s.v + h * gravity);
  Mat6 a{};
  for (size_t k = 0; k < 3; ++k) {
    a[k][k] = m.mass;
    for (size_t l = 0; l < 3; ++l) a[k + 3][l + 3] = inertia.m[k][l];
  }
  Vec6 b{push.x, push.y, push.z, spin.x, spin.y, spin.z};
  for (const RigidHold& hold : work.holds) {
    if (hold.body != std::int32_t(i)) continue;
    const double k = h * h * hold.law.stiffness;
    const Vec3d way = h * hold.law.stiffness * (hold.target - (s.x + hold.arm));
    for (size_t c = 0; c < 3; ++c) {
      Vec3d axis;
      axis[int(c)] = 1;
      const Vec6 row = wrench(axis, hold.arm);
      add_outer(a, row, k);
      for (size_t r = 0; r < 6; ++r) b[r] += row[r] * way[int(c)];
    }
  }
  work.mobility[i] = inverse_of(a);
  work.motion[i] = product(work.mobility[i], b);
}

void move(double h, const Vec6& u, RigidState& s) noexcept {
  s.v = bounded({u[0], u[1], u[2]}, kFastest);
  s.w = bounded({u[3], u[4], u[5]}, kSpins);
  s.x += h * s.v;
  const Quatd turn = Quatd{0, s.w.x, s.w.y, s.w.z} * s.q;
  s.q = normalised(
      Quatd{s.q.w + 0.5 * h * turn.w, s.q.x + 0.5 * h * turn.x, s.q.y + 0.5 * h * turn.y, s.q.z + 0.5 * h * turn.z});
}

void keep_in(const tissue::Box& cavity, RigidState& s) noexcept {
  for (int k = 0; k < 3; ++k) {
    const double low = double(cavity.low[k]), high = double(cavity.high[k]);
    if (s.x[k] < low) s.x[k] = low, s.v[k] = std::max(s.v[k], 0.0);
    if (s.x[k] > high) s.x[k] = high, s.v[k] = std::min(s.v[k], 0.0);
  }
}

/// Of the springs, as implicit Euler has them.
void note_holds(double h, RigidWork& work) noexcept {
  for (RigidHold& hold : work.holds) {
    const Vec6& u = work.motion[size_t(hold.body)];
    const Vec3d velocity = Vec3d{u[0], u[1], u[2]} + cross(Vec3d{u[3], u[4], u[5]}, hold.arm);
    hold.force = hold.law.stiffness * (hold.target - h * velocity);  // target: from where it was
  }
}

}  // namespace

Rigid::States Rigid::start(const Models& models) {
  States states;
  for (const RigidModel& m : models.list)
    states.push_back({m.place, m.turn, {0, 0, 0}, {0, 0, 0}, m.inside >= 0 ? -1.0 : 0.0});
  return states;
}

Rigid::Work Rigid::make_work(const Models& models, int hands) {
  Work w;
  const size_t n = models.list.size();
  if (n == 0) return w;
  w.holds.reserve(size_t(hands) * kMaxHolds);
  w.rods.reserve(size_t(hands) * kMostParts);
  w.beds.reserve(n * kMostContacts);
  w.contacts.reserve(n * kMostContacts);
  w.mobility.resize(n);
  w.motion.resize(n);
  w.awake.resize(n);
  return w;
}

void Rigid::clear(Work& w) noexcept {
  w.holds.clear();
  w.rods.clear();
  w.beds.clear();
  w.contacts.clear();
  w.overflowed = false;
}

void Rigid::touch(const Models& models, const States&, const ObjectHand& hand, Work& w) noexcept {
  if (models.list.empty()) return;
  const BodyId held = hand.state.holds > 0 ? hand.state.hold[0].at.body : BodyId{};
  for (int part = kShaft; part < end_of(hand.touching.shape) && w.rods.size() < w.rods.capacity(); part = next(part))
    w.rods.push_back({hand.touching.before.rod(part),
                      hand.touching.shape.rod(part),
                      {Owner::tool_contact, hand.touching.tool, 0},
                      is_jaw(part) ? held : BodyId{}});
}

Vec3d Rigid::point(const Models& models, const States& states, const MaterialPoint& at) noexcept {
  const size_t i = at.body.index();
  return place_of(states[i], models.list[i].grips[size_t(at.element)]);
}

void Rigid::pull(const Models& models, const States& states, const MaterialPoint& at, Vec3d target, HoldLaw law,
                 Tag tag, Work& w) noexcept {
  if (w.holds.size() == w.holds.capacity()) {
    w.overflowed = true;
    return;
  }
  const size_t i = at.body.index();
  const Vec3d arm = rotate(states[i].q, models.list[i].grips[size_t(at.element)]);
  w.holds.push_back({std::int32_t(i), arm, target, law, tag, {0, 0, 0}});
}

tissue::StepReport Rigid::advance(const Models& models, Vec3d gravity, double h, const tissue::Box& cavity,
                                  States& states, Work& w) noexcept {
  tissue::StepReport report;
  find_awake(models, states, w);
  for (size_t i = 0; i < states.size(); ++i) {
    w.mobility[i] = {}, w.motion[i] = {};  // asleep: nothing moves it
    if (w.awake[i]) predict(models, gravity, h, i, states[i], w);
  }
  find_contacts(models, states, h, w);
  solve_contacts(h, w);
  for (RigidHold& hold : w.holds) hold.target -= states[size_t(hold.body)].x + hold.arm;
  note_holds(h, w);
  for (size_t i = 0; i < states.size(); ++i) {
    if (!w.awake[i]) continue;
    move(h, w.motion[i], states[i]);
    keep_in(cavity, states[i]);
    note_stillness(h, models.list[i].reach, states[i]);
    if (finite(states[i]) || (report.flags & tissue::StepReport::kNonFinite)) continue;
    report.flags |= tissue::StepReport::kNonFinite;
    report.first_bad = int(i);
  }
  return report;
}

bool Rigid::is_valid(const States& states) noexcept { return std::all_of(states.begin(), states.end(), finite); }

void Rigid::blend(const States& a, const States& b, double f, States& out) noexcept {
  for (size_t i = 0; i < out.size(); ++i) {
    out[i].x = a[i].x + f * (b[i].x - a[i].x);
    out[i].q = slerp(a[i].q, b[i].q, f);
  }
}

}  // namespace trocar::interactions
