#include <algorithm>

#include <trocar/sim/bodies/bodies.hpp>
#include <trocar/sim/stages/circulation.hpp>
#include <trocar/sim/stages/tearing.hpp>

namespace trocar::sim {
namespace {

double norm(const double (&f)[3]) noexcept { return length(Vec3d{f[0], f[1], f[2]}); }

/// The hand that did it: the one that holds the body, or else the one that pulls or presses hardest; -1: none.
int culprit(const StepContext& c, BodyId body) noexcept {
  int hardest = -1;
  double most = 0;
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolState& tool = c.state.tools[t];
    for (int h = 0; h < tool.holds; ++h)
      if (tool.hold[h].body == body) return int(t);
    const double force = std::max(norm(tool.pull), norm(tool.contact_force));
    if (force <= most) continue;
    most = force;
    hardest = int(t);
  }
  return hardest;
}

void emit_torn(StepContext& c, BodyId body) noexcept {
  const int hand = culprit(c, body);
  if (c.report.event_count == kMaxEvents || hand < 0) return;
  c.report.events[c.report.event_count++] = {Event::torn, hand, body.code()};
}

/// Out of a lattice no piece can come, so it tears out of the jaws: what is torn stays with the organ.
void let_go(StepContext& c, BodyId body) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    interactions::ToolState& tool = c.state.tools[t];
    if (tool.holds == 0 || tool.hold[0].body != body) continue;
    tool.holds = 0;
    for (double& p : tool.pull) p = 0;
    if (c.report.event_count < kMaxEvents)
      c.report.events[c.report.event_count++] = {Event::released, std::int32_t(t), -1};
  }
}

/// @return whether it tore
template <class Body>
bool tear_body(StepContext& c, Body body) noexcept {
  if (!can_tear(c.model, body)) return false;
  const Parting tear_of_it = tear(c, body);
  if (!tear_of_it.parted) return false;
  open_vessels(c, body.id(), tear_of_it, -1);
  emit_torn(c, body.id());
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
