#include <trocar/interactions/couplings/coupled.hpp>
#include <trocar/sim/bodies/breathing.hpp>
#include <trocar/sim/bodies/containment.hpp>
#include <trocar/sim/bodies/strand.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/tissue/failure/overstretch.hpp>

namespace trocar::sim {
namespace {

/// Where a strand's end will be. `now` is first put where the host is: the end was placed by prediction last tick, and
/// taking that error for a velocity would feed it back with a gain of 1/dt.
tissue::StrandEnd end_of(const StepContext& c, const StrandEndModel& end, const Carried& by_breath, Vec3d drawn,
                         Vec3d& now) noexcept {
  if (end.kind != StrandEndModel::hosted && by_breath.moves) return {drawn + by_breath.x, by_breath.v};
  if (end.kind != StrandEndModel::hosted) return {drawn, {0, 0, 0}};
  const interactions::Bodies bodies = bodies_of(c);
  now = place_of(bodies, end.on.point);
  const Vec3d v = velocity_of(bodies, end.on.point);
  return {now + kTick * v, v};
}

}  // namespace

void hang(StepContext& c, StrandRef r) noexcept { c.work.strands[r.index].loads.clear(); }

void touch(StepContext& c, StrandRef r, HandContact& hand) noexcept {
  const interactions::StrandBody& body = c.model.strand_bodies[r.index];
  const std::span<Vec3f> side = HandContact::next(
      c.state.tool_side, hand.tool_side,
      size_t(body.nodes() - 1) * size_t(c.model.bends() ? interactions::kMostParts : interactions::kToolParts));
  interactions::tool_on_strand(hand.tool, hand.touching, c.state.tools[hand.hand], body, r.id(),
                               c.state.strands[r.index], side, c.work.strands[r.index].loads);
}

void advance(StepContext& c, StrandRef r) noexcept {
  const StrandAnatomy& strand = model_of(c.model, r);
  const interactions::StrandBody& body = c.model.strand_bodies[r.index];
  interactions::StrandLoads& loads = c.work.strands[r.index].loads;
  tissue::StrandState& state = c.state.strands[r.index];
  std::array<tissue::StrandEnd, 2>& at = c.work.strands[r.index].ends;
  const Carried by_breath = carried(c, r);
  size_t ends = 0;
  if (strand.start.kind != StrandEndModel::free)
    at[ends++] = end_of(c, strand.start, by_breath, body.model.rest.front(), state.x.front());
  if (strand.end.kind != StrandEndModel::free)
    at[ends++] = end_of(c, strand.end, by_breath, body.model.rest.back(), state.x.back());
  loads.reaction.assign(loads.list.size(), Vec3d{});
  c.work.strands[r.index].report =
      tissue::advance(body.model, {at.data(), ends}, loads.list, {c.work.strands[r.index].end_reactions.data(), ends},
                      loads.reaction, state, c.work.strands[r.index].body, {by_breath.x, by_breath.v});
}

void pull_on_hosts(StepContext& c, StrandRef r) noexcept {
  const StrandAnatomy& strand = model_of(c.model, r);
  size_t ends = 0;
  for (const StrandEndModel* end : {&strand.start, &strand.end}) {
    if (end->kind == StrandEndModel::free) continue;
    const tissue::StrandReaction& reaction = c.work.strands[r.index].end_reactions[ends++];
    if (end->kind != StrandEndModel::hosted) continue;
    interactions::end_load(bodies_of(c), end->on, reaction, kTick);
  }
}

void clamp_to_cavity(StepContext& c, StrandRef r) noexcept { turn_back(c.model.cavity, c.state.strands[r.index]); }

Parting cut(StepContext& c, StrandRef r, int element) noexcept {
  tissue::cut_element(c.state.strands[r.index], element);
  return {true, {}, element, 0};
}

bool can_tear(const Model& m, StrandRef r) noexcept { return model_of(m, r).failure_strain > 0; }

Parting tear(StepContext& c, StrandRef r) noexcept {
  const int element =
      tissue::find_overstretch(c.model.strand_bodies[r.index].model, c.state.strands[r.index],
                               model_of(c.model, r).failure_strain, c.state.overstretched_strands[r.index]);
  return element >= 0 ? cut(c, r, element) : Parting{};
}

tissue::StepReport report_of(const StepContext& c, StrandRef r) noexcept { return c.work.strands[r.index].report; }
bool overloaded(const StepContext& c, StrandRef r) noexcept { return c.work.strands[r.index].loads.overflowed; }

}  // namespace trocar::sim
