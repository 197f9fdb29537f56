#include <trocar/interactions/contact/piece_contact.hpp>
#include <trocar/sim/bodies/breathing.hpp>
#include <trocar/sim/bodies/carrying.hpp>
#include <trocar/sim/bodies/containment.hpp>
#include <trocar/sim/bodies/cuttable.hpp>
#include <trocar/sim/bodies/hanging.hpp>
#include <trocar/sim/bodies/static_organ.hpp>
#include <trocar/sim/bodies/turns.hpp>
#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::sim {

void pose(StepContext& c, CuttableRef r) noexcept {
  pose_again(c, r);
  c.work.surfaces[r.organ()] = {c.work.organs[r.organ()].skin, &c.work.organs[r.organ()].pose,
                                c.work.organs[r.organ()].nodes, 0};
}

void pose_again(StepContext& c, CuttableRef r) noexcept {
  const tissue::CuttableModel& body = model_of(c.model, r).body;
  tissue::make_current(body, c.state.cuttables[r.index], c.work.cuttables[r.index].body);
  tissue::update(body, c.state.cuttables[r.index], c.work.cuttables[r.index].skin);
  tissue::pose_skin(c.work.organs[r.organ()].nodes, *c.work.organs[r.organ()].skin, c.work.organs[r.organ()].pose);
}

void hang(StepContext& c, CuttableRef r) noexcept {
  interactions::NetworkLoads& loads = c.work.organs[r.organ()].loads;
  loads.clear();
  if (is_quasi_static(c, r.organ())) return;  // the springs that hang it are in its compliance
  hang(model_of(c.model, r).body.anchors, r.organ(), carried(c, r), loads);
}

void touch(StepContext& c, CuttableRef r, HandContact& hand) noexcept {
  interactions::tool_on_surface(hand.touching, r.id(), c.work.surfaces[r.organ()], c.work.organs[r.organ()].loads,
                                held_by(c, hand, r.id()));
}

void touch_itself(StepContext& c, CuttableRef r) noexcept {
  const interactions::Surface& surface = c.work.surfaces[r.organ()];
  interactions::NetworkLoads& loads = c.work.organs[r.organ()].loads;
  const tissue::CuttableWork& work = c.work.cuttables[r.index].body;
  const geometry::CuttableTets& tets = c.state.cuttables[r.index].tets;
  if (work.parts > 1) piece_on_piece(surface, work.part, work.largest_part, loads);
  lip_on_lip(surface, work.part, tets.source, model_of(c.model, r).body.own_nodes, tets.nodes, loads);
}

std::span<const std::int32_t> pieces_of(const StepContext& c, CuttableRef r) noexcept {
  const tissue::CuttableWork& work = c.work.cuttables[r.index].body;
  return work.parts > 1 ? work.part : std::span<const std::int32_t>{};
}

std::span<const std::uint8_t> folded_of(StepContext& c, CuttableRef r) noexcept {
  return folded_rows(model_of(c.model, r).body, c.state.cuttables[r.index], c.work.cuttables[r.index].body);
}

void advance(StepContext& c, CuttableRef r) noexcept {
  if (advance_at_once(c, r)) return;
  interactions::NetworkLoads& loads = c.work.organs[r.organ()].loads;
  loads.sort();
  carry_held_nodes(c, r);
  before_network(c, r);
  const tissue::Hands hands = loads.handled() ? tissue::Hands::on : tissue::Hands::off;
  c.work.organs[r.organ()].report =
      tissue::advance(model_of(c.model, r).body, loads.sorted, loads.reaction, c.state.cuttables[r.index],
                      c.work.cuttables[r.index].body, hands, c.work.organs[r.organ()].scars);
  after_network(c, r);
  settle_held_nodes(c, r);
  carry_along(c, {r.id(),
                  c.work.surfaces[r.organ()],
                  {},
                  c.work.cuttables[r.index].body.fixed,
                  0,
                  nullptr,
                  0,
                  c.state.cuttables[r.index].nodes});
}

void clamp_to_cavity(StepContext& c, CuttableRef r) noexcept {
  const tissue::CuttableModel& body = model_of(c.model, r).body;
  turn_back(c.model.cavity, body.row_of_node, body.origin, c.state.tick, c.state.cuttables[r.index].nodes);
}

double wire_cut(const Model& m, CuttableRef r) noexcept { return 0.6 * model_of(m, r).cell; }

Parting cut(StepContext& c, CuttableRef r, const geometry::Blade& blade) noexcept {
  place_inner_nodes(c, r);
  const geometry::CutResult book =
      tissue::cut(model_of(c.model, r).body, blade, c.state.cuttables[r.index], c.work.cuttables[r.index].body);
  if (book.snapped + book.parted > 0) switch_to_dynamic(c, r);
  if (book.full) c.report.flags |= StepReport::kRecordsFull;
  return {book.parted > 0, blade, -1, book.snapped + book.parted};
}

bool can_tear(const Model& m, CuttableRef r) noexcept { return model_of(m, r).failure_strain > 0; }

Parting tear(StepContext& c, CuttableRef r) noexcept {
  const CuttableOrgan& organ = model_of(c.model, r);
  std::vector<std::uint8_t>& counters = c.state.overstretched_organs[r.organ()];
  place_inner_nodes(c, r);
  const tissue::Overstretch tear = tissue::find_overstretch(
      tissue::springs_of(organ.body, c.state.cuttables[r.index], c.work.cuttables[r.index].body), organ.failure_strain,
      turn_of(c, r.organ()), counters, c.work.beyond);
  if (!tear.found) return {};
  if (!is_quasi_static(c, r.organ())) return opened(cut(c, r, tear.blade(1.0)), counters);
  switch_to_dynamic(c, r);  // whether it tears is for the network to say
  return {};
}

tissue::StepReport report_of(const StepContext& c, CuttableRef r) noexcept { return c.work.organs[r.organ()].report; }
bool overloaded(const StepContext& c, CuttableRef r) noexcept { return c.work.organs[r.organ()].loads.overflowed; }

}  // namespace trocar::sim
