// How far the endoscope's picture is turned from upright.
#pragma once

#include <optional>

#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>

namespace trocar::training {

/// To the right above 0 [rad]. Nothing while the endoscope looks straight up or down, or without gravity.
inline std::optional<double> horizon_of(const sim::Model& model, const sim::State& state) {
  constexpr double kSteep = 0.1;  // sine of the angle to the plumb line below which a picture has no horizon
  const double g = length(model.gravity);
  if (g <= 0) return std::nullopt;
  const Vec3d up = -1 / g * model.gravity;
  const kinematics::ScopeFrame scope = sim::scope_of(model, state);
  const double x = dot(up, scope.right), y = dot(up, scope.up);
  if (x * x + y * y < kSteep * kSteep) return std::nullopt;
  return portable::atan2(x, y);
}

}  // namespace trocar::training
