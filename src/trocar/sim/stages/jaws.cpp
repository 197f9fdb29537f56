#include <trocar/sim/stages/jaws.hpp>
#include <trocar/sim/verbs/verbs.hpp>

namespace trocar::sim {

// Every hand does what its instrument can.
void actuate_jaws(StepContext& c) noexcept {
  for (size_t t = 0; t < c.model.hands.size(); ++t) {
    const interactions::ToolModel& model = c.model.tool(c.state, t);
    c.work.shapes[t] = shape_of(c.model, c.state, t);
    Verbs::for_each([&](auto verb) {
      if (verb.does(model)) verb.work(c, t);
    });
  }
}

}  // namespace trocar::sim
