// What a scene or a keyframe leads to: some ticks with moving hands, and a look at every place.
#include <cmath>

#include <trocar/core/random.hpp>
#include <trocar/scene/description/capacity.hpp>

#include "targets.hpp"

namespace trocar::fuzz {
namespace {

bool finite(Vec3d v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

constexpr int kTicks = 40;

}  // namespace

bool quick_to_compile(const scene::Description& description) {
  const scene::Extent e = scene::extent_of(description);
  return e.nodes <= 800 && e.places <= 20'000 && e.triangles <= 12'000 && e.strand_nodes <= 200 &&
         description.solids.size() + description.strands.size() + description.walls.size() <= 8;
}

bool finite(const sim::Model& model, const sim::State& state) {
  for (std::size_t i = 0; i < state.solids.size(); ++i)
    for (int n = 0; n < model.solids[i].network.nodes; ++n)
      if (!finite(tissue::position(model.solids[i].network, state.solids[i], n))) return false;
  for (std::size_t i = 0; i < state.membranes.size(); ++i)
    for (int n = 0; n < model.membranes[i].sheet.nodes(); ++n)
      if (!finite(tissue::position(model.membranes[i].sheet.network, state.membranes[i].network, n))) return false;
  for (const tissue::StrandState& strand : state.strands)
    for (Vec3d x : strand.x)
      if (!finite(x)) return false;
  return true;
}

void require_stepped(const sim::Model& model) {
  sim::State state = sim::initial_state(model);
  require(finite(model, state), "what compiles starts at places that are numbers");
  sim::Work work = sim::make_work(model);
  sim::Input input = model.start;
  core::Random random(1);
  bool fine = true;
  for (int t = 0; t < kTicks; ++t) {
    for (sim::ToolInput& tool : input.tools) {
      tool.yaw += float(random.uniform(-0.01, 0.01));
      tool.pitch += float(random.uniform(-0.01, 0.01));
      tool.depth += float(random.uniform(-0.001, 0.002));
      tool.handle = t % 20 < 10 ? 1.0f : 0.0f;
    }
    fine = sim::step(model, input, state, work).fine() && fine;
  }
  require(!fine || finite(model, state), "a place that is not a number is told");
}

}  // namespace trocar::fuzz
