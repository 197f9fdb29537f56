#include <cmath>

#include <trocar/interactions/couplings/scarred_spring.hpp>

namespace trocar::interactions {
namespace {

constexpr double kHeld = 4;  // 2 lets a curved wall with stiff and raw springs side by side shake for ever

}  // namespace

void pull_scarred(const tissue::NodeView& nodes, const ScarredSpring& s, double tick, NetworkLoads& loads) noexcept {
  const Vec3d apart = nodes.position(s.b) - nodes.position(s.a);
  const double now = length(apart);
  if (!(s.k > 0) || now < 0.25 * s.l) return;
  const Vec3d along = apart / now, mean = 0.5 * (nodes.velocity(s.a) + nodes.velocity(s.b));
  const double k = s.k * (s.stiff - 1), force = k * now - s.k * (s.stiff * s.share - 1) * s.l;
  const double holds = kHeld * k * tick, holds_across = kHeld * std::fabs(force) / now * tick;
  const auto pull = [&](int own, double inwards) {
    tissue::NodeLoad load;
    load.node = own;
    load.f0 = vec_cast<float>((inwards * force + holds * dot(mean, along)) * along);
    load.d = float(holds);
    load.dir = vec_cast<float>(along);
    loads.add(load, {Owner::body, 0, 0});
    load.f0 = vec_cast<float>(holds_across * mean);
    load.d = float(holds_across);
    load.dir = {};
    loads.add(load, {Owner::body, 0, 0});
  };
  pull(s.a, 1);
  pull(s.b, -1);
}

}  // namespace trocar::interactions
