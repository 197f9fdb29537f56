#include <algorithm>
#include <cmath>

#include <trocar/interactions/objects/suture_sling_step.hpp>
#include <trocar/interactions/verbs/held.hpp>
#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/bodies/sling.hpp>
#include <trocar/sim/bodies/vessel_wounds.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/vessels/lumen.hpp>

namespace trocar::sim {
namespace {

using interactions::SlingAround;
using interactions::SlingHand;
using interactions::SlingState;
using interactions::Suture;

constexpr double kNewOneWithin = 0.013;  // [m] of the tube's end in the body: another loop can be put in
constexpr double kTightFrom = 0.0002;    // [m] that a loop has sunk in: it holds
constexpr double kLoopCloses = double(vessels::LumenGraph{}.closing_cover);
enum Was : std::int32_t { kWasClosed = 1, kWasTight = 2 };

const interactions::SutureModels& models_of(const StepContext& c) noexcept {
  return interactions::part_of<Suture>(c.model);
}
Suture::States& states_of(StepContext& c) noexcept { return interactions::part_of<Suture>(c.state); }
interactions::SutureWorks& works_of(StepContext& c) noexcept { return interactions::part_of<Suture>(c.work); }

bool brings_slings(const StepContext& c, std::size_t hand) noexcept { return c.model.tool(c.state, hand).can().sling; }

/// The sling that the hand has, -1: none.
int sling_of(const StepContext& c, std::size_t hand) noexcept {
  const auto& states = interactions::part_of<Suture>(c.state);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const SlingState& g = states[i].sling;
    if (g.hand == std::int32_t(hand) && g.stage > SlingState::packed && g.stage < SlingState::left) return int(i);
  }
  return -1;
}
bool has_left_one(const StepContext& c, std::size_t hand) noexcept {
  const auto& states = interactions::part_of<Suture>(c.state);
  return std::any_of(states.begin(), states.end(), [&](const interactions::SutureState& s) {
    return s.sling.stage == SlingState::left && s.sling.hand == std::int32_t(hand);
  });
}

/// A hand that has left its loop takes another one at its trocar.
void take_next(StepContext& c, std::size_t hand) noexcept {
  if (has_left_one(c, hand) && c.state.tools[hand].depth > kNewOneWithin) return;
  for (std::size_t i = 0; i < models_of(c).list.size(); ++i) {
    if (!models_of(c).list[i].sling.there() || states_of(c)[i].sling.stage != SlingState::packed) continue;
    interactions::take_sling(models_of(c).list[i], std::int32_t(hand), states_of(c)[i]);
    return;
  }
}

SlingHand hand_of(const StepContext& c, std::size_t t) noexcept {
  const kinematics::TipFrame& frame = c.work.shapes[t].frame;
  const interactions::ToolModel& tool = c.model.tool(c.state, t);
  const double aperture = interactions::aperture_of(tool.linkage, c.state.tools[t].handle);
  SlingHand hand;
  hand.hand = std::int32_t(t);
  hand.mouth = {frame.tip, frame.axis(), frame.normal()};
  hand.depth = c.state.tools[t].depth;
  hand.drawn = 1 - aperture;
  hand.most = tool.pinch_max * hand.drawn * interactions::leverage_at(tool.linkage, aperture);
  return hand;
}

void cut_through(StepContext& c, SlingState& g, SlingAround& a) noexcept {
  const StrandRef strand{a.at.body.index()};
  a.cutting = 0;
  if (!is_whole(bodies_of(c), a.at)) return;
  open_vessels(c, strand.id(), cut(c, strand, a.at.element), g.hand);
  emit_event(c, Event::on_body(Event::loop_cut, g.hand, strand.id()));
  g.was_closed = 0;
}

void watch(StepContext& c, SlingState& g) noexcept {
  std::int32_t is = 0;
  for (std::int32_t k = 0; k < g.around_count; ++k) {
    SlingAround& a = g.around[std::size_t(k)];
    if (a.squeeze > kTightFrom && has_sunk_in(c.model.strand_bodies[a.at.body.index()], a)) is |= kWasTight;
    if (interactions::cover_of_loop(c.model, a) >= kLoopCloses) {
      if (!(g.was_closed & kWasClosed)) emit_event(c, Event::on_body(Event::loop_tightened, g.hand, a.at.body));
      is |= kWasClosed;
    }
    g.last = std::int32_t(a.at.body.index());
    if (a.cutting >= kCutsAfter) return cut_through(c, g, a);
  }
  if (g.was_closed != 0 && g.around_count == 0 && g.last >= 0)
    emit_event(c, Event::on_body(Event::loop_slipped, g.hand, BodyId::strand(std::size_t(g.last))));
  if ((g.was_closed & kWasClosed) && !(is & kWasClosed) && g.around_count > 0)
    emit_event(c, Event::on_body(Event::loop_loosened, g.hand, BodyId::strand(std::size_t(g.last))));
  g.was_closed = is;
}

/// Blades, or too much of a pull, have parted its thread: the rest goes back into the tube.
void notice_parted(StepContext& c, std::size_t i) noexcept {
  const interactions::SutureModel& m = models_of(c).list[i];
  interactions::SutureState& s = states_of(c)[i];
  const int e = interactions::parted_element(m, s);
  if (e >= 0) interactions::cut_sling(m, e, s);
}

}  // namespace

bool has_slings(const Model& model) noexcept {
  const auto& list = interactions::part_of<Suture>(model).list;
  return std::any_of(list.begin(), list.end(), [](const interactions::SutureModel& m) { return m.sling.there(); });
}

void rest_slings(StepContext& c) noexcept {
  if (!has_slings(c.model)) return;
  interactions::strangle(models_of(c), bodies_of(c), c.state.tick, kTick, states_of(c), works_of(c));
}

void lead_slings(StepContext& c) noexcept {
  if (!has_slings(c.model)) return;
  for (std::size_t i = 0; i < states_of(c).size(); ++i) {
    if (!models_of(c).list[i].sling.there()) continue;
    notice_parted(c, i);
    const SlingState& g = states_of(c)[i].sling;
    const bool had = g.stage > SlingState::packed && g.stage < SlingState::left;
    if (had && !brings_slings(c, std::size_t(g.hand)))
      interactions::put_down_sling(models_of(c).list[i], states_of(c)[i]);
  }
  for (std::size_t t = 0; t < c.model.hands.size(); ++t) {
    if (!brings_slings(c, t)) continue;
    if (sling_of(c, t) < 0) take_next(c, t);
    if (const int i = sling_of(c, t); i >= 0) works_of(c).list[std::size_t(i)].sling.hand = hand_of(c, t);
  }
}

void watch_slings(StepContext& c) noexcept {
  if (!has_slings(c.model)) return;
  for (interactions::SutureState& s : states_of(c)) watch(c, s.sling);
}

bool bound_by_sling(const StepContext& c, std::size_t hand) noexcept {
  const int i = sling_of(c, hand);
  if (i < 0) return false;
  const SlingState& g = interactions::part_of<Suture>(c.state)[std::size_t(i)].sling;
  return g.stage == SlingState::off || g.around_count > 0;
}

void lay_out_loops(const StepContext& c, std::span<vessels::Occlusion> out) noexcept {
  std::fill(out.begin(), out.end(), vessels::Occlusion{});
  std::size_t count = 0;
  visit_loops(c.model, c.state, [&](const LoopClosure& loop) {
    const std::size_t strand = loop.at.body.index();
    const double radius = c.model.strand_bodies[strand].model.radius[std::size_t(loop.at.element)];
    for (std::size_t v = 0; v < c.model.vessels.list.size() && count < out.size(); ++v) {
      const double s = place_within(c, int(strand), v, loop.s);
      if (s < 0) continue;
      const vessels::FlowSegment& segment = c.model.vessels.flow.segments[v];
      const double lumen = std::min(0.95 * radius, segment.radius + segment.taper * s);
      out[count++] = {std::int32_t(v), s, interactions::cover_of_loop(radius, lumen, loop.radius)};
    }
  });
}

}  // namespace trocar::sim
