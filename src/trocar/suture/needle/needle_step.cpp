#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/numerics/mat3.hpp>
#include <trocar/suture/needle/needle_step.hpp>

namespace trocar::suture {
namespace {

using Motion = std::array<double, 6>;
using Matrix = std::array<Motion, 6>;

constexpr int kRounds = 16;                   // in which bounds and forces come to agree
constexpr double kAgree = 1e-4;               // of a spring's share, that still may change
constexpr double kFastest = 3, kSpins = 300;  // [m/s], [rad/s]
constexpr double kAir = 2e-5;                 // [1/tick] that speeds lose
constexpr double kStrainStiffness = 0.5;      // of friction, beside its contact's
constexpr double kQuickest = 0.0006;          // [m] a tick that contacts move what has sunk in

constexpr std::size_t kMostAlong = 3 * kMostContacts + 3 * kMostNeedleHolds + 3 * kMostPins + 8;

double product(const Motion& a, const Motion& b) noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}
Motion row_of(Vec3d dir, Vec3d arm) noexcept {
  const Vec3d t = cross(arm, dir);
  return {dir.x, dir.y, dir.z, t.x, t.y, t.z};
}
void add_outer(Matrix& a, const Motion& r, double s) noexcept {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) a[i][j] += s * r[i] * r[j];
}
/// Of a symmetric positive definite matrix of which the lower half is given.
Motion solved(Matrix a, Motion b) noexcept {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      a[i][j] = i == j ? std::sqrt(sum) : sum / a[j][j];
    }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = 6; i-- > 0;) {
    for (std::size_t k = i + 1; k < 6; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

/// All springs of a tick, in the order in which they were given.
class Springs {
 public:
  Springs(double tick, NeedleWork& w) noexcept : m_tick(tick), m_list(w.springs) { m_list.clear(); }

  /// There is room for all that a Work's lists may hold.
  int add(Vec3d arm, Vec3d dir, double stiffness, double damping, double gap, Vec3d velocity, NeedleSpring::Bound bound,
          double bears = 0, int normal = -1) noexcept {
    m_list.push_back({row_of(dir, arm), stiffness, damping, gap, dot(velocity, dir), bears, bound, normal, 1, 0});
    return int(m_list.size()) - 1;
  }
  const NeedleSpring& at(int i) const noexcept { return m_list[std::size_t(i)]; }

  /// @param free  the motion without springs, times the mass (in `matrix`'s terms)
  Motion solve(const Matrix& mass, const Motion& free) noexcept {
    Motion u{};
    for (int round = 0; round < kRounds; ++round) {
      Matrix a = mass;
      Motion b = free;
      for (const NeedleSpring& s : m_list) {
        if (s.share == 0) continue;
        add_outer(a, s.row, s.share * m_tick * (m_tick * s.stiffness + s.damping));
        const double push = s.share * m_tick * (s.stiffness * (s.gap + m_tick * s.drive) + s.damping * s.drive);
        for (std::size_t k = 0; k < 6; ++k) b[k] += push * s.row[k];
      }
      u = solved(a, b);
      if (!(share(u) > kAgree)) break;
    }
    return u;
  }
  /// What friction along `i` is strained by at the end of the tick, within what it bears.
  double strain(int i) const noexcept { return at(i).force / at(i).stiffness; }

 private:
  /// Of a spring without a bound [N].
  double whole_of(const NeedleSpring& s, const Motion& u) const noexcept {
    const double apart = s.drive - product(s.row, u);
    return s.stiffness * (s.gap + m_tick * apart) + s.damping * apart;
  }
  /// What the springs of a grip, from `first` on, bear of their force together.
  double grip_share(std::size_t first, const Motion& u) const noexcept {
    Vec3d force;
    for (std::size_t i = first; i < m_list.size() && std::size_t(m_list[i].normal) == first; ++i)
      if (m_list[i].bound == NeedleSpring::grips) force[int((i - first) % 3)] += whole_of(m_list[i], u);
    const double bears = m_list[first].bears, pull = length(force);
    return pull > bears ? bears / pull : 1;
  }

  /// Forces at that motion and the shares that their bounds leave them. @return the greatest change of a share
  double share(const Motion& u) noexcept {
    double most = 0, grip = 1;
    for (std::size_t i = 0; i < m_list.size(); ++i) {
      NeedleSpring& s = m_list[i];
      const double whole = whole_of(s, u);
      double share = 1;
      if (s.bound == NeedleSpring::grips) {
        if (std::size_t(s.normal) == i) grip = grip_share(i, u);
        share = grip;
      }
      if (s.bound == NeedleSpring::push) share = whole > 0 ? 1 : 0;
      const double bears = s.bound == NeedleSpring::rubs ? s.bears * std::max(0.0, at(s.normal).force) : s.bears;
      if (s.bound == NeedleSpring::most || s.bound == NeedleSpring::rubs)
        share = std::fabs(whole) > bears ? bears / std::fabs(whole) : 1;
      most = std::max(most, std::fabs(share - s.share));
      s.share = share;
      s.force = share * whole;
    }
    return most;
  }

  double m_tick;
  std::vector<NeedleSpring>& m_list;
};

struct Across {
  Vec3d a, b;
};
Across across(Vec3d n) noexcept {
  const Vec3d a = any_perpendicular(n);
  return {a, cross(n, a)};
}

Vec3d bounded(Vec3d v, double most) noexcept {
  const double l = length(v);
  return l > most ? (most / l) * v : v;
}

/// A contact with friction: the number of the first of three springs.
int add_touch(Springs& all, Vec3d arm, Vec3d normal, double gap, Vec3d velocity, double stiffness, double friction,
              Vec3d slid) noexcept {
  // What has sunk in far comes out by and by.
  const double sunk = std::clamp(-gap, -1.0, kQuickest + 0.5 * std::max(0.0, -gap));
  const int first = all.add(arm, normal, stiffness, 0, sunk, velocity, NeedleSpring::push);
  const Across t = across(normal);
  const Vec3d strain = slid - dot(slid, normal) * normal;
  for (const Vec3d dir : {t.a, t.b})
    all.add(arm, dir, kStrainStiffness * stiffness, 0, dot(strain, dir), velocity, NeedleSpring::rubs, friction, first);
  return first;
}

}  // namespace

NeedleWork make_needle_work() {
  NeedleWork w;
  w.contacts.reserve(kMostContacts);
  w.holds.reserve(kMostNeedleHolds);
  w.pins.reserve(kMostPins);
  w.springs.reserve(kMostAlong);
  return w;
}

void clear(NeedleWork& w) noexcept {
  w.contacts.clear();
  w.holds.clear();
  w.pins.clear();
  w.tip = {};
  w.cuts = {};
  w.tail = {};
  w.overflowed = false;
}

bool advance(const NeedleModel& m, Vec3d gravity, double h, NeedleState& s, NeedleWork& w) noexcept {
  const Mat3d turn = to_mat3(s.q), inertia = turn * m.inertia * transposed(turn);
  Matrix mass{};
  for (std::size_t k = 0; k < 3; ++k) {
    mass[k][k] = m.mass;
    for (std::size_t l = 0; l < 3; ++l) mass[k + 3][l + 3] = inertia.m[k][l];
  }
  const double keeps = 1 - kAir;
  const Vec3d push = m.mass * (keeps * s.v + h * gravity), spin = keeps * (inertia * s.w);
  Motion free{push.x, push.y, push.z, spin.x, spin.y, spin.z};

  Springs all(h, w);
  const auto touch_of = [&](int first, Vec3d normal, Vec3d& slid) {
    const Across t = across(normal);
    slid = all.strain(first + 1) * t.a + all.strain(first + 2) * t.b;
    return all.at(first).force * normal + all.at(first + 1).force * t.a + all.at(first + 2).force * t.b;
  };
  int number = 0;
  for (const NeedleContact& c : w.contacts) {
    const Vec3d arm = rotate(s.q, m.place(m.bead(c.bead))) - 0.5 * m.wire * c.normal;
    add_touch(all, arm, c.normal, c.gap, c.velocity, c.stiffness, c.friction, s.slid[std::size_t(c.bead)]);
    number += 3;
  }
  const int first_hold = number;
  int grip = number;  // where the holds of this owner begin
  for (std::size_t i = 0; i < w.holds.size(); ++i) {
    const NeedleHold& hold = w.holds[i];
    if (i > 0 && hold.owner != w.holds[i - 1].owner) grip = number;
    const Vec3d arm = rotate(s.q, hold.own), off = hold.target - (s.x + arm);
    for (int k = 0; k < 3; ++k) {
      Vec3d axis;
      axis[k] = 1;
      all.add(arm, axis, hold.stiffness, hold.damping, off[k], {0, 0, 0},
              hold.bears >= 0 ? NeedleSpring::grips : NeedleSpring::both, hold.bears, grip);
    }
    number += 3;
  }
  const int first_pin = number;
  for (NeedlePin& pin : w.pins) {
    pin.arc = m.nearest(own_of(s, pin.point));
    const Vec3d arm = rotate(s.q, m.place(pin.arc)), off = pin.point - (s.x + arm);
    const Vec3d along = rotate(s.q, m.along(pin.arc));
    const Across t = across(along);
    all.add(arm, t.a, pin.across, 0, dot(off, t.a), pin.velocity, NeedleSpring::both);
    all.add(arm, t.b, pin.across, 0, dot(off, t.b), pin.velocity, NeedleSpring::both);
    all.add(arm, along, pin.across, 0, pin.stuck, pin.velocity, NeedleSpring::most, pin.drag);
    number += 3;
  }
  const Vec3d tip_arm = rotate(s.q, m.place(0));
  const int first_tip = number;
  if (w.tip.there) {
    add_touch(all, tip_arm, w.tip.dir, -w.tip.gap, w.tip.velocity, w.tip.stiffness, w.tip.friction, w.tip.slid);
    number += 3;
  }
  const int first_cut = number;
  if (w.cuts.there)
    all.add(tip_arm, w.cuts.dir, w.cuts.stiffness, 0, w.cuts.gap, w.cuts.velocity, NeedleSpring::most, w.cuts.most);
  if (dot(w.tail.force, w.tail.force) > 0) {
    const Vec3d arm = rotate(s.q, m.place(m.length));
    const Motion pull = row_of(w.tail.force, arm);
    for (std::size_t k = 0; k < 6; ++k) free[k] += h * pull[k];
    all.add(arm, normalised(w.tail.force), w.tail.stiffness, 0, 0, {0, 0, 0}, NeedleSpring::both);
  }

  const Motion u = all.solve(mass, free);
  s.v = bounded({u[0], u[1], u[2]}, kFastest);
  s.w = bounded({u[3], u[4], u[5]}, kSpins);

  number = 0;
  std::array<Vec3d, kMostBeads> slid{};
  for (NeedleContact& c : w.contacts) {
    Vec3d strain;
    c.force = touch_of(number, c.normal, strain);
    // of several surfaces at a bead the one that presses most is remembered
    if (dot(strain, strain) > dot(slid[std::size_t(c.bead)], slid[std::size_t(c.bead)]))
      slid[std::size_t(c.bead)] = strain;
    number += 3;
  }
  s.slid = slid;
  number = first_hold;
  for (NeedleHold& hold : w.holds) {
    hold.force = {all.at(number).force, all.at(number + 1).force, all.at(number + 2).force};
    hold.slips = all.at(number).share < 1;
    number += 3;
  }
  number = first_pin;
  for (NeedlePin& pin : w.pins) {
    const Vec3d along = rotate(s.q, m.along(pin.arc));
    const Across t = across(along);
    pin.force = all.at(number).force * t.a + all.at(number + 1).force * t.b + all.at(number + 2).force * along;
    pin.stuck = all.strain(number + 2);
    number += 3;
  }
  if (w.tip.there) w.tip.force = touch_of(first_tip, w.tip.dir, w.tip.slid);
  if (w.cuts.there) {
    w.cuts.force = all.at(first_cut).force * w.cuts.dir;
    w.cuts.gap = all.strain(first_cut);
  }

  s.x += h * s.v;
  const Quatd turned = Quatd{0, s.w.x, s.w.y, s.w.z} * s.q;
  s.q = normalised(Quatd{s.q.w + 0.5 * h * turned.w, s.q.x + 0.5 * h * turned.x, s.q.y + 0.5 * h * turned.y,
                         s.q.z + 0.5 * h * turned.z});
  return finite(s.x) && finite(s.v) && finite(s.w) && std::isfinite(s.q.w + s.q.x + s.q.y + s.q.z);
}

}  // namespace trocar::suture
