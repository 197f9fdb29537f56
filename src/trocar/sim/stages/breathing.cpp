#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/motion.hpp>
#include <trocar/sim/stages/stage.hpp>

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

Carried carried_organ(const StepContext& c, std::size_t organ) noexcept {
  return carried(c, c.model.motion.breathing.organs, organ);
}
Carried carried_strand(const StepContext& c, std::size_t strand) noexcept {
  return carried(c, c.model.motion.breathing.strands, strand);
}
Carried carried_membrane(const StepContext& c, std::size_t membrane) noexcept {
  return carried(c, c.model.motion.breathing.membranes, membrane);
}

void carry_held_nodes(StepContext& c, std::size_t organ) noexcept {
  const Carried to = carried_organ(c, organ);
  if (!to.moves) return;
  const std::size_t solids = c.model.solids.size();
  if (organ < solids) {
    const tissue::NetworkModel& m = c.model.solids[organ].network;
    tissue::NetworkState& s = c.state.solids[organ];
    for (const std::int32_t i : c.model.motion.breathing.held[organ])
      set_velocity(m, s, i, (m.rest[std::size_t(i)] + to.x - position(m, s, i)) / kTick);
    return;
  }
  const tissue::CuttableModel& m = c.model.cuttables[organ - solids].body;
  tissue::CuttableState& s = c.state.cuttables[organ - solids];
  for_held(m, s, [&](std::int32_t i) {
    // One that a blade has drawn to itself is no longer at a drawn place: it goes along from where it is.
    const Vec3d way = as_drawn(m, s, i) ? s.tets.rest[std::size_t(i)] + to.x - position(m, s, i) : kTick * to.v;
    set_velocity(m, s, i, way / kTick);
  });
}

void settle_held_nodes(StepContext& c, std::size_t organ) noexcept {
  const Carried to = carried_organ(c, organ);
  if (!to.moves) return;
  const std::size_t solids = c.model.solids.size();
  if (organ < solids) {
    const tissue::NetworkModel& m = c.model.solids[organ].network;
    for (const std::int32_t i : c.model.motion.breathing.held[organ])
      set_position(m, c.state.solids[organ], i, m.rest[std::size_t(i)] + to.x);
    return;
  }
  const tissue::CuttableModel& m = c.model.cuttables[organ - solids].body;
  tissue::CuttableState& s = c.state.cuttables[organ - solids];
  for_held(m, s, [&](std::int32_t i) {
    if (as_drawn(m, s, i)) set_position(m, s, i, s.tets.rest[std::size_t(i)] + to.x);
  });
}

}  // namespace trocar::sim
