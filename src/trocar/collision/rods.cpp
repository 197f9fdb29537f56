#include <trocar/collision/rods.hpp>
#include <trocar/geometry/nearest.hpp>

namespace trocar::collision {

Vec3d nearest_on_axis(const Capsule& capsule, Vec3d p) noexcept {
  return capsule.a + geometry::closest_on_segment(p, capsule.a, capsule.b) * (capsule.b - capsule.a);
}

bool passes_within(Vec3d from, Vec3d to, Vec3d a, Vec3d b, double radius) noexcept {
  const auto pair = geometry::closest_segments(from, to, a, b);
  const Vec3d apart = from + pair.s * (to - from) - (a + pair.t * (b - a));
  return dot(apart, apart) < radius * radius;
}

RodContact touch(const Capsule& first, const Capsule& second, Vec3f& side) noexcept {
  const auto pair = geometry::closest_segments(first.a, first.b, second.a, second.b);
  RodContact c;
  c.s = pair.s;
  c.t = pair.t;
  c.on_first = first.a + c.s * (first.b - first.a);
  c.on_second = second.a + c.t * (second.b - second.a);
  const Vec3d apart = c.on_second - c.on_first;
  const double distance = length(apart), sum = first.radius + second.radius;
  if (distance > 1e-9) c.normal = apart / distance;
  c.depth = sum - distance;
  if (distance > sum + kRemember) {
    side = {0, 0, 0};
  } else if (dot(c.normal, vec_cast<double>(side)) < -0.2) {
    c.normal = -c.normal;
    c.depth = sum + distance;
  } else {
    side = vec_cast<float>(c.normal);
  }
  return c;
}

Push push_out(const Capsule& rod, Vec3d p, Vec3d n, double behind) noexcept {
  const Vec3d from_axis = p - nearest_on_axis(rod, p);
  const double out = dot(from_axis, n);
  if (out <= 0) {  // the axis is outside: straight away from it
    const double distance = length(from_axis);
    if (distance >= rod.radius) return {};
    return {rod.radius - distance, distance > 1e-6 ? from_axis / distance : -n};
  }
  const Vec3d lateral = from_axis - out * n;
  if (out > behind || length(lateral) >= rod.radius) return {};
  return {rod.radius + out, -n};
}

}  // namespace trocar::collision
