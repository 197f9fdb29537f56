#include <algorithm>
#include <cmath>

#include <trocar/interactions/contact/body_friction.hpp>

namespace trocar::interactions {
namespace {

constexpr double kSlow = 0.005;  // [m/s] what a tick's forces may turn a slip of this speed is little

}  // namespace

BodyRub body_rub(double press, Vec3d normal, Vec3d first, Vec3d second) noexcept {
  BodyRub rub;
  const Vec3d apart = first - second, slip = apart - dot(apart, normal) * normal;
  const double speed2 = dot(slip, slip);
  if (!(press > 0) || !(speed2 > 1e-18)) return rub;
  const double speed = std::sqrt(speed2);
  rub.dir = (1 / speed) * slip;
  rub.damping = kBodyFriction * press / std::max(speed, kCreep);
  if (speed < kSlow) rub.aside = cross(normal, rub.dir);
  return rub;
}

void rub_skin(const Surface& surface, int vertex, const BodyRub& rub, Vec3d against, NetworkLoads& loads) noexcept {
  if (!(rub.damping > 0)) return;
  for (const Vec3d dir : {rub.dir, rub.aside}) {
    if (!(dot(dir, dir) > 0)) continue;
    SkinLoad load;
    load.dir = dir;
    load.d = rub.damping;
    load.f0 = (rub.damping * dot(against, dir)) * dir;
    add_skin_load(surface.nodes, *surface.skin, vertex, load, {Owner::body, 0, 0}, loads, kLeastRubbed);
  }
}

void rub_strand(int element, double w, const BodyRub& rub, Vec3d against, StrandLoads& loads) noexcept {
  if (!(rub.damping > 0)) return;
  for (const Vec3d dir : {rub.dir, rub.aside}) {
    if (!(dot(dir, dir) > 0)) continue;
    tissue::StrandLoad load;
    load.element = element;
    load.w = w;
    load.dir = dir;
    load.d = rub.damping;
    load.f0 = (rub.damping * dot(against, dir)) * dir;
    loads.add(load, {Owner::body, 0, 0});
  }
}

}  // namespace trocar::interactions
