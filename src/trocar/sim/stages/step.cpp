#include <trocar/sim/bodies/bag.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/bonds.hpp>
#include <trocar/sim/bodies/fat.hpp>
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
void look_for_targets(StepContext& c) noexcept { update_visibility(c.model, c.state, c.work); }

// Reports.
void sum_up(StepContext& c) noexcept {
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
    {"part instruments", part_instruments},
    {"pose skins", pose_skins},
    {"pose vessels", pose_vessels},
    {"hang organs", hang_organs},
    {"contract", contract},
    {"work jaws", work_jaws},
    {"touch tissue", touch_tissue},
    {"pierce tissue", pierce_tissue},
    {"touch organs", touch_organs},
    {"adhere", apply_adhesion},
    {"gather scars", gather_scars},
    {"beat", beat},
    {"press with drops", press_with_drops},
    {"pull on borders", pull_on_borders},
    {"pull on bonds", pull_on_bonds},
    {"pull on fat", pull_on_fat},
    {"advance strands", advance_strands},
    {"swell tissue", swell_tissue},
    {"advance organs", advance_organs},
    {"advance membranes", advance_membranes},
    {"let stones fall", let_stones_fall},
    {"advance objects", advance_objects},
    {"sew", sew},
    {"hold in bags", hold_in_bags},
    {"contain", contain},
    {"gather reactions", gather_reaction_forces},
    {"heat tissue", heat_tissue},
    {"tear", tear_tissue},
    {"let blood flow", let_blood_flow},
    {"inject", inject},
    {"move fluids", move_fluids},
    {"look for targets", look_for_targets},
    {"sum up", sum_up},
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
