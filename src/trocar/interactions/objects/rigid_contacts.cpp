#include <algorithm>
#include <cmath>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/body_push.hpp>
#include <trocar/interactions/objects/mat6.hpp>
#include <trocar/interactions/objects/rigid_contacts.hpp>

namespace trocar::interactions {
namespace {

constexpr double kAhead = 0.0005;     // [m] beyond the way of a tick, contacts are there before beads touch
constexpr double kQuickestOut = 1.0;  // [m/s] with which an instrument that has moved into a bead pushes it out
constexpr double kSlowly = 0.02;      // [m/s] the same of walls and beads, which nothing should have moved into
constexpr double kSinks = 2e-5;       // [m] that is left
constexpr double kSunkShare = 0.2;    // of what has sunk in, in a tick
constexpr int kContactSweeps = 40;
constexpr double kContactStill = 1e-6;  // [m/s] a sweep that changes less is the last

class Finder {
 public:
  Finder(const RigidModels& models, const Rigid::States& states, double tick, RigidWork& work) noexcept
      : m_models(models), m_states(states), m_tick(tick), m_work(work) {}

  void at_walls(size_t i) noexcept {
    const RigidModel& m = m_models.list[i];
    const double near = near_of(i);
    for (const Vec3d& own : m.beads) {
      const Vec3d p = place_of(m_states[i], own);
      const WallPlaces walls = walls_near(m_models.walls, p);
      for (int k = 0; k < walls.count; ++k) {
        const WallPlace& wall = walls.list[size_t(k)];
        const double gap = wall.distance - m.radius;
        if (gap < near) add(i, p - m.radius * wall.normal, wall.normal, held_off(gap), m.friction);
      }
    }
  }

  void at_rods(size_t i) noexcept {
    const RigidModel& m = m_models.list[i];
    for (const RigidRod& rod : m_work.rods) {
      if (rod.held == BodyId(BodyKind::rigid, i)) continue;
      const double way = collision::way_of(rod.before, rod.now), near = near_of(i) + way;
      const double far = m.reach + rod.now.radius + near;
      if (geometry::distance2(collision::nearest_on_axis(rod.now, m_states[i].x), m_states[i].x) > far * far) continue;
      for (const Vec3d& own : m.beads) at_rod(i, rod, place_of(m_states[i], own), near);
    }
  }

  /// Tissue is a spring where it lies, and continues as fast as it goes now.
  void at_beds() noexcept {
    for (const RigidBed& bed : m_work.beds) {
      const size_t i = size_t(bed.body);
      const RigidModel& m = m_models.list[i];
      const Vec3d p = place_of(m_states[i], m.beads[size_t(bed.bead)]);
      const double gap = std::max(bed.gap, -kQuickestApart) - m_tick * dot(bed.velocity, bed.normal);
      RigidContact* c = add(i, p - m.radius * bed.normal, bed.normal, gap, m.friction);
      if (!c) return;
      c->give = 1 / (kBodyStiffness * m_tick * m_tick);
      c->drive = bed.velocity;
    }
  }

  void at_other(size_t i, size_t j) noexcept {
    const RigidModel &a = m_models.list[i], &b = m_models.list[j];
    const double near = near_of(i) + near_of(j), far = a.reach + b.reach + near, touching = a.radius + b.radius + near;
    if (geometry::distance2(m_states[i].x, m_states[j].x) > far * far) return;
    const bool once = a.pebble.x > 0 && b.pebble.x > 0;  // pebbles are as good as convex: they touch at one place
    Pair nearest;
    for (const Vec3d& own : a.beads) {
      const Vec3d p = place_of(m_states[i], own);
      if (geometry::distance2(p, m_states[j].x) > (b.reach + touching) * (b.reach + touching)) continue;
      for (const Vec3d& other : b.beads) {
        const Pair pair{p, p - place_of(m_states[j], other)};
        if (pair.away() > touching) continue;
        if (!once)
          at_pair(i, j, pair);
        else if (pair.away() < nearest.away())
          nearest = pair;
      }
    }
    if (once && nearest.away() <= touching) at_pair(i, j, nearest);
  }

 private:
  /// Beads of two bodies: the first one's place, and how it lies from the second.
  struct Pair {
    Vec3d p, off{1e3, 0, 0};
    double away() const noexcept { return length(off); }
  };
  void at_pair(size_t i, size_t j, const Pair& pair) noexcept {
    const RigidModel &a = m_models.list[i], &b = m_models.list[j];
    const Vec3d normal = normalised(pair.off, {0, 0, 1});
    RigidContact* c = add(i, pair.p - a.radius * normal, normal, held_off(pair.away() - a.radius - b.radius),
                          0.5 * (a.friction + b.friction));
    if (!c) return;
    c->other = std::int32_t(j);
    c->other_arm = pair.p - a.radius * normal - m_states[j].x;
  }
  double near_of(size_t i) const noexcept {
    const RigidState& s = m_states[i];
    return kAhead + m_tick * (length(s.v) + m_models.list[i].reach * length(s.w));
  }
  /// The gap that keeps what has sunk in from being thrown out.
  double held_off(double gap) const noexcept {
    return gap >= 0 ? gap : -std::min(kSunkShare * std::max(-gap - kSinks, 0.0), kSlowly * m_tick);
  }

  void at_rod(size_t i, const RigidRod& rod, Vec3d p, double near) noexcept {
    const RigidModel& m = m_models.list[i];
    const double s = geometry::closest_on_segment(p, rod.now.a, rod.now.b);
    const Vec3d now = rod.now.a + s * (rod.now.b - rod.now.a), was = rod.before.a + s * (rod.before.b - rod.before.a);
    Vec3d off = p - now;
    double away = length(off);
    // A rod that has passed a bead's middle in this tick pushes it on, not back.
    const Vec3d normal = away > 1e-9 ? (1 / away) * off : normalised(p - was, {0, 0, 1});
    const bool passed = dot(off, p - was) < 0;
    const double gap = (passed ? -away : away) - rod.now.radius - m.radius;
    if (gap > near) return;
    const Vec3d up = passed ? -normal : normal;
    RigidContact* c = add(i, p - m.radius * up, up, std::max(gap, -kQuickestOut * m_tick), m.friction);
    if (!c) return;
    c->drive = (now - was) / m_tick;
    c->tag = rod.tag;
  }

  RigidContact* add(size_t i, Vec3d point, Vec3d normal, double gap, double friction) noexcept {
    if (m_work.contacts.size() == m_work.contacts.capacity()) {
      m_work.overflowed = true;
      return nullptr;
    }
    RigidContact& c = m_work.contacts.emplace_back();
    c.body = std::int32_t(i);
    c.normal = normal;
    c.along = any_perpendicular(normal);
    c.across = cross(normal, c.along);
    c.arm = point - m_states[i].x;
    c.gap = gap;
    c.friction = friction;
    return &c;
  }

  const RigidModels& m_models;
  const Rigid::States& m_states;
  double m_tick;
  RigidWork& m_work;
};

Vec3d axis_of(const RigidContact& c, size_t k) noexcept { return k == 0 ? c.normal : k == 1 ? c.along : c.across; }

void prepare(RigidWork& work, RigidContact& c) noexcept {
  for (size_t k = 0; k < 3; ++k) {
    c.row[k] = wrench(axis_of(c, k), c.arm);
    c.answer[k] = product(work.mobility[size_t(c.body)], c.row[k]);
    c.gain[int(k)] = product(c.row[k], c.answer[k]);
    if (c.other < 0) continue;
    c.other_row[k] = wrench(axis_of(c, k), c.other_arm);
    c.other_answer[k] = product(work.mobility[size_t(c.other)], c.other_row[k]);
    c.gain[int(k)] += product(c.other_row[k], c.other_answer[k]);
  }
}

/// Of the touching point along one of the contact's axes, against what it touches.
double speed_of(const RigidWork& work, const RigidContact& c, size_t k) noexcept {
  const double other = c.other >= 0 ? product(c.other_row[k], work.motion[size_t(c.other)]) : 0;
  return product(c.row[k], work.motion[size_t(c.body)]) - other;
}

void push(RigidWork& work, const RigidContact& c, size_t k, double impulse) noexcept {
  add(work.motion[size_t(c.body)], impulse, c.answer[k]);
  if (c.other >= 0) add(work.motion[size_t(c.other)], -impulse, c.other_answer[k]);
}

/// @return by how much it has changed a speed [m/s]
double solve(double tick, RigidWork& work, RigidContact& c) noexcept {
  double changed = 0;
  const double lacks = speed_of(work, c, 0) + c.gap / tick + c.give * c.impulse.x;
  const double wanted = c.impulse.x - lacks / (c.gain.x + c.give);
  const double press = std::max(wanted, 0.0);
  push(work, c, 0, press - c.impulse.x);
  changed = std::max(changed, std::fabs(press - c.impulse.x) * c.gain.x);
  c.impulse.x = press;
  Vec3d rub{press, 0, 0};
  for (size_t k = 1; k < 3; ++k)
    rub[int(k)] = c.impulse[int(k)] - (speed_of(work, c, k) - dot(c.drive, axis_of(c, k))) / c.gain[int(k)];
  const double most = c.friction * press, asked = std::sqrt(rub.y * rub.y + rub.z * rub.z);
  if (asked > most) rub.y *= most / asked, rub.z *= most / asked;
  for (size_t k = 1; k < 3; ++k) {
    const double more = rub[int(k)] - c.impulse[int(k)];
    push(work, c, k, more);
    changed = std::max(changed, std::fabs(more) * c.gain[int(k)]);
    c.impulse[int(k)] = rub[int(k)];
  }
  return changed;
}

}  // namespace

void find_contacts(const RigidModels& models, const Rigid::States& states, double tick, RigidWork& work) noexcept {
  Finder finder(models, states, tick, work);
  for (size_t i = 0; i < states.size(); ++i) {
    if (work.awake[i]) finder.at_walls(i), finder.at_rods(i);
    for (size_t j = i + 1; j < states.size(); ++j)
      if ((work.awake[i] || work.awake[j]) && !states[i].inside() && !states[j].inside()) finder.at_other(i, j);
  }
  finder.at_beds();
}

void solve_contacts(double tick, RigidWork& work) noexcept {
  for (RigidContact& c : work.contacts) prepare(work, c);
  for (int sweep = 0; sweep < kContactSweeps; ++sweep) {
    double changed = 0;
    for (RigidContact& c : work.contacts) changed = std::max(changed, solve(tick, work, c));
    if (changed < kContactStill) return;
  }
}

}  // namespace trocar::interactions
