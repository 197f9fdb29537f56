#include <algorithm>

#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/model/culprit.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/tearing.hpp>

namespace trocar::sim {
namespace {

/// Out of a lattice no piece can come, so it tears out of the jaws: what is torn stays with the organ.
void let_go(StepContext& c, BodyId body) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    interactions::ToolState& tool = c.state.tools[t];
    if (tool.holds == 0 || tool.hold[0].at.body != body) continue;
    tool.holds = 0;
    for (double& p : tool.pull) p = 0;
    emit_event(c, Event::of_hand(Event::released, int(t)));
  }
}

/// The middle of what has opened.
Vec3d middle_of(const StepContext& c, BodyId body, const Parting& tear) noexcept {
  if (body.is(BodyKind::strand)) {
    const std::vector<Vec3d>& x = c.state.strands[body.index()].x;
    return 0.5 * (x[size_t(tear.element)] + x[size_t(tear.element) + 1]);
  }
  Vec3d sum;
  for (int i = 0; i < tear.blade.corners; ++i) sum += tear.blade.corner[size_t(i)];
  return sum / std::max(1, tear.blade.corners);
}

/// @return whether it tore
template <class Body>
bool tear_body(StepContext& c, Body body) noexcept {
  if (!can_tear(c.model, body)) return false;
  const Parting tear_of_it = tear(c, body);
  if (!tear_of_it.parted) return false;
  open_vessels(c, body.id(), tear_of_it, -1);
  const int hand = culprit(c, {body.id(), middle_of(c, body.id(), tear_of_it)});
  emit_event(c, Event::on_body(Event::torn, hand, body.id()));
  return true;
}

}  // namespace

// What is stretched beyond what it bears.
void tear_tissue(StepContext& c) noexcept {
  visit_solids(c.model, [&c](auto body) {
    if (tear_body(c, body)) let_go(c, body.id());
  });
  visit_cuttables(c.model, [&c](auto body) { tear_body(c, body); });
  visit_membranes(c.model, [&c](auto body) { tear_body(c, body); });
  visit_strands(c.model, [&c](auto body) { tear_body(c, body); });
}

}  // namespace trocar::sim
