#include <algorithm>
#include <cmath>

#include <trocar/attempt/haptics/contact_modeller.hpp>

namespace trocar::attempt {
namespace {

using devices::ContactPlane;
using devices::LocalModel;
using interactions::ToolShape;
using interactions::Touch;
using interactions::TouchBook;

constexpr double kLeastForce = 1e-4;               // [N] that is felt
constexpr double kSoftest = 30, kStiffest = 1000;  // [N/m] that estimates keep within
constexpr double kAtWall = 500;                    // [N/m] a wall's own (interactions/instrument/wall_stop.hpp)
constexpr double kLeastWay = 1e-4;                 // [m] in kTicks from which a stiffness is read
constexpr double kNewShare = 0.05;                 // of an estimate, a tick
constexpr double kSameSide = 0.8;                  // cosine of normals that count as one plane's
constexpr double kSameContact = 0.9;               // ... of last tick's and this one's
constexpr double kNear = 0.004;                    // [m] another instrument from which on it is reported
constexpr double kMetal = 1000;                    // [N/m] of instruments on each other, where nothing else is touched
constexpr double kLeastShare = 0.2;                // of the depth: contacts near the trocar are hardly felt

/// A force across the shaft at `s` as it is felt at the tip.
Vec3d at_tip(Vec3d force, Vec3d axis, double share) {
  return dot(force, axis) * axis + share * (force - dot(force, axis) * axis);
}

double share_of(Vec3d port, const ToolShape& shape, Vec3d place, double depth) {
  return depth > 0 ? std::clamp(dot(place - port, shape.shaft.axis()) / depth, 0.0, 1.0) : 1.0;
}

/// Where it is touched along the shaft, as a share of the depth; all the way where nothing is known.
double touched_share(Vec3d port, const ToolShape& shape, const TouchBook& book, double depth) {
  double sum = 0, force = 0;
  for (const Touch* t = book.touch; t != book.touch + book.count; ++t) {
    if (!t->anchored || !(t->force > 0)) continue;
    sum += double(t->force) * share_of(port, shape, place_of(shape, *t), depth);
    force += double(t->force);
  }
  return force > 0 ? sum / force : 1.0;
}

struct Side {
  Vec3d normal;  ///< unit, to where the instrument may be
  Vec3d sum;     ///< of forces on the instrument, at the tip [N]
};
struct Sides {
  std::array<Side, devices::kMostPlanes> list;
  int count = 0;

  void add(Vec3d force) {
    const double size = length(force);
    if (!(size > 0)) return;
    int best = -1;
    double most = -2;
    for (int i = 0; i < count; ++i) {
      const double c = dot(list[size_t(i)].normal, force) / size;
      if (c > most) most = c, best = i;
    }
    if (count < devices::kMostPlanes && most < kSameSide) best = count++, list[size_t(best)] = {};
    Side& s = list[size_t(best)];
    s.sum += force;
    s.normal = normalised(s.sum, s.normal);
  }
};

Sides sides_of(Vec3d port, const ToolShape& shape, const TouchBook& book, double depth) {
  Sides sides;
  for (const Touch* t = book.touch; t != book.touch + book.count; ++t)
    if (t->anchored && t->force > 0)
      sides.add(at_tip(-press_of(*t), shape.shaft.axis(), share_of(port, shape, place_of(shape, *t), depth)));
  return sides;
}

bool at_wall(const TouchBook& book) { return book.near(BodyId::wall(), 0); }

ToolShape shape_now(const sim::Model& model, const sim::State& state, int hand) {
  return sim::shape_of(model, state, size_t(hand));
}

/// How far in along the shaft the place is that the hand leads: the straight instrument's tip, or a redundant one's
/// own.
double led_depth(const sim::Model& model, const sim::State& state, int hand, const ToolShape& shape) {
  if (!model.tool(state, size_t(hand)).bends.redundant()) return state.tools[size_t(hand)].depth;
  return std::max(0.0, dot(shape.frame.tip - sim::port_of(model, state, size_t(hand)), shape.shaft.axis()));
}

Vec3d vector_of(const double (&v)[3]) { return {v[0], v[1], v[2]}; }

}  // namespace

TipForces forces_at_tip(const sim::Model& model, const sim::State& state, int hand) noexcept {
  const interactions::ToolState& tool = state.tools[size_t(hand)];
  const ToolShape shape = shape_now(model, state, hand);
  const double share = touched_share(sim::port_of(model, state, size_t(hand)), shape, state.touches[size_t(hand)],
                                     led_depth(model, state, hand, shape));
  return {at_tip(vector_of(tool.contact_force), shape.shaft.axis(), share),
          tool.holds > 0 ? vector_of(tool.pull) : Vec3d{}};
}

void StiffnessEstimate::add(double place, double force) noexcept {
  const size_t at = size_t(m_count % kTicks);
  if (m_count >= kTicks) {
    const double way = place - m_place[at];
    if (std::fabs(way) > kLeastWay) {
      const double seen = std::clamp((force - m_force[at]) / -way, kSoftest, kStiffest);
      m_stiffness += kNewShare * (seen - m_stiffness);
    }
  }
  m_place[at] = place;
  m_force[at] = force;
  ++m_count;
}

/// Planes through the one place from which the spring pulls with this tick's force: the god object lies there now.
void ContactModeller::touch(const sim::State& state, Vec3d wanted, Vec3d force, LocalModel& out) noexcept {
  const TouchBook& book = state.touches[size_t(m_hand)];
  const interactions::ToolModel& tool = m_model.tool(state, size_t(m_hand));
  const ToolShape shape = shape_now(m_model, state, m_hand);
  Sides sides =
      sides_of(sim::port_of(m_model, state, size_t(m_hand)), shape, book, led_depth(m_model, state, m_hand, shape));
  const double size = length(force);
  if (!(size > kLeastForce)) {
    m_touched.forget();
    return;
  }
  if (sides.count == 0) sides.add(force);
  Vec3d sum;
  for (int i = 0; i < sides.count; ++i) sum += sides.list[size_t(i)].sum;
  // The sum over touches is averaged over some ticks, and its part along the surface is friction, which the renderer
  // makes itself; how much presses just now is this tick's.
  const Vec3d along = normalised(sum, force / size), push = std::max(0.0, dot(force, along)) * along;
  if (dot(along, m_normal) < kSameContact) m_touched.forget();
  m_normal = along;
  m_touched.add(dot(wanted, along), length(push));
  out.stiffness = at_wall(book) ? kAtWall : m_touched.stiffness();
  out.rubbing = tool.rubbing;
  for (int i = 0; i < sides.count; ++i)
    out.plane[out.planes++] = {wanted + push / out.stiffness, sides.list[size_t(i)].normal};
}

void ContactModeller::hold(Vec3d wanted, Vec3d pull, LocalModel& out) noexcept {
  const double size = length(pull);
  if (!(size > kLeastForce)) {
    m_held.forget();
    return;
  }
  const Vec3d along = pull / size;
  if (dot(along, m_along) < kSameContact) m_held.forget();
  m_along = along;
  m_held.add(dot(wanted, along), size);
  out.holds = 1;
  out.held_stiffness = m_held.stiffness();
  out.held_at = wanted + pull / out.held_stiffness;
}

/// Metal that is near, as far as there is room for planes.
void ContactModeller::meet_instruments(const sim::State& state, LocalModel& out) const noexcept {
  const Vec3d tip = sim::led_place(m_model, state, size_t(m_hand));
  const ToolShape own = shape_now(m_model, state, m_hand);
  const Vec3d port = sim::port_of(m_model, state, size_t(m_hand));
  const double depth = led_depth(m_model, state, m_hand, own);
  for (int other = 0; other < int(m_model.hands.size()) && out.planes < devices::kMostPlanes; ++other) {
    if (other == m_hand) continue;
    const ToolShape theirs = shape_now(m_model, state, other);
    collision::RodContact nearest;
    nearest.depth = -kNear;
    for (int p = interactions::kShaft; p < end_of(own); p = interactions::next(p))
      for (int q = interactions::kShaft; q < end_of(theirs); q = interactions::next(q)) {
        Vec3f side{};
        const collision::RodContact c = collision::touch(own.rod(p), theirs.rod(q), side);
        if (c.depth > nearest.depth) nearest = c;
      }
    if (!(nearest.depth > -kNear)) continue;
    const double share = std::max(kLeastShare, dot(nearest.on_first - port, own.shaft.axis()) / std::max(depth, 1e-3));
    if (out.planes == 0) out.stiffness = kMetal;
    out.plane[out.planes++] = {tip + (nearest.depth / share) * -nearest.normal, -nearest.normal};
  }
}

/// Contacts of a lattice take turns with a period of four ticks, by a tenth of their force; a hand would feel that
/// buzz.
Vec3d ContactModeller::averaged(Vec3d contact) noexcept {
  m_last[size_t(m_ticks++) % m_last.size()] = contact;
  Vec3d sum;
  for (const Vec3d& f : m_last) sum += f;
  return sum / double(m_last.size());
}

LocalModel ContactModeller::of(const sim::State& state, Vec3d wanted, double seal) noexcept {
  LocalModel out;
  out.tick = state.tick;
  out.port = sim::port_of(m_model, state, size_t(m_hand));
  out.seal_friction = seal;
  const TipForces forces = forces_at_tip(m_model, state, m_hand);
  touch(state, wanted, averaged(forces.contact), out);
  hold(wanted, forces.pull, out);
  meet_instruments(state, out);
  return out;
}

}  // namespace trocar::attempt
