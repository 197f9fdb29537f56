#include <cmath>

#include <trocar/interactions/verbs/between_blades.hpp>

namespace trocar::interactions {

geometry::Blade strip_of_blades(const ToolShape& shape, double at_hinge, double at_tips, double length) noexcept {
  geometry::Blade blade;
  for (const Vec3d& corner :
       {Vec3d{-at_hinge, 0, 0}, Vec3d{at_hinge, 0, 0}, Vec3d{at_tips, 0, length}, Vec3d{-at_tips, 0, length}})
    blade.corner[size_t(blade.corners++)] = from_jaw(shape, corner);
  return blade;
}

geometry::Blade closed_blades(const ToolModel& model, const ToolShape& shape, double beyond) noexcept {
  const double length = model.jaw_length + beyond;
  return strip_of_blades(shape, shape.half_opening(0) + kBesideBlades, shape.half_opening(length) + kBesideBlades,
                         length);
}

BetweenBlades between_blades(const ToolModel& model, const ToolShape& shape, const StrandBody& body,
                             const tissue::StrandState& state) noexcept {
  BetweenBlades best;
  if (!body.cuttable) return best;
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    if (!state.alive[size_t(e)]) continue;
    const BetweenJaws where = between_jaws(model, shape, body, state, e);
    if (!where.inside) continue;
    if (best.element >= 0 && std::fabs(where.local.y) >= std::fabs(best.where.local.y)) continue;
    best.element = e;
    best.where = where;
  }
  if (best.element < 0) return best;
  const double radius = body.model.radius[size_t(best.element)];
  best.fraction = leg_cover(best.where.local.z, radius, model.jaw_length);
  return best;
}

bool crosses(const geometry::BladePlane& plane, const tissue::NetworkModel& network, const tissue::NetworkState& state,
             int spring) noexcept {
  if (tissue::spring_scale(network, state, spring) <= 0) return false;
  const auto end = [&](size_t side) {
    return tissue::position(network, state, network.spring_nodes[size_t(2 * spring) + side]);
  };
  return plane.crosses(end(0), end(1));
}

bool crosses(const geometry::BladePlane& plane, const tissue::NetworkModel& network,
             const tissue::NetworkState& state) noexcept {
  bool any = false;
  for (int s = 0; plane.flat && !any && s < network.springs; ++s) any = crosses(plane, network, state, s);
  return any;
}

}  // namespace trocar::interactions
