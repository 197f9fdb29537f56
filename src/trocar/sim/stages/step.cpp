#include <trocar/sim/bodies/bag.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/spilling.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/stages/advancing.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/contacts.hpp>
#include <trocar/sim/stages/containing.hpp>
#include <trocar/sim/stages/hands.hpp>
#include <trocar/sim/stages/injecting.hpp>
#include <trocar/sim/stages/instruments.hpp>
#include <trocar/sim/stages/jaws.hpp>
#include <trocar/sim/stages/peristalsis.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/reaction_forces.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/tearing.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/sim/stages/wetting.hpp>
#include <trocar/sim/verbs/adhesion.hpp>
#include <trocar/sim/verbs/heating.hpp>
#include <trocar/sim/verbs/scarring.hpp>

namespace trocar::sim {
namespace {

// What the endoscope sees.
void update_target_visibility(StepContext& c) noexcept { update_visibility(c.model, c.state, c.work); }

// Reports.
void collect_report(StepContext& c) noexcept {
  visit_bodies(c.model, [&c](auto body) {
    const tissue::StepReport r = report_of(c, body);
    c.report.flags |= r.flags | (overloaded(c, body) ? StepReport::kTooManyLoads : 0u);
    if (r.fine() || c.report.first_bad_body.exists()) return;
    c.report.first_bad_body = body.id();
    c.report.first_bad_index = r.first_bad;
  });
  for (const interactions::TouchBook& book : c.state.touches)
    c.report.flags |= book.count == interactions::kMaxTouches ? StepReport::kTooManyLoads : 0u;
  ++c.state.tick;
}

constexpr Stage kStages[] = {
    {"move hands", move_hands},
    {"separate instruments", separate_instruments},
    {"pose skins", pose_skins},
    {"pose vessels", pose_vessels},
    {"apply anchor loads", apply_anchor_loads},
    {"apply peristalsis", apply_peristalsis},
    {"actuate jaws", actuate_jaws},
    {"resolve instrument contacts", resolve_instrument_contacts},
    {"pierce tissue", pierce_tissue},
    {"resolve body contacts", resolve_body_contacts},
    {"apply adhesion", apply_adhesion},
    {"apply scars", apply_scars},
    {"apply pulse loads", apply_pulse_loads},
    {"apply drop impacts", apply_drop_impacts},
    {"apply border loads", apply_border_loads},
    {"apply bond loads", apply_bond_loads},
    {"advance strands", advance_strands},
    {"swell tissue", swell_tissue},
    {"advance organs", advance_organs},
    {"advance membranes", advance_membranes},
    {"update spilled stones", update_spilled_stones},
    {"advance objects", advance_objects},
    {"step sutures", step_sutures},
    {"update bags", update_bags},
    {"clamp to cavity", clamp_to_cavity},
    {"collect reaction forces", collect_reaction_forces},
    {"heat tissue", heat_tissue},
    {"tear tissue", tear_tissue},
    {"update blood flow", update_blood_flow},
    {"inject", inject},
    {"move fluids", move_fluids},
    {"update visibility", update_target_visibility},
    {"collect report", collect_report},
};

}  // namespace

std::span<const Stage> stages() noexcept { return kStages; }

StepReport step(const Model& model, const Input& input, State& state, Work& work) noexcept {
  StepReport report;
  StepContext context{model, input, state, work, report};
  for (const Stage& stage : kStages) stage.run(context);
  return report;
}

}  // namespace trocar::sim
