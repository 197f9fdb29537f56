#include <trocar/interactions/couplings/border.hpp>
#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/sim/bodies/breathing.hpp>
#include <trocar/sim/bodies/carrying.hpp>
#include <trocar/sim/bodies/containment.hpp>
#include <trocar/sim/bodies/membrane.hpp>
#include <trocar/sim/bodies/spilling.hpp>
#include <trocar/sim/bodies/turns.hpp>
#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::sim {

void pose(StepContext& c, MembraneRef r) noexcept {
  const MembraneBody& m = model_of(c.model, r);
  const tissue::NodeView nodes = view_of(m.sheet.network, c.state.membranes[r.index].network);
  tissue::pose_skin(nodes, m.skin, c.work.membranes[r.index].pose);
  const bool swings = m.sheet.enclosure.kind != tissue::Enclosure::none;
  c.work.membranes[r.index].sheet = {{&m.skin, &c.work.membranes[r.index].pose, nodes, 0, swings},
                                     c.state.torn[r.index],
                                     m.sheet.network.fixed,
                                     0.5 * m.sheet.thickness,
                                     m.pinch_reach};
}

void hang(StepContext& c, MembraneRef r) noexcept { c.work.membranes[r.index].loads.clear(); }

void touch(StepContext& c, MembraneRef r, HandContact& hand) noexcept {
  const size_t sides = model_of(c.model, r).sheet.triangles.size() *
                       size_t(c.model.bends() ? interactions::kMostParts : interactions::kSheetParts);
  const std::span<Vec3f> side = HandContact::next(c.state.sheet_side, hand.sheet_side, sides);
  const size_t pair = hand.hand * c.model.membranes.size() + r.index;
  const interactions::ToolShape& shape = c.work.shapes[hand.hand];
  interactions::SheetBond& bond = c.state.sheet_bond[pair];
  double& gap = c.work.sheet_gaps[pair];
  gap = kNearSheet;
  if (bond != interactions::SheetBond::none ||
      interactions::comes_near(shape, c.work.membranes[r.index].pose.bounds, kNearSheet))
    interactions::tool_on_sheet(hand.touching, c.state.tools[hand.hand], r.id(), c.work.membranes[r.index].sheet, side,
                                bond, c.work.membranes[r.index].loads, gap);
}

void find_pulls(StepContext& c, MembraneRef r) noexcept {
  tissue::border_pulls(model_of(c.model, r).sheet, c.state.membranes[r.index], c.work.membranes[r.index].body,
                       c.work.membranes[r.index].pulls);
}

void pull_on_holders(StepContext& c, MembraneRef r) noexcept {
  interactions::border_loads(bodies_of(c), r.index, c.work.membranes[r.index].pulls, kTick);
}

void advance(StepContext& c, MembraneRef r) noexcept {
  const size_t i = r.index;
  const MembraneBody& m = model_of(c.model, r);
  const interactions::Bodies bodies = bodies_of(c);
  const Carried by_breath = carried(c, r);
  for (size_t h = 0; h < m.holds.size(); ++h) {
    c.work.membranes[i].targets[h] = place_of(bodies, m.holds[h].point);
    if (by_breath.moves && m.holds[h].point.in_space()) c.work.membranes[i].targets[h] += by_breath.x;
  }
  interactions::NetworkLoads& loads = c.work.membranes[i].loads;
  loads.sort();
  c.work.membranes[i].report =
      tissue::advance(m.sheet, c.work.membranes[i].targets, loads.sorted, loads.reaction, c.state.membranes[i],
                      c.work.membranes[i].body, c.work.membranes[i].scars);
  c.work.membranes[i].by_wall = tissue::leak(m.sheet, c.state.torn[i], c.work.membranes[i].body, c.state.membranes[i]);
  c.work.membranes[i].by_duct = leak_by_duct(c, r);
  carry_along(c, {r.id(), c.work.membranes[i].sheet.surface, c.state.torn[i], m.sheet.network.fixed, m.sheet.thickness,
                  c.work.sheet_gaps.data() + i, c.model.membranes.size(), c.state.membranes[i].network.nodes});
}

void clamp_to_cavity(StepContext& c, MembraneRef r) noexcept {
  const tissue::NetworkModel& network = model_of(c.model, r).sheet.network;
  turn_back(c.model.cavity, network.row_of_node, network.origin, c.state.tick,
            c.state.membranes[r.index].network.nodes);
}

double wire_cut(const Model&, MembraneRef) noexcept { return 0; }

Parting cut(StepContext& c, MembraneRef r, const geometry::Blade& blade) noexcept {
  const MembraneBody& m = model_of(c.model, r);
  const interactions::FoldCut fold = interactions::cut_membrane(blade, m.sheet, m.depth, c.state.membranes[r.index],
                                                                c.state.torn[r.index], c.work.parts);
  return {fold.severed > 0, blade, -1, fold.severed, fold.depth};
}

bool can_tear(const Model& m, MembraneRef r) noexcept { return model_of(m, r).failure_strain > 0; }

Parting tear(StepContext& c, MembraneRef r) noexcept {
  const MembraneBody& m = model_of(c.model, r);
  std::vector<std::uint8_t>& counters = c.state.overstretched_membranes[r.index];
  const tissue::Overstretch tear = tissue::find_overstretch(
      tissue::springs_of(m.sheet.network, c.state.membranes[r.index].network), m.failure_strain,
      turn_of(c, size_t(c.model.organs()) + r.index), counters, c.work.beyond);
  return tear.found ? opened(cut(c, r, tear.blade()), counters) : Parting{};
}

tissue::StepReport report_of(const StepContext& c, MembraneRef r) noexcept { return c.work.membranes[r.index].report; }
bool overloaded(const StepContext& c, MembraneRef r) noexcept { return c.work.membranes[r.index].loads.overflowed; }

}  // namespace trocar::sim
