#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/interactions/objects/suture_on_tissue.hpp>
#include <trocar/interactions/objects/suture_stitch.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/bodies/suture.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/model/culprit.hpp>

namespace trocar::sim {
namespace {

using interactions::Suture;

bool has_sutures(const StepContext& c) noexcept { return !c.state.objects.sutures.empty(); }

/// The body's numbers of nodes may have grown by cuts: surfaces are seen again.
void see_again(StepContext& c) noexcept {
  for (int i = 0; i < c.model.organs(); ++i) c.work.surfaces[size_t(i)].nodes = nodes_of(c.model, c.state, i);
  for (size_t i = 0; i < c.model.membranes.size(); ++i)
    c.work.membranes[i].sheet.surface.nodes = view_of(c.model.membranes[i].sheet.network, c.state.membranes[i].network);
}

/// Stitches that were torn out, threads that broke.
void emit_sewn(StepContext& c, const interactions::SewnReport& r) noexcept {
  for (int i = 0; i < r.torn_count; ++i) {
    const interactions::TornStitch& t = r.torn[size_t(i)];
    emit_event(c, Event::on_body(Event::torn, culprit(c, {t.body, t.at, t.suture, t.pull}), t.body));
  }
  for (int i = 0; i < r.broken_count; ++i) {
    const interactions::BrokenThread& b = r.broken[size_t(i)];
    const int hand = b.crushed_by >= 0 ? b.crushed_by : breaker_of(c, b.suture);
    emit_event(c, Event::on_body(Event::thread_broken, hand, b.suture));
  }
  if (r.events_lost) c.report.flags |= StepReport::kEventsFull;
  if (r.records_full) c.report.flags |= StepReport::kRecordsFull;
}

}  // namespace

void rest_sutures(StepContext& c) noexcept {
  if (!has_sutures(c)) return;
  interactions::rest_on_tissue(interactions::part_of<Suture>(c.model), bodies_of(c), c.model.cavity, c.state.tick,
                               kTick, interactions::part_of<Suture>(c.state), interactions::part_of<Suture>(c.work));
  rest_slings(c);
}

void step_sutures(StepContext& c) noexcept {
  if (!has_sutures(c)) return;
  see_again(c);
  lead_slings(c);
  const interactions::SewnReport r =
      interactions::sew(interactions::part_of<Suture>(c.model), bodies_of(c), c.model.gravity, kTick, c.model.cavity,
                        interactions::part_of<Suture>(c.state), interactions::part_of<Suture>(c.work));
  emit_sewn(c, r);
  watch_slings(c);
  if (!r.bad.exists() || c.report.first_bad_body.exists()) return;
  c.report.flags |= tissue::StepReport::kNonFinite;
  c.report.first_bad_body = r.bad;
  c.report.first_bad_index = 0;
}

void cut_threads(StepContext& c, std::size_t hand) noexcept {
  const auto& list = interactions::part_of<Suture>(c.model).list;
  Suture::States& states = interactions::part_of<Suture>(c.state);
  for (std::size_t i = 0; i < states.size(); ++i)
    if (interactions::cut_thread(list[i], c.model.tool(c.state, hand), c.work.shapes[hand], states[i]))
      emit_event(c, Event::on_body(Event::thread_cut, int(hand), BodyId(BodyKind::suture, i)));
}

void clip_threads(StepContext& c, std::size_t hand, int clip) noexcept {
  if (!has_sutures(c)) return;
  const auto clipped = interactions::clip_thread(interactions::part_of<Suture>(c.model), c.model.tool(c.state, hand),
                                                 c.work.shapes[hand], clip, interactions::part_of<Suture>(c.state),
                                                 c.state.clips[std::size_t(clip)]);
  if (clipped == interactions::ThreadClipping::no_room) c.report.flags |= StepReport::kRecordsFull;
}

void slip_in_jaws(StepContext& c, std::size_t hand) noexcept {
  if (!has_sutures(c)) return;
  interactions::slip_in_jaws(interactions::part_of<Suture>(c.model), interactions::part_of<Suture>(c.state),
                             interactions::part_of<Suture>(c.work), int(hand), c.model.tool(c.state, hand),
                             c.work.shapes[hand], c.state.tools[hand]);
}

}  // namespace trocar::sim
