#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/log.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/checks/equilibrium_check.hpp>
#include <trocar/scene/checks/predicted_cost.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::scene {
namespace {

constexpr double kLeastTicks = 20;

EquilibriumCheck::Organ look_at(const sim::Model& model, const sim::State& state, int organ) {
  const std::span<const Vec3d> rest = sim::drawn_nodes(model, organ);
  const tissue::NodeView now = nodes_of(model, state, organ);
  EquilibriumCheck::Organ out{model.organ_name(organ), 0, {}};
  for (std::size_t n = 0; n < rest.size(); ++n) {
    const double off = length(now.position(int(n)) - rest[n]);
    if (off <= out.off) continue;
    out.off = off;
    out.at = rest[n];
    if (std::isnan(off)) break;  // the farthest of all
  }
  return out;
}

}  // namespace

bool EquilibriumCheck::is_stable() const {
  return std::none_of(organs.begin(), organs.end(), [](const Organ& o) { return o.is_unstable(); });
}

EquilibriumCheck check_equilibrium(const sim::Model& scene, std::uint64_t ticks, double most) {
  sim::Model model = scene;
  model.motion = {};
  model.vessels.bleeder.vessel = -1;
  for (std::size_t i = 0; i < model.hands.size(); ++i)  // hands away, but for those that hold something up
    if (model.start.tools[i].handle == 0) model.start.tools[i].depth = float(model.placed(i).limits.depth_min);
  EquilibriumCheck out;
  out.state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  const double affordable = std::max(1e6 * most / predicted_us(model), kLeastTicks);
  const auto last = std::min(ticks, std::uint64_t(std::min(affordable, 1e9)));
  while (out.state.tick < last) sim::step(model, model.start, out.state, work);
  out.seconds = double(out.state.tick) * sim::kTick;
  for (int organ = 0; organ < model.organs(); ++organ) out.organs.push_back(look_at(model, out.state, organ));
  return out;
}

std::string in_words(const EquilibriumCheck& equilibrium, const EquilibriumCheck::Organ& o) {
  return tr(
      "{} is not in equilibrium: it sagged by {:.1f} mm at ({:.1f}, {:.1f}, {:.1f}) mm in {:.2g} s. Use a stiffer or "
      "lighter tissue, larger cells or more anchors.",
      o.name, 1e3 * o.off, 1e3 * o.at.x, 1e3 * o.at.y, 1e3 * o.at.z, equilibrium.seconds);
}

void warn_if_unstable(const sim::Model& model) {
  const EquilibriumCheck equilibrium = check_equilibrium(model, 500, kMostBeforeTraining);
  for (const EquilibriumCheck::Organ& o : equilibrium.organs)
    if (o.is_unstable()) core::log::warn("{}", in_words(equilibrium, o));
}

}  // namespace trocar::scene
