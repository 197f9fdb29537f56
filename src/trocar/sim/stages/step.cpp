#include <trocar/sim/stages/adhesion.hpp>
#include <trocar/sim/stages/bodies.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/contacts.hpp>
#include <trocar/sim/stages/containing.hpp>
#include <trocar/sim/stages/hands.hpp>
#include <trocar/sim/stages/heating.hpp>
#include <trocar/sim/stages/jaws.hpp>
#include <trocar/sim/stages/motion.hpp>
#include <trocar/sim/stages/posing.hpp>
#include <trocar/sim/stages/reaction_forces.hpp>
#include <trocar/sim/stages/scarring.hpp>
#include <trocar/sim/stages/step.hpp>
#include <trocar/sim/stages/tearing.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/sim/stages/wetting.hpp>

namespace trocar::sim {
namespace {

// Eyes: what the endoscope sees.
void see_samples(StepContext& c) noexcept { update_visibility(c.model, c.state, c.work); }

// Reports.
void sum_up(StepContext& c) noexcept {
  const auto take = [&c](const tissue::StepReport& r, int body) {
    c.report.flags |= r.flags;
    if (!r.fine() && c.report.first_bad_body < 0) {
      c.report.first_bad_body = body;
      c.report.first_bad_index = r.first_bad;
    }
  };
  const int organs = c.model.organs();
  for (int i = 0; i < organs; ++i) take(c.work.organ_reports[size_t(i)], i);
  for (size_t i = 0; i < c.model.strands.size(); ++i) take(c.work.strand_reports[i], organs + int(i));
  const int before = organs + int(c.model.strands.size());
  for (size_t i = 0; i < c.model.membranes.size(); ++i) take(c.work.membrane_reports[i], before + int(i));
  for (const interactions::TouchBook& book : c.state.touches)
    c.report.flags |= book.count == interactions::kMaxTouches ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.membrane_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.organ_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  for (const auto& l : c.work.strand_loads) c.report.flags |= l.overflowed ? StepReport::kTooManyLoads : 0u;
  ++c.state.tick;
}

constexpr Stage kStages[] = {
    {"move hands", move_hands},
    {"pose skins", pose_skins},
    {"pose vessels", pose_vessels},
    {"hang organs", hang_organs},
    {"contract", contract},
    {"work jaws", work_jaws},
    {"touch tissue", touch_tissue},
    {"touch organs", touch_organs},
    {"stick", apply_adhesion},
    {"pull scars", pull_scars},
    {"beat", beat},
    {"press with drops", press_with_drops},
    {"pull on borders", pull_on_borders},
    {"advance strands", advance_strands},
    {"advance organs", advance_organs},
    {"advance membranes", advance_membranes},
    {"contain", contain},
    {"feel", gather_reaction_forces},
    {"heat tissue", heat_tissue},
    {"tear", tear_tissue},
    {"let blood flow", let_blood_flow},
    {"move fluids", move_fluids},
    {"see", see_samples},
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
