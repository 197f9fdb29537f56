#include <trocar/sim/model/seen.hpp>

namespace trocar::sim {

kinematics::ScopeFrame scope_of(const Model& model, const State& state) noexcept {
  return kinematics::scope_frame(model.scope.port, pose_of(state.scope), model.scope.angle, double(state.scope.post));
}

double visible_share(const Model& model, const State& state, int target) noexcept {
  const VisibilityTarget& t = model.targets[size_t(target)];
  int seen = 0;
  for (int i = t.first; i < t.first + t.count; ++i) seen += state.seen[size_t(i)];
  return t.count > 0 ? double(seen) / t.count : 0.0;
}

int jaw_tips_visible(const Model& model, const State& state, int hand) noexcept {
  int seen = 0;
  for (size_t i = 0; i < model.targets.size(); ++i) {
    const VisibilityTarget& t = model.targets[i];
    if (t.kind == VisibilityTarget::jaw && t.index == hand) seen += visible(model, state, int(i));
  }
  return seen;
}

}  // namespace trocar::sim
