#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/bag_cloth.hpp>
#include <trocar/interactions/objects/bag_contents.hpp>
#include <trocar/sim/bodies/bag.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {
namespace {

using interactions::Bag;
using interactions::BagBody;
using interactions::BagModel;
using interactions::BagState;
using interactions::BagWork;
using interactions::Rigid;

constexpr double kNearBag = 0.020;       // [m] of the cloth: further away nothing is looked at
constexpr double kTurnsOn = 0.98;        // share of a stone's turning that cloth leaves it in a tick
constexpr double kWallOfPouch = 0.0005;  // [m] beyond half its thickness, as its triangles bulge between nodes

/// f(model, state, work) of every bag that has come out of its sleeve, or may.
template <class F>
void for_bags(StepContext& c, F&& f) noexcept {
  const auto& models = interactions::part_of<Bag>(c.model).list;
  auto& states = interactions::part_of<Bag>(c.state);
  auto& works = interactions::part_of<Bag>(c.work).list;
  for (size_t i = 0; i < models.size(); ++i) f(models[i], states[i], works[i]);
}

/// The hand that has it, or that may take it. -1: none
std::int32_t hand_at(const StepContext& c, const BagState& s) noexcept {
  std::int32_t found = -1;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    if (!c.model.tool(c.state, t).can().bag) continue;
    if (std::int32_t(t) == s.hand) return s.hand;
    if (found < 0) found = std::int32_t(t);
  }
  return found;
}

Vec3d downwards(const StepContext& c) noexcept { return normalised(c.model.gravity, {0, 0, -1}); }

bool is_held(const StepContext& c, BodyId body) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t)
    if (c.state.tools[t].holds > 0 && c.state.tools[t].hold[0].at.body == body) return true;
  return false;
}

/// As thick as it is in the mean: to the cloth a stone is a ball.
void look_at_rigids(const StepContext& c, const BagModel& m, BagWork& w) noexcept {
  const auto& models = interactions::part_of<Rigid>(c.model).list;
  const auto& states = interactions::part_of<Rigid>(c.state);
  for (size_t i = 0; i < size_t(m.rigids); ++i) {
    BagBody& b = w.bodies[i];
    b = {states[i].x,
         {0, 0, 0},
         states[i].v,
         0.5 * (models[i].radius + models[i].reach),
         std::max(interactions::kLightest, m.mass / models[i].mass),
         false};
    b.near = !states[i].inside() && w.bounds.reaches(b.x, kNearBag);
    if (is_held(c, BodyId(BodyKind::rigid, i))) b.light = 0;
  }
}

/// Nothing in the cloth's own step moves them: it pushes them with loads.
void look_at_pouches(const StepContext& c, const BagModel& m, BagWork& w) noexcept {
  for (const interactions::BagPouch& p : m.pouches) {
    const size_t i = size_t(p.membrane);
    const bool reached = c.work.membranes[i].pose.bounds.near_box(w.bounds, float(kNearBag));
    const tissue::MembraneModel& sheet = c.model.membranes[i].sheet;
    const tissue::NodeView nodes = view_of(sheet.network, c.state.membranes[i].network);
    const double radius = 0.5 * sheet.thickness + kWallOfPouch;
    for (std::int32_t n = 0; n < p.count; ++n) {
      BagBody& b = w.bodies[size_t(p.first + n)];
      b = {};
      if (!reached) continue;
      b.x = nodes.position(n);
      b.speed = nodes.velocity(n);
      b.radius = radius;
      b.near = w.bounds.reaches(b.x, kNearBag);
    }
  }
}

void push_pouches(StepContext& c, const BagModel& m, const BagState& s, const BagWork& w) noexcept {
  const Vec3d drift = drift_of(m, s), down = downwards(c);
  for (const interactions::BagPouch& p : m.pouches) {
    interactions::NetworkLoads& loads = c.work.membranes[size_t(p.membrane)].loads;
    for (const interactions::BagTouch& t : w.touches)
      if (t.point >= p.first && t.point < p.first + p.count)
        push_off_hoop(t, w.bodies[size_t(t.point)], t.point - p.first, loads);
    for (std::int32_t n = 0; n < p.count; ++n)
      if (const size_t i = size_t(p.first + n); s.points[i].where == interactions::BagPoint::inside)
        keep_in_bag(m, s, down, w.bodies[i], n, drift, loads);
  }
}

/// A stone in it does not sleep.
void move_stones(StepContext& c, const BagModel& m, const BagState& s, const BagWork& w) noexcept {
  auto& states = interactions::part_of<Rigid>(c.state);
  for (size_t i = 0; i < size_t(m.rigids); ++i) {
    const Vec3d moved = w.bodies[i].moved;
    const bool touched = !(moved == Vec3d{}) && !states[i].inside();
    if (touched) {
      states[i].x += moved;
      states[i].v = speed_after(w.bodies[i], kTick);
      states[i].w *= kTurnsOn;
    }
    if (touched || s.points[i].where == interactions::BagPoint::inside) states[i].still = 0;
  }
}

/// @return whether there is a bag to be moved
bool follow(const StepContext& c, BagState& s, const BagWork& w) noexcept {
  const std::int32_t t = hand_at(c, s);
  if (t < 0) return s.there();
  const kinematics::TipFrame& frame = c.work.shapes[size_t(t)].frame;
  interactions::BagHand hand;
  hand.frame = {frame.tip, frame.axis(), frame.normal()};
  hand.depth = c.state.tools[size_t(t)].depth;
  hand.handle = c.state.tools[size_t(t)].handle;
  hand.hand = t;
  follow_hand(hand, kTick, w, s);
  return s.there();
}

}  // namespace

void rest_bags(StepContext& c) noexcept {
  for_bags(c, [&c](const BagModel& m, BagState& s, BagWork& w) {
    w.bounds = bounds_of(s);
    w.narrowest = 0;
    look_at_rigids(c, m, w);
    look_at_pouches(c, m, w);
    if (s.unrolled < 1) return;
    find_skins(m, c.work.surfaces, c.state.tick, s, w);
    for (size_t i = 0; i < c.work.surfaces.size(); ++i) {
      const interactions::Surface& surface = c.work.surfaces[i];
      if (!surface.pose->bounds.near_box(w.bounds, 0.005f)) continue;
      rest_cloth(m, surface, std::int32_t(i), s, surface.moves() ? &c.work.organs[i].loads : nullptr, w);
    }
    note_places(m, downwards(c), s, w);
    find_normals(m, s, w);
    find_touches(m, c.state.tick, s, w);
    push_pouches(c, m, s, w);
  });
}

void update_bags(StepContext& c) noexcept {
  for_bags(c, [&c](const BagModel& m, BagState& s, BagWork& w) {
    if (!follow(c, s, w)) return;
    look_at_rigids(c, m, w);
    look_at_pouches(c, m, w);
    if (!advance_cloth(m, c.model.gravity, kTick, s, w) && !c.report.first_bad_body.exists()) {
      c.report.flags |= tissue::StepReport::kNonFinite;
      c.report.first_bad_body = BodyId(BodyKind::bag, 0);
    }
    move_stones(c, m, s, w);
  });
}

}  // namespace trocar::sim
