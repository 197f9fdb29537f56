#include <trocar/attempt/controls/first_control.hpp>
#include <trocar/attempt/hand_names.hpp>
#include <trocar/devices/mouse_keyboard.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/exercise/step_needs.hpp>

namespace trocar::attempt {

bool tip_in_picture(const sim::Model& model, const sim::State& state, int hand) {
  const kinematics::ScopeFrame scope = sim::scope_of(model, state);
  const Vec3d to = sim::tip_frame_of(model, state, size_t(hand)).tip - scope.eye;
  const double ahead = dot(to, scope.forward), half = 0.5 * model.scope.field_of_view;
  return ahead > 0 && length(to - ahead * scope.forward) * portable::cos(half) < ahead * portable::sin(half);
}

int first_control(const Session& session) {
  const sim::Model& model = session.lesson().model;
  if (model.hands.empty()) return devices::kScope;
  if (const training::Monitor* monitor = session.monitor()) {
    const training::StepNeeds needs =
        training::needs_of(monitor->rules(), monitor->current(), {model, session.state()});
    if (needs.endoscope) return devices::kScope;
    if (needs.hand >= 0) return needs.hand;
  }
  for (int h = 0; h < hand_count(model); ++h)
    if (tip_in_picture(model, session.state(), h)) return h;
  return 0;
}

}  // namespace trocar::attempt
