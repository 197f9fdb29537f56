#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/bodies/breathing.hpp>

namespace trocar::sim {
namespace {

Carried carried(const StepContext& c, std::span<const double> shares, std::size_t body) noexcept {
  const BreathingModel& b = c.model.motion.breathing;
  if (!b.there() || !(shares[body] > 0)) return {};
  const Vec3d before = shares[body] * breath_after(b, c.state.tick);
  const Vec3d after = shares[body] * breath_after(b, c.state.tick + 1);
  return {after, (after - before) / kTick, true};
}

/// What a node of a body that can be cut was made from: one that a cut doubled is held as its original is.
std::int32_t original(const geometry::CuttableTets& tets, int own, std::int32_t node) noexcept {
  while (node >= own) node = tets.source[std::size_t(node)];
  return node;
}

/// Does a cut leave the node where it was drawn?
bool as_drawn(const tissue::CuttableModel& m, const tissue::CuttableState& s, std::int32_t node) noexcept {
  const Vec3d way = s.tets.rest[std::size_t(node)] - m.drawn.rest[std::size_t(original(s.tets, m.own_nodes, node))];
  return way.x == 0 && way.y == 0 && way.z == 0;
}

/// Calls act(node) for the nodes that are held rigidly.
template <class Act>
void for_held(const tissue::CuttableModel& m, const tissue::CuttableState& s, Act&& act) noexcept {
  for (std::int32_t i = 0; i < s.tets.nodes; ++i)
    if (m.fixed[std::size_t(original(s.tets, m.own_nodes, i))] == tissue::kHeld) act(i);
}

}  // namespace

Vec3d breath_after(const BreathingModel& b, std::uint64_t ticks) noexcept {
  const double breaths = double(ticks) * kTick / b.period;
  const double s = portable::sin(portable::pi * (breaths - std::floor(breaths)));
  return ((s * s) * (s * s)) * b.way;
}

Carried carried(const StepContext& c, SolidRef solid) noexcept {
  return carried(c, c.model.motion.breathing.organs, solid.organ());
}
Carried carried(const StepContext& c, CuttableRef organ) noexcept {
  return carried(c, c.model.motion.breathing.organs, organ.organ());
}
Carried carried(const StepContext& c, StrandRef strand) noexcept {
  return carried(c, c.model.motion.breathing.strands, strand.index);
}
Carried carried(const StepContext& c, MembraneRef membrane) noexcept {
  return carried(c, c.model.motion.breathing.membranes, membrane.index);
}

void carry_held_nodes(StepContext& c, SolidRef solid) noexcept {
  const Carried to = carried(c, solid);
  if (!to.moves) return;
  const tissue::NetworkModel& m = network_of(c.model, solid);
  tissue::NetworkState& s = state_of(c.state, solid);
  for (const std::int32_t i : c.model.motion.breathing.held[solid.index])
    set_velocity(m, s, i, (m.rest[std::size_t(i)] + to.x - position(m, s, i)) / kTick);
}

void carry_held_nodes(StepContext& c, CuttableRef organ) noexcept {
  const Carried to = carried(c, organ);
  if (!to.moves) return;
  const tissue::CuttableModel& m = model_of(c.model, organ).body;
  tissue::CuttableState& s = state_of(c.state, organ);
  for_held(m, s, [&](std::int32_t i) {
    // One that a blade has drawn to itself is no longer at a drawn place: it goes along from where it is.
    const Vec3d way = as_drawn(m, s, i) ? s.tets.rest[std::size_t(i)] + to.x - position(m, s, i) : kTick * to.v;
    set_velocity(m, s, i, way / kTick);
  });
}

void settle_held_nodes(StepContext& c, SolidRef solid) noexcept {
  const Carried to = carried(c, solid);
  if (!to.moves) return;
  const tissue::NetworkModel& m = network_of(c.model, solid);
  for (const std::int32_t i : c.model.motion.breathing.held[solid.index])
    set_position(m, state_of(c.state, solid), i, m.rest[std::size_t(i)] + to.x);
}

void settle_held_nodes(StepContext& c, CuttableRef organ) noexcept {
  const Carried to = carried(c, organ);
  if (!to.moves) return;
  const tissue::CuttableModel& m = model_of(c.model, organ).body;
  tissue::CuttableState& s = state_of(c.state, organ);
  for_held(m, s, [&](std::int32_t i) {
    if (as_drawn(m, s, i)) set_position(m, s, i, s.tets.rest[std::size_t(i)] + to.x);
  });
}

}  // namespace trocar::sim
