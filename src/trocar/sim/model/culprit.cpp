#include <algorithm>

#include <trocar/sim/model/culprit.hpp>

namespace trocar::sim {
namespace {

double norm(const double (&f)[3]) noexcept { return length(Vec3d{f[0], f[1], f[2]}); }

bool holds_one_of(const interactions::ToolState& tool, std::initializer_list<BodyId> bodies) noexcept {
  return std::any_of(tool.hold, tool.hold + tool.holds, [&bodies](const interactions::Hold& h) {
    return std::find(bodies.begin(), bodies.end(), h.body) != bodies.end();
  });
}

}  // namespace

int culprit(const Model& model, const State& state, std::initializer_list<BodyId> bodies) noexcept {
  int holder = -1, hardest = -1;
  double pulls = -1, most = 0;
  for (std::size_t t = 0; t < model.hands.size(); ++t) {
    const interactions::ToolState& tool = state.tools[t];
    const double pull = norm(tool.pull), force = std::max(pull, norm(tool.contact_force));
    if (holds_one_of(tool, bodies) && pull > pulls) pulls = pull, holder = int(t);
    if (force > most) most = force, hardest = int(t);
  }
  return holder >= 0 ? holder : hardest;
}

void emit_torn(StepContext& c, int hand, BodyId body) noexcept {
  if (c.report.event_count < kMaxEvents)
    c.report.events[c.report.event_count++] = {Event::torn, hand, body.code()};
  else
    c.report.flags |= StepReport::kEventsFull;
}

}  // namespace trocar::sim
