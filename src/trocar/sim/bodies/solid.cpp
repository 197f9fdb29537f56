#include <trocar/interactions/verbs/cut.hpp>
#include <trocar/sim/bodies/breathing.hpp>
#include <trocar/sim/bodies/containment.hpp>
#include <trocar/sim/bodies/hanging.hpp>
#include <trocar/sim/bodies/solid.hpp>
#include <trocar/sim/bodies/static_organ.hpp>
#include <trocar/sim/bodies/turns.hpp>
#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::sim {

void pose(StepContext& c, SolidRef s) noexcept {
  const size_t i = s.organ();
  tissue::pose_skin(c.work.organs[i].nodes, *c.work.organs[i].skin, c.work.organs[i].pose);
  const SolidModel& solid = model_of(c.model, s);
  c.work.surfaces[i] = {c.work.organs[i].skin, &c.work.organs[i].pose, c.work.organs[i].nodes,
                        can_tear(c.model, s) ? interactions::torn_beyond(solid.cell) : 0};
}

void hang(StepContext& c, SolidRef s) noexcept {
  interactions::NetworkLoads& loads = c.work.organs[s.organ()].loads;
  loads.clear();
  if (is_quasi_static(c, s.organ())) return;  // the springs that hang it are in its compliance
  hang(model_of(c.model, s).anchors, s.organ(), carried(c, s), loads);
}

void touch(StepContext& c, SolidRef s, HandContact& hand) noexcept {
  interactions::tool_on_surface(hand.touching, s.id(), c.work.surfaces[s.organ()], c.work.organs[s.organ()].loads,
                                held_by(c, hand, s.id()));
}

std::span<const std::int32_t> pieces_of(const StepContext&, SolidRef) noexcept { return {}; }

std::span<const std::uint8_t> folded_of(StepContext& c, SolidRef s) noexcept {
  return folded_rows(model_of(c.model, s).network, c.state.solids[s.index], c.work.solids[s.index]);
}

namespace {
std::span<const Vec3f> pushed_from_within(const StepContext& c, size_t organ) noexcept {
  if (c.work.infusion.empty() || c.work.infusion[organ].pushes == 0) return {};
  return c.work.infusion[organ].force;
}
}  // namespace

void advance(StepContext& c, SolidRef s) noexcept {
  if (advance_at_once(c, s)) return;
  interactions::NetworkLoads& loads = c.work.organs[s.organ()].loads;
  loads.sort();
  carry_held_nodes(c, s);
  before_network(c, s);
  const tissue::Hands hands = loads.handled() ? tissue::Hands::on : tissue::Hands::off;
  c.work.organs[s.organ()].report = tissue::advance(model_of(c.model, s).network, loads.sorted, loads.reaction,
                                                    c.state.solids[s.index], c.work.solids[s.index], nullptr, hands,
                                                    c.work.organs[s.organ()].scars, pushed_from_within(c, s.organ()));
  after_network(c, s);
  settle_held_nodes(c, s);
}

void clamp_to_cavity(StepContext& c, SolidRef s) noexcept {
  const tissue::NetworkModel& network = model_of(c.model, s).network;
  turn_back(c.model.cavity, network.row_of_node, network.origin, c.state.tick, c.state.solids[s.index].nodes);
}

double wire_cut(const Model& m, SolidRef s) noexcept { return 0.6 * model_of(m, s).cell; }

Parting cut(StepContext& c, SolidRef s, const geometry::Blade& blade) noexcept {
  const SolidModel& solid = model_of(c.model, s);
  place_inner_nodes(c, s);
  const int severed = interactions::cut_organ(blade, solid.network, solid.fine, c.state.solids[s.index],
                                              c.state.parted[s.index], c.work.parts);
  if (severed > 0) switch_to_dynamic(c, s);
  return {severed > 0, blade, -1, severed};
}

bool can_tear(const Model& m, SolidRef s) noexcept { return model_of(m, s).failure_strain > 0; }

Parting tear(StepContext& c, SolidRef s) noexcept {
  const SolidModel& solid = model_of(c.model, s);
  std::vector<std::uint8_t>& counters = c.state.overstretched_organs[s.organ()];
  place_inner_nodes(c, s);
  const tissue::Overstretch tear =
      tissue::find_overstretch(tissue::springs_of(solid.network, c.state.solids[s.index]), solid.failure_strain,
                               turn_of(c, s.organ()), counters, c.work.beyond);
  if (!tear.found) return {};
  if (!is_quasi_static(c, s.organ())) return opened(cut(c, s, tear.blade()), counters);
  switch_to_dynamic(c, s);  // whether it tears is for the network to say
  return {};
}

tissue::StepReport report_of(const StepContext& c, SolidRef s) noexcept { return c.work.organs[s.organ()].report; }
bool overloaded(const StepContext& c, SolidRef s) noexcept { return c.work.organs[s.organ()].loads.overflowed; }

}  // namespace trocar::sim
