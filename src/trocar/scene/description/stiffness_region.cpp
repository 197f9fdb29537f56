#include <algorithm>

#include <trocar/numerics/portable.hpp>
#include <trocar/scene/description/stiffness_region.hpp>

namespace trocar::scene {

double weight_at(const StiffnessRegion& region, Vec3d place) noexcept {
  const double away = length(place - region.centre) / region.radius;
  const double t = std::clamp(2 - 2 * away, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double stiffness_at(std::span<const StiffnessRegion> regions, Vec3d place) noexcept {
  double logarithm = 0;
  for (const StiffnessRegion& r : regions)
    if (const double w = weight_at(r, place); w > 0) logarithm += w * (portable::log(r.stiffness) - logarithm);
  return logarithm == 0 ? 1 : portable::exp(logarithm);
}

}  // namespace trocar::scene
