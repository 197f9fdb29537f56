#include <algorithm>
#include <cmath>

#include <trocar/view/smoke_drawing.hpp>

namespace trocar::view {
namespace {

constexpr float kClear = 0.01f;  // [g/m^3] everywhere below it: nothing to be seen

}  // namespace

void list_smoke(const fluids::SmokeModel& model, const fluids::SmokeState& state, render::Frame& frame) {
  frame.smoke.density.clear();
  const auto densest = std::max_element(state.density.begin(), state.density.end());
  if (densest == state.density.end() || !(*densest > kClear)) return;
  render::SmokeVolume& smoke = frame.smoke;
  smoke.origin = vec_cast<float>(model.origin);
  smoke.cell = float(model.cell);
  smoke.nx = model.nx, smoke.ny = model.ny, smoke.nz = model.nz;
  smoke.kappa = float(model.kappa);
  smoke.density.reserve(state.density.size());
  for (const float d : state.density) smoke.density.push_back(d > 0 && std::isfinite(d) ? d : 0);
  smoke.rise = 0.5f * float(model.rise_thin);  // curls lag behind what carries them (our choice)
}

}  // namespace trocar::view
