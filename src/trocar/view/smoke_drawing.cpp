#include <algorithm>
#include <cmath>

#include <trocar/view/mesh_buffer.hpp>
#include <trocar/view/smoke_drawing.hpp>

namespace trocar::view {
namespace {

// Plumes: our choice, by eye.
constexpr int kPuffs = 26;
constexpr double kPlumeTime = 0.9;    // [s] that a puff is seen
constexpr double kPlumeSpeed = 0.07;  // [m/s] upwards
constexpr double kPlumeGrows = 0.30;  // of its way, in radius
constexpr double kPlumeDense = 0.64;
constexpr double kPlumeFoot = 0.0013, kPlumeThin = 0.005;  // [m] radius at the tip; and at which it is half as dense
constexpr double kSmokes = 0.15;                           // [s] of current until tissue smokes

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

void list_plumes(const sim::Model& model, const sim::State& state, render::Frame& frame) {
  const Vec3d up = -1.0 * normalised(model.gravity, {0, 0, -1}), side = any_perpendicular(up), other = cross(up, side);
  for (std::size_t h = 0; h < state.electrodes.size(); ++h) {
    const sim::ElectrodeHand& hand = state.electrodes[h];
    if (hand.body < 0 || !(hand.current.on_time > kSmokes)) continue;
    const double now = 1e-3 * double(state.tick % 1000000) / kPlumeTime * kPuffs, first = std::floor(now);
    for (int k = 0; k < kPuffs; ++k) {
      const double age = (now - first + k) / kPuffs;  // 0 .. 1 of its time
      if (age * kPlumeTime > hand.current.on_time) continue;
      const int own = int(first) - k;
      const double high = kPlumeSpeed * kPlumeTime * std::pow(age, 1.4), stray = 0.16 * high;
      // It bends as it rises, and sways.
      const double bend =
          0.45 * high * high / (kPlumeSpeed * kPlumeTime) + 0.22 * high * std::sin(2.2 * now / kPuffs + 7 * age);
      render::Puff puff;
      puff.centre = vec_cast<float>(hand.at + high * up + (bend + stray * (2 * varied(own, 1) - 1)) * side +
                                    (stray * (2 * varied(own, 2) - 1)) * other);
      const double grown = kPlumeGrows * high * (0.6 + 0.8 * varied(own, 3));
      puff.radius = float(kPlumeFoot + grown);
      // Dense where it leaves the tissue; what widens thins out.
      puff.density = float(kPlumeDense * std::pow(1 - age, 2.2) / (1 + grown / kPlumeThin));
      frame.puffs.push_back(puff);
    }
  }
}

}  // namespace trocar::view
