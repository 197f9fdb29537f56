#include <trocar/interactions/instrument/needle.hpp>
#include <trocar/sim/stages/bodies.hpp>
#include <trocar/sim/stages/motion.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/stage.hpp>

namespace trocar::sim {
namespace {

using interactions::Owner;

constexpr double kHangingDamping = 0.02;  // [s] times stiffness: fat and folds that carry an organ yield slowly

void hang(std::span<const tissue::Anchor> anchors, size_t organ, interactions::NetworkLoads& loads) noexcept {
  for (const tissue::Anchor& a : anchors) {
    tissue::NodeLoad load;
    load.node = a.node;
    load.k = float(a.k);
    load.d = float(a.k * kHangingDamping);
    load.x0 = vec_cast<float>(a.x0);
    load.f0 = vec_cast<float>(a.k * (a.x0 - vec_cast<double>(load.x0)));
    loads.add(load, {Owner::anchor, std::int32_t(organ), 0});
  }
}

/// The same springs where a breath carries what they hang from.
void hang(std::span<const tissue::Anchor> anchors, size_t organ, const Carried& by_breath,
          interactions::NetworkLoads& loads) noexcept {
  if (!by_breath.moves) return hang(anchors, organ, loads);
  for (const tissue::Anchor& a : anchors) {
    tissue::NodeLoad load;
    load.node = a.node;
    load.k = float(a.k);
    load.d = float(a.k * kHangingDamping);
    const Vec3d held_at = a.x0 + by_breath.x;
    load.x0 = vec_cast<float>(held_at);
    load.f0 = vec_cast<float>(a.k * (held_at - vec_cast<double>(load.x0)) + (a.k * kHangingDamping) * by_breath.v);
    loads.add(load, {Owner::anchor, std::int32_t(organ), 0});
  }
}

/// Where a strand's end will be. `now` is first put where the host is: the end was placed by prediction last tick, and
/// taking that error for a velocity would feed it back with a gain of 1/dt.
tissue::StrandEnd end_of(const StepContext& c, const StrandEndModel& end, const Carried& by_breath, Vec3d drawn,
                         Vec3d& now) noexcept {
  if (end.kind != StrandEndModel::hosted && by_breath.moves) return {drawn + by_breath.x, by_breath.v};
  if (end.kind != StrandEndModel::hosted) return {drawn, {0, 0, 0}};
  const tissue::StrandEnd next = hosted_end(end.patch, c.work.nodes[size_t(end.organ)], kTick);
  now = next.x - kTick * next.v;
  return next;
}

/// What a body has passed through of an instrument in this tick goes with it.
/// @param gap  how far apart they were at least, `each` numbers from hand to hand; 0 = unknown
void carry_along(const StepContext& c, int body, const interactions::Surface& surface,
                 std::span<const std::uint8_t> open, std::span<const std::uint8_t> fixed, double thickness,
                 const double* gap, size_t each, std::span<tissue::NodeState> rows) noexcept {
  constexpr double kThin = 0.0005;  // [m]
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolShape& shape = c.work.shapes[t];
    if (!interactions::meets_box(surface.pose->bounds, shape.part[interactions::kShaft].a, shape.frame.tip, kNearSheet))
      continue;
    const interactions::ToolState& tool = c.state.tools[t];
    std::array<std::int32_t, interactions::kMaxHolds> between;
    size_t held = 0;
    for (int h = 0; h < tool.holds; ++h)
      if (tool.hold[h].body == body) between[held++] = tool.hold[h].element;
    const interactions::Needles needles = interactions::needles_of(
        c.work.shapes_before[t], shape, interactions::jaws_are_blunt(c.model.tool(c.state, t).kind),
        std::max(kThin, thickness));
    interactions::carry_along(
        needles, {*surface.skin, *surface.pose, open, fixed, {between.data(), held}, surface.nodes.origin, rows},
        gap ? gap[t * each] : 0, kTick);
  }
}

}  // namespace

// Loads start afresh with the springs that hang organs in space.
void hang_organs(StepContext& c) noexcept {
  for (interactions::NetworkLoads& l : c.work.organ_loads) l.clear();
  for (interactions::StrandLoads& l : c.work.strand_loads) l.clear();
  for (interactions::NetworkLoads& l : c.work.membrane_loads) l.clear();
  const size_t solids = c.model.solids.size();
  for (size_t i = 0; i < solids; ++i) hang(c.model.solids[i].anchors, i, carried_organ(c, i), c.work.organ_loads[i]);
  for (size_t i = 0; i < c.model.cuttables.size(); ++i)
    hang(c.model.cuttables[i].body.anchors, solids + i, carried_organ(c, solids + i), c.work.organ_loads[solids + i]);
}

// Folds pull on what carries them.
void pull_on_borders(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept {
    tissue::border_pulls(c.model.membranes[i].sheet, c.state.membranes[i], c.work.membrane_work[i], c.work.pulls[i]);
  });
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    interactions::border_loads(c.model.membranes[i].holds, c.work.pulls[i], c.model.membranes[i].sheet,
                               c.state.membranes[i], holders_of(c), kTick, c.work.strand_loads, c.work.organ_loads);
}

// Strands: implicit, ends where their hosts put them, pulling on them.
void advance_strands(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.strand_order, [&c](size_t i) noexcept {
    const StrandAnatomy& strand = c.model.strands[i];
    const interactions::StrandBody& body = c.model.strand_bodies[i];
    interactions::StrandLoads& loads = c.work.strand_loads[i];
    tissue::StrandState& state = c.state.strands[i];
    const Carried by_breath = carried_strand(c, i);
    size_t ends = 0;
    if (strand.start.kind != StrandEndModel::free)
      c.work.ends[i][ends++] = end_of(c, strand.start, by_breath, body.model.rest.front(), state.x.front());
    if (strand.end.kind != StrandEndModel::free)
      c.work.ends[i][ends++] = end_of(c, strand.end, by_breath, body.model.rest.back(), state.x.back());
    loads.reaction.assign(loads.list.size(), Vec3d{});
    c.work.strand_reports[i] =
        tissue::advance(body.model, {c.work.ends[i].data(), ends}, loads.list, {c.work.end_reactions[i].data(), ends},
                        loads.reaction, state, c.work.strand_work[i], {by_breath.x, by_breath.v});
  });
  for (size_t i = 0; i < c.model.strands.size(); ++i) {
    const StrandAnatomy& strand = c.model.strands[i];
    size_t ends = 0;
    for (const StrandEndModel* end : {&strand.start, &strand.end}) {
      if (end->kind == StrandEndModel::free) continue;
      const tissue::StrandReaction& reaction = c.work.end_reactions[i][ends++];
      if (end->kind != StrandEndModel::hosted) continue;
      const size_t host = size_t(end->organ);
      host_loads(end->patch, reaction, c.work.nodes[host], kTick, int(i), c.work.organ_loads[host]);
    }
  }
}

// Organs: explicit networks in their own sub-steps.
void advance_organs(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.organ_order, [&c](size_t i) noexcept {
    const size_t solids = c.model.solids.size(), k = i - solids;
    interactions::NetworkLoads& loads = c.work.organ_loads[i];
    loads.sort();
    carry_held_nodes(c, i);
    const tissue::Hands hands = loads.handled() ? tissue::Hands::on : tissue::Hands::off;
    if (i < solids) {
      c.work.organ_reports[i] = tissue::advance(c.model.solids[i].network, loads.sorted, loads.reaction,
                                                c.state.solids[i], c.work.solid_work[i], nullptr, hands);
      settle_held_nodes(c, i);
      return;
    }
    c.work.organ_reports[i] = tissue::advance(c.model.cuttables[k].body, loads.sorted, loads.reaction,
                                              c.state.cuttables[k], c.work.cuttable_work[k], hands);
    settle_held_nodes(c, i);
    carry_along(c, interactions::kSolidBase + int(i), c.work.surfaces[i], {}, c.work.cuttable_work[k].fixed, 0, nullptr,
                0, c.state.cuttables[k].nodes);
  });
  view_organs(c);
}

// Folds: borders go where their holders have gone.
void advance_membranes(StepContext& c) noexcept {
  for_each(c.work.pool, c.work.membrane_order, [&c](size_t i) noexcept {
    const MembraneBody& m = c.model.membranes[i];
    const interactions::Holders holders = holders_of(c);
    const Carried by_breath = carried_membrane(c, i);
    for (size_t h = 0; h < m.holds.size(); ++h) {
      c.work.targets[i][h] = held_place(m.holds[h], holders);
      if (by_breath.moves && m.holds[h].kind == interactions::BorderHold::space) c.work.targets[i][h] += by_breath.x;
    }
    interactions::NetworkLoads& loads = c.work.membrane_loads[i];
    loads.sort();
    c.work.membrane_reports[i] = tissue::advance(m.sheet, c.work.targets[i], loads.sorted, loads.reaction,
                                                 c.state.membranes[i], c.work.membrane_work[i]);
    carry_along(c, interactions::kMembraneBase + int(i), c.work.sheets[i].surface, c.state.torn[i],
                m.sheet.network.fixed, m.sheet.thickness, c.work.sheet_gaps.data() + i, c.model.membranes.size(),
                c.state.membranes[i].network.nodes);
  });
}

}  // namespace trocar::sim
