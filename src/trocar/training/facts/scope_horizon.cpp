#include <trocar/numerics/portable.hpp>
#include <trocar/sim/stages/visibility.hpp>
#include <trocar/training/facts/registry.hpp>

namespace trocar::training {
namespace {

Value horizon(const Moment& moment, const Arguments&) {
  constexpr double kSteep = 0.1;  // sine of the angle to the plumb line below which a picture has no horizon
  const double g = length(moment.model.gravity);
  if (g <= 0) return kUnknown;
  const Vec3d up = -1 / g * moment.model.gravity;
  const kinematics::ScopeFrame scope = sim::scope_of(moment.model, moment.state);
  const double x = dot(up, scope.right), y = dot(up, scope.up);
  if (x * x + y * y < kSteep * kSteep) return kUnknown;
  return portable::atan2(x, y);
}

}  // namespace

const Fact kScopeHorizon{"scope.horizon_deg",
                         {},
                         -180,
                         180,
                         "Rotation of the picture from upright, positive to the right. Unknown while the scope "
                         "points straight up or down.",
                         anywhere,
                         &stateless<horizon>};

}  // namespace trocar::training
